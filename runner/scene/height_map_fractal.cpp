// Heights out of noise: whole terrains, and detail between the samples of real ones.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "runner/core/error.h"
#include "runner/scene/height_map.h"

namespace gfxrepro::scene {

namespace {

float between(float a, float b, float t) {
    return a + (b - a) * t;
}

float fade(float t) {
    return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F);
}

/// SplitMix64's finish over the lattice point, the octave and the seed.
std::uint64_t hashOf(std::int64_t x, std::int64_t y, int octave, std::uint64_t seed) {
    std::uint64_t z = seed + 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(octave + 1);
    for (const std::int64_t part : {x, y}) {
        z ^= static_cast<std::uint64_t>(part);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        z ^= z >> 31;
    }
    return z;
}

/// Both components in [−1, 1].
glm::vec2 gradientAt(std::int64_t x, std::int64_t y, int octave, std::uint64_t seed) {
    const std::uint64_t hash = hashOf(x, y, octave, seed);
    return {static_cast<float>((hash >> 8) & 0xFFFFFF) * 0x1p-23F - 1.0F,
            static_cast<float>((hash >> 40) & 0xFFFFFF) * 0x1p-23F - 1.0F};
}

/// Gradient noise (Perlin 2002) a row at a time: 0 at lattice points, within [−1, 1]. What depends
/// on the row alone is worked out once a lattice column, so that a sample costs a few operations.
class NoiseRow {
  public:
    NoiseRow(int octave, std::uint64_t seed) : octave_(octave), seed_(seed) {}

    /// A place in [0, 1)² for the lattice to begin at. Without it all octaves are 0 at the first
    /// one's lattice points, and the eye finds the grid.
    glm::dvec2 origin() const { return 0.5 + 0.5 * glm::dvec2(gradientAt(-1, -1, octave_, seed_)); }

    /// to[i] = noise(x + i · step, y), in lattice units; x ≥ 0.
    void evaluate(double x, double y, double step, std::vector<float>& to) {
        const auto count = static_cast<std::int64_t>(to.size());
        const auto row = static_cast<std::int64_t>(std::floor(y));
        const auto fy = static_cast<float>(y - static_cast<double>(row));
        const float wy = fade(fy);
        const auto last = static_cast<std::int64_t>(x + static_cast<double>(count - 1) * step) + 1;
        columns_.resize(static_cast<std::size_t>(last + 1));
        for (std::int64_t c = 0; c <= last; ++c) {
            const glm::vec2 north = gradientAt(c, row, octave_, seed_);
            const glm::vec2 south = gradientAt(c, row + 1, octave_, seed_);
            columns_[static_cast<std::size_t>(c)] = {
                between(north.x, south.x, wy), between(north.y * fy, south.y * (fy - 1.0F), wy)};
        }
        for (std::int64_t i = 0; i < count; ++i) {
            const double at = x + static_cast<double>(i) * step;
            const auto cell = static_cast<std::int64_t>(at);
            const auto fx = static_cast<float>(at - static_cast<double>(cell));
            const glm::vec2 west = columns_[static_cast<std::size_t>(cell)];
            const glm::vec2 east = columns_[static_cast<std::size_t>(cell + 1)];
            to[static_cast<std::size_t>(i)] =
                between(west.y + west.x * fx, east.y + east.x * (fx - 1.0F), fade(fx));
        }
    }

