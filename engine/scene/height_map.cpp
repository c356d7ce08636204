#include "engine/scene/height_map.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "engine/scene/height_noise.h"
#include "engine/scene/height_rows.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {
namespace {

/// 0, step, 2 · step … and the last.
std::vector<int> everyNth(int count, int maxCount) {
    const int step = std::max(1, (count - 2 + maxCount - 1) / std::max(1, maxCount - 1));
    std::vector<int> places;
    for (int i = 0; i < count - 1; i += step) places.push_back(i);
    places.push_back(count - 1);
    return places;
}

}  // namespace

float HeightMap::clampedHeightM(int column, int row, int level) const {
    const glm::ivec2 at = glm::clamp(glm::ivec2(column, row), glm::ivec2(0), sizeSamples - 1);
    // The border itself need not be on a level's grid.
    const int between = (1 << level) - 1;
    if (!file || level >= file->levelCount() || ((at.x | at.y) & between) != 0) {
        return heightM(at.x, at.y);
    }
    const auto width = static_cast<std::size_t>(file->sizeSamples(level).x);
    return file->heightsM(level)[static_cast<std::size_t>(at.y >> level) * width +
                                 static_cast<std::size_t>(at.x >> level)];
}

HeightMap::Extremes HeightMap::extremes() const {
    GFXREPRO_ASSERT(!isEmpty());
    if (file) return {file->lowestM(), file->highestM(), file->highestSample()};
    const auto lowest = std::min_element(heightsM.begin(), heightsM.end());
    const auto highest = std::max_element(heightsM.begin(), heightsM.end());
    const auto index = static_cast<int>(highest - heightsM.begin());
    return {*lowest, *highest, {index % sizeSamples.x, index / sizeSamples.x}};
}

float HeightMap::Extremes::reliefM() const {
    const float heightM = std::max(std::abs(lowestM), std::abs(highestM));
    return std::max({highestM - lowestM, 1e-5F * heightM, 1e-6F});  // 1e-6: a plain at 0
}

Box HeightMap::bounds() const {
    Box box;
    if (isEmpty()) return box;
    const Extremes ends = extremes();
    box.add(glm::vec3(0.0F, ends.lowestM, 0.0F));
    box.add(glm::vec3(static_cast<float>(sizeSamples.x - 1) * spacingM.x, ends.highestM,
                      static_cast<float>(sizeSamples.y - 1) * spacingM.y));
    return box;
}

std::string metresText(glm::vec2 spacingM) {
    const std::string east = fmt::format("{:g}", spacingM.x);
    const std::string south = fmt::format("{:g}", spacingM.y);
    return (east == south ? east : east + " x " + south) + " m";
}

std::string steepnessWarning(const HeightMap& map) {
    constexpr float kMostSteepness = 0.5F;  // of the highest mountains seen from end to end: 0.3
    const HeightMap::Extremes ends = map.extremes();
    const glm::vec2 sidesM = glm::vec2(map.sizeSamples - 1) * map.spacingM;
    const float longerM = std::max(sidesM.x, sidesM.y);
    if (ends.highestM - ends.lowestM <= kMostSteepness * longerM) return "";
    return fmt::format(
        "heights from {:g} to {:g} m over {:g} m of ground ({} x {} samples, {} apart) look "
        "like spikes; `scene_params: {{spacing_m: …, height_scale_m: …}}` says how far its samples "
        "stand apart and how many metres a value is",
        ends.lowestM, ends.highestM, longerM, map.sizeSamples.x, map.sizeSamples.y,
        metresText(map.spacingM));
}

void settleForMemory(const std::string& name, glm::ivec2 sizeSamples, const WriteError& why) {
    if (std::max(sizeSamples.x, sizeSamples.y) > kMaxHeightMapSide) {
        throw Error(
            fmt::format("{}: {} x {} samples have no file: {}; allowed without one, in memory: at "
                        "most {} a side (1 GiB)",
                        name, sizeSamples.x, sizeSamples.y, why.what(), kMaxHeightMapSide));
    }
    fmt::print(stderr, "warning: {} is held in memory, all of it: {}\n", name, why.what());
}

