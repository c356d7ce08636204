// More samples for a height map, with detail of noise between those it has.
#include <fmt/format.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/scene/height_map.h"
#include "engine/scene/height_noise.h"

namespace gfxrepro::scene {

namespace {

/// The four weights of Catmull and Rom's cubic through four samples.
glm::vec4 cubicWeights(float t) {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return {0.5F * (-t3 + 2.0F * t2 - t), 0.5F * (3.0F * t3 - 5.0F * t2 + 2.0F),
            0.5F * (-3.0F * t3 + 4.0F * t2 + t), 0.5F * (t3 - t2)};
}

/// How rough the ground is around each old sample: the share of the detail that it gets. Water and
/// plains stay flat.
std::vector<float> detailShares(const HeightMap& map, float detailM) {
    std::vector<float> shares(map.heightsM.size());
    tbb::parallel_for(0, map.sizeSamples.y, [&](int row) {
        for (int column = 0; column < map.sizeSamples.x; ++column) {
            float low = map.heightM(column, row);
            float high = low;
            for (int i = 0; i < 9; ++i) {
                const float height = map.clampedHeightM(column + i % 3 - 1, row + i / 3 - 1);
                low = std::min(low, height);
                high = std::max(high, height);
            }
            shares[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.sizeSamples.x) +
                   static_cast<std::size_t>(column)] =
                std::min(1.0F, (high - low) / (4.0F * detailM));
        }
    });
    return shares;
}

/// A new row's values in the old columns, and then along the row.
class RowResampler {
  public:
    RowResampler(const HeightMap& map, double step) : map_(map), step_(step) {}

    void evaluate(int row, float* to, int count) {
        const double y = row * step_;
        const int north = static_cast<int>(y);
        const glm::vec4 wy = cubicWeights(static_cast<float>(y - north));
        // One more column on the west and three on the east, which the cubic reaches.
        std::vector<float> line(static_cast<std::size_t>(map_.sizeSamples.x) + 4);
        for (int c = -1; c < map_.sizeSamples.x + 3; ++c) {
            float sum = 0.0F;
            for (int i = 0; i < 4; ++i) sum += wy[i] * map_.clampedHeightM(c, north - 1 + i);
            line[static_cast<std::size_t>(c + 1)] = sum;
        }
        for (int i = 0; i < count; ++i) {
            const double x = i * step_;
            const int west = std::min(static_cast<int>(x), map_.sizeSamples.x - 1);
            const glm::vec4 wx = cubicWeights(static_cast<float>(x - west));
            const float* four = &line[static_cast<std::size_t>(west)];
            to[i] = wx[0] * four[0] + wx[1] * four[1] + wx[2] * four[2] + wx[3] * four[3];
        }
    }

  private:
    const HeightMap& map_;
    double step_;
};

/// Bilinear.
float shareAt(const HeightMap& map, const std::vector<float>& shares, double x, double y) {
    const int west = std::min(static_cast<int>(x), map.sizeSamples.x - 1);
    const int north = std::min(static_cast<int>(y), map.sizeSamples.y - 1);
    const int east = std::min(west + 1, map.sizeSamples.x - 1);
    const int south = std::min(north + 1, map.sizeSamples.y - 1);
    const auto at = [&](int column, int row) {
        return shares[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.sizeSamples.x) +
                      static_cast<std::size_t>(column)];
    };
    const auto fx = static_cast<float>(x - west);
    const auto fy = static_cast<float>(y - north);
    return between(between(at(west, north), at(east, north), fx),
                   between(at(west, south), at(east, south), fx), fy);
}

/// The new ground, row by row.
class Resampling {
  public:
    /// Throws Error for sizes that cannot be reached.
    Resampling(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed)
        : map_(map), detailM_(detailM), seed_(seed) {
        GFXREPRO_ASSERT(!map.isEmpty() && detailM >= 0.0F);
        const int longSide = std::max(map.sizeSamples.x, map.sizeSamples.y);
        if (longSide < 2 || sizeSamples < longSide) {
            throw Error(
                fmt::format("a height map of {} x {} samples cannot be resampled to {}; "
                            "allowed: at least 2 and no more than it becomes",
                            map.sizeSamples.x, map.sizeSamples.y, sizeSamples));
        }
        step_ = static_cast<double>(longSide - 1) / static_cast<double>(sizeSamples - 1);
        for (int axis = 0; axis < 2; ++axis) {
            sizeSamples_[axis] =
                1 + static_cast<int>(std::floor((map.sizeSamples[axis] - 1) / step_ + 1e-6));
        }
        if (detailM > 0.0F) shares_ = detailShares(map, detailM);
    }

    glm::ivec2 sizeSamples() const { return sizeSamples_; }
    float spacingM() const {
        return static_cast<float>(static_cast<double>(map_.spacingM) * step_);
    }

    void makeRow(int row, float* heights) const {
        RowResampler(map_, step_).evaluate(row, heights, sizeSamples_.x);
        if (shares_.empty()) return;
        std::vector<float> noise(static_cast<std::size_t>(sizeSamples_.x));
        double frequency = 1.0;
        float amplitudeM = 0.5F * detailM_;  // halved each octave: less than detailM together
        // As long as a wave has four new samples; its lattice holds all old samples.
        for (int octave = 0; step_ * frequency <= 0.25; ++octave) {
            NoiseRow(octave, seed_)
                .evaluate(0.0, frequency * step_ * row, frequency * step_, noise);
            for (std::size_t i = 0; i < noise.size(); ++i) {
                heights[i] += amplitudeM * noise[i] *
                              shareAt(map_, shares_, static_cast<double>(i) * step_, row * step_);
            }
            frequency *= 2.0;
            amplitudeM *= 0.5F;
        }
    }

  private:
    const HeightMap& map_;
    float detailM_;
    std::uint64_t seed_;
    double step_ = 1.0;
    glm::ivec2 sizeSamples_{0};
    std::vector<float> shares_;
};

HeightMap resampledWithoutHeights(const HeightMap& map, const Resampling& rows) {
    HeightMap result;
    result.filledCount = map.filledCount;
    result.isEightBit = map.isEightBit;
    result.spacingM = rows.spacingM();
    result.sizeSamples = rows.sizeSamples();
    return result;
}

}  // namespace

HeightMap resampled(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed) {
    GFXREPRO_ASSERT(sizeSamples <= kMaxHeightMapSide);
    const Resampling rows(map, sizeSamples, detailM, seed);
    HeightMap result = resampledWithoutHeights(map, rows);
    const auto width = static_cast<std::size_t>(result.sizeSamples.x);
    result.heightsM.resize(width * static_cast<std::size_t>(result.sizeSamples.y));
    tbb::parallel_for(0, result.sizeSamples.y, [&](int row) {
        rows.makeRow(row, &result.heightsM[static_cast<std::size_t>(row) * width]);
    });
    return result;
}

HeightMap resampledInFile(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed,
                          const std::filesystem::path& folder, const std::string& key) {
    const Resampling rows(map, sizeSamples, detailM, seed);
    HeightMap result = resampledWithoutHeights(map, rows);
    try {
        result.file = HeightFile::openOrBuild(
            folder, key, result.sizeSamples,
            HeightFile::inParallel(result.sizeSamples.x,
                                   [&](int row, float* heights) { rows.makeRow(row, heights); }),
            [] { return std::size_t{0}; });
    } catch (const UnwritableError& error) {
        settleForMemory("a resampled height map", result.sizeSamples, error);
        return resampled(map, sizeSamples, detailM, seed);
    }
    return result;
}

}  // namespace gfxrepro::scene