  private:
    int octave_;
    std::uint64_t seed_;
    std::vector<glm::vec2> columns_;  // slope in x, value at the column
};

/// One row of the terrain, before it is scaled to its relief. Ridges follow the folds of |noise|
/// and are rougher the higher they stand (Musgrave's ridged multifractal).
void fractalRow(const FractalTerrain& terrain, std::uint64_t seed, int row, float* heights) {
    const auto count = static_cast<std::size_t>(terrain.sizeSamples);
    std::vector<float> noise(count);
    std::vector<float> hills(count, 0.0F);
    std::vector<float> ridges(count, 0.0F);
    std::vector<float> weight(count, 1.0F);
    std::vector<float> mask(count);
    double step = static_cast<double>(terrain.spacingM) / static_cast<double>(terrain.featureM);
    // A region's character changes over four of the longest waves.
    NoiseRow(1000, seed).evaluate(0.0, 0.25 * step * row, 0.25 * step, mask);
    float amplitude = 1.0F;
    for (int octave = 0; octave < terrain.octaves; ++octave, step *= 2.0, amplitude *= 0.5F) {
        NoiseRow lattice(octave, seed);
        const glm::dvec2 origin = lattice.origin();
        lattice.evaluate(origin.x, origin.y + step * row, step, noise);
        for (std::size_t i = 0; i < count; ++i) {
            hills[i] += amplitude * noise[i];
            const float fold = std::max(0.0F, 1.0F - 2.0F * std::abs(noise[i]));
            const float signal = fold * fold * weight[i];
            ridges[i] += amplitude * signal;
            weight[i] = std::min(1.0F, 2.0F * signal);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float share = terrain.ridges * std::clamp(0.5F + 2.0F * mask[i], 0.0F, 1.0F);
        heights[i] = between(0.4F * hills[i], ridges[i], share);
    }
}

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

/// The lowest and the highest of all rows, before they are scaled.
glm::vec2 fractalEnds(const FractalTerrain& terrain, std::uint64_t seed) {
    std::vector<glm::vec2> ends(static_cast<std::size_t>(terrain.sizeSamples));
    tbb::parallel_for(0, terrain.sizeSamples, [&](int row) {
        std::vector<float> heights(static_cast<std::size_t>(terrain.sizeSamples));
        fractalRow(terrain, seed, row, heights.data());
        const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
        ends[static_cast<std::size_t>(row)] = {*low, *high};
    });
    glm::vec2 all = ends.front();
    for (const glm::vec2& row : ends) all = {std::min(all.x, row.x), std::max(all.y, row.y)};
    return all;
}

}  // namespace

HeightMap fractalTerrain(const FractalTerrain& terrain, std::uint64_t seed) {
    GFXREPRO_ASSERT(terrain.sizeSamples >= 1 && terrain.sizeSamples <= kMaxHeightMapSide);
    GFXREPRO_ASSERT(terrain.octaves >= 1 && terrain.featureM > 0.0F && terrain.spacingM > 0.0F);
    HeightMap map;
    map.sizeSamples = glm::ivec2(terrain.sizeSamples);
    map.spacingM = terrain.spacingM;
    const auto side = static_cast<std::size_t>(terrain.sizeSamples);
    map.heightsM.resize(side * side);
    tbb::parallel_for(0, terrain.sizeSamples, [&](int row) {
        fractalRow(terrain, seed, row, &map.heightsM[static_cast<std::size_t>(row) * side]);
    });
    const auto [low, high] = std::minmax_element(map.heightsM.begin(), map.heightsM.end());
    const float lowest = *low;
    const float scale = *high > lowest ? terrain.reliefM / (*high - lowest) : 0.0F;
    for (float& height : map.heightsM) height = (height - lowest) * scale;
    return map;
}

HeightMap resampled(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed) {
    GFXREPRO_ASSERT(sizeSamples <= kMaxHeightMapSide);
    const Resampling rows(map, sizeSamples, detailM, seed);
    HeightMap result;
    result.filledCount = map.filledCount;
    result.isEightBit = map.isEightBit;
    result.spacingM = rows.spacingM();
    result.sizeSamples = rows.sizeSamples();
    const auto width = static_cast<std::size_t>(result.sizeSamples.x);
    result.heightsM.resize(width * static_cast<std::size_t>(result.sizeSamples.y));
    tbb::parallel_for(0, result.sizeSamples.y, [&](int row) {
        rows.makeRow(row, &result.heightsM[static_cast<std::size_t>(row) * width]);
    });
    return result;
}

HeightMap fractalTerrainInFile(const FractalTerrain& terrain, std::uint64_t seed,
                               const std::filesystem::path& folder, const std::string& key) {
    HeightMap map;
    map.sizeSamples = glm::ivec2(terrain.sizeSamples);
    map.spacingM = terrain.spacingM;
    // The rows are made twice: how high they reach decides their scale.
    std::optional<glm::vec2> ends;
    const auto makeRow = [&](int row, float* heights) {
        fractalRow(terrain, seed, row, heights);
        const float scale = ends->y > ends->x ? terrain.reliefM / (ends->y - ends->x) : 0.0F;
        for (int i = 0; i < terrain.sizeSamples; ++i) heights[i] = (heights[i] - ends->x) * scale;
    };
    const auto prepare = [&] { ends = fractalEnds(terrain, seed); };
    try {
        map.file = HeightFile::openOrBuild(folder, key, map.sizeSamples, makeRow, prepare);
    } catch (const Error&) {
        if (terrain.sizeSamples > kMaxHeightMapSide) throw;
        return fractalTerrain(terrain, seed);
    }
    return map;
}

HeightMap resampledInFile(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed,
                          const std::filesystem::path& folder, const std::string& key) {
    const Resampling rows(map, sizeSamples, detailM, seed);
    HeightMap result;
    result.filledCount = map.filledCount;
    result.isEightBit = map.isEightBit;
    result.spacingM = rows.spacingM();
    result.sizeSamples = rows.sizeSamples();
    try {
        result.file = HeightFile::openOrBuild(
            folder, key, result.sizeSamples,
            [&](int row, float* heights) { rows.makeRow(row, heights); }, [] {});
    } catch (const Error&) {
        if (sizeSamples > kMaxHeightMapSide) throw;
        return resampled(map, sizeSamples, detailM, seed);
    }
    return result;
}

}  // namespace gfxrepro::scene