Mesh heightMapMesh(const HeightMap& map, int maxSamples) {
    GFXREPRO_ASSERT(maxSamples >= 2);
    Mesh mesh;
    mesh.name = "terrain";
    if (map.isEmpty()) return mesh;
    const std::vector<int> columns = everyNth(map.sizeSamples.x, maxSamples);
    const std::vector<int> rows = everyNth(map.sizeSamples.y, maxSamples);
    for (const int row : rows) {
        for (const int column : columns) mesh.positions.push_back(map.position(column, row));
    }
    const auto width = static_cast<std::uint32_t>(columns.size());
    for (std::uint32_t row = 0; row + 1 < rows.size(); ++row) {
        for (std::uint32_t column = 0; column + 1 < width; ++column) {
            const std::uint32_t northWest = row * width + column;
            const std::uint32_t southWest = northWest + width;
            mesh.triangles.emplace_back(northWest, southWest, southWest + 1);
            mesh.triangles.emplace_back(northWest, southWest + 1, northWest + 1);
        }
    }
    mesh.normals = vertexNormals(mesh);
    return mesh;
}

// Height maps from files: in memory, and larger ones by bands of rows into a file of the cache.

namespace fs = std::filesystem;

namespace {

/// A file's rows in metres, NaN where they have no data.
class Metres {
  public:
    Metres(const fs::path& path, const HeightMapUnits& units)
        : rows_(openHeightRows(path, !units.spacingM)), units_(units) {
        if (units.noData) rows_->noData.push_back(*units.noData);
    }

    const HeightRows& source() const { return *rows_; }
    bool canHaveHoles() const { return rows_->canBeNan || !rows_->noData.empty(); }

    void read(int count, float* heightsM) {
        const std::vector<float>& none = rows_->noData;
        for (int i = 0; i < count; ++i, heightsM += rows_->sizeSamples.x) {
            rows_->read(heightsM);
            for (int column = 0; column < rows_->sizeSamples.x; ++column) {
                float& height = heightsM[column];
                const bool isHole = std::ranges::any_of(none, [&](float value) {
                    // What is no height anyway may be written with few digits: -3.4e38.
                    return height == value ||
                           (std::abs(value) > 1e30F && std::abs(height / value - 1.0F) < 1e-3F);
                });
                height =
                    isHole ? NAN : (height * rows_->scale + rows_->offset) * units_.heightScaleM;
            }
        }
    }

  private:
    std::unique_ptr<HeightRows> rows_;
    HeightMapUnits units_;
};

HeightMap withoutHeights(const HeightRows& source, const HeightMapUnits& units) {
    HeightMap map;
    map.sizeSamples = source.sizeSamples;
    map.spacingM =
        units.spacingM ? glm::vec2(*units.spacingM) : source.spacingM.value_or(glm::vec2(1.0F));
    map.isSpacingOfFile = !units.spacingM && source.spacingM;
    if (!units.spacingM) map.spacingWarning = source.spacingWarning;
    map.unitWarning = source.unitWarning;
    map.isEightBit = source.isEightBit;
    return map;
}

void sayRounded(HeightMap& map) {
    map.unitWarning += map.unitWarning.empty() ? "" : "; ";
    map.unitWarning += "its heights, floats of 64 bits, are rounded to 32: to some 7 digits";
}

template <class Step>
void naming(const fs::path& path, const Step& step) {
    try {
        step();
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.what()));
    }
}

/// Makes the file of a map: one pass over its rows, or two where some may have no data.
class Conversion {
  public:
    Conversion(const fs::path& path, const HeightMapUnits& units)
        : path_(path), units_(units), rows_(std::in_place, path, units) {}

    const HeightRows& source() const { return rows_->source(); }

    std::size_t prepare() {
        if (!rows_->canHaveHoles()) return 0;
        const auto reader = [this](int count, float* heightsM) { rows_->read(count, heightsM); };
        filling_.emplace(source().sizeSamples, reader);
        rows_.emplace(path_, units_);
        if (filling_->holeCount() == 0) {
            filling_.reset();
            return 0;
        }
        naming(path_, [&] { filling_->restart(reader); });
        return filling_->holeCount();
    }

    void makeRows(int count, float* heightsM) {
        if (filling_) {
            filling_->next(heightsM);
        } else {
            rows_->read(count, heightsM);
        }
    }

  private:
    fs::path path_;
    HeightMapUnits units_;
    std::optional<Metres> rows_;
    std::optional<HoleFilling> filling_;
};

static_assert(HoleFilling::kBandRows == HeightFile::kRowsAtOnce);

}  // namespace

void fillHoles(HeightMap& map) {
    map.filledCount = static_cast<std::size_t>(
        std::count_if(map.heightsM.begin(), map.heightsM.end(),
                      [](float height) { return !std::isfinite(height); }));
    if (map.filledCount == 0) return;
    const auto readerOf = [&map](int row) {
        return [&map, row](int count, float* values) mutable {
            const auto width = static_cast<std::size_t>(map.sizeSamples.x);
            std::copy_n(&map.heightsM[static_cast<std::size_t>(row) * width],
                        static_cast<std::size_t>(count) * width, values);
            row += count;
        };
    };
    HoleFilling filling(map.sizeSamples, readerOf(0));
    filling.restart(readerOf(0));
    std::vector<float> filled(map.heightsM.size());
    for (std::size_t done = 0; done < filled.size();
         done +=
         std::size_t{HoleFilling::kBandRows} * static_cast<std::size_t>(map.sizeSamples.x)) {
        filling.next(&filled[done]);
    }
    map.heightsM = std::move(filled);
}

HeightMap loadHeightMap(const fs::path& path, const HeightMapUnits& units) {
    Metres rows(path, units);
    HeightMap map = withoutHeights(rows.source(), units);
    if (std::max(map.sizeSamples.x, map.sizeSamples.y) > kMaxHeightMapSide) {
        throw Error(
            fmt::format("{}: a height map of {} x {} samples; allowed in memory: {} to {} a "
                        "side",
                        path.string(), map.sizeSamples.x, map.sizeSamples.y, kMinHeightMapSide,
                        kMaxHeightMapSide));
    }
    map.heightsM.resize(static_cast<std::size_t>(map.sizeSamples.x) *
                        static_cast<std::size_t>(map.sizeSamples.y));
    rows.read(map.sizeSamples.y, map.heightsM.data());
    if (rows.source().isRounded) sayRounded(map);
    naming(path, [&] { fillHoles(map); });
    return map;
}

HeightMap loadHeightMapInFile(const fs::path& path, const HeightMapUnits& units,
                              const fs::path& folder, const std::string& key,
                              int mostSamplesInMemory) {
    Conversion conversion(path, units);
    HeightMap map = withoutHeights(conversion.source(), units);
    if (std::max(map.sizeSamples.x, map.sizeSamples.y) <= mostSamplesInMemory) {
        return loadHeightMap(path, units);
    }
    try {
        map.file = HeightFile::openOrBuild(
            folder, key, map.sizeSamples,
            [&](int, int count, float* heightsM) { conversion.makeRows(count, heightsM); },
            [&] { return conversion.prepare(); });
    } catch (const WriteError& error) {
        settleForMemory(path.string(), map.sizeSamples, error);
        return loadHeightMap(path, units);
    }
    if (conversion.source().areDoubles) sayRounded(map);  // an earlier run may have read them
    map.filledCount = map.file->filledCount();
    return map;
}

// More samples for a height map, with detail of noise between those it has.

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
    glm::vec2 spacingM() const { return glm::vec2(glm::dvec2(map_.spacingM) * step_); }

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
    } catch (const WriteError& error) {
        settleForMemory("a resampled height map", result.sizeSamples, error);
        return resampled(map, sizeSamples, detailM, seed);
    }
    return result;
}

}  // namespace gfxrepro::scene
