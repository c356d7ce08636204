#include "scenes/terrain/terrain.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/wide.h"
#include "engine/scene/generators.h"
#include "engine/scene/height_noise.h"

namespace gfxrepro::scene {

namespace {

/// 0: rolling hills only, 1: ridges only.
constexpr float kRidges = 0.7F;

std::string keyOf(const FractalTerrain& shape, std::uint64_t seed) {
    return sha256(fmt::format("terrain of generator {}: {} {} {} {} {} {}, seed {}",
                              kGeneratorVersion, shape.sizeSamples, shape.spacingM, shape.reliefM,
                              shape.featureM, shape.octaves, kRidges, seed));
}

/// Ridges follow the folds of |noise| and are rougher the higher they stand (Musgrave's ridged
/// multifractal).
GFXREPRO_WIDE void addOctave(const float* __restrict noise, float amplitude, std::size_t count,
                             float* __restrict hills, float* __restrict ridges,
                             float* __restrict weight) {
    for (std::size_t i = 0; i < count; ++i) {
        hills[i] += amplitude * noise[i];
        const float crest = 1.0F - 2.0F * std::abs(noise[i]);
        const float fold = 0.5F * (crest + std::abs(crest));  // at least 0, without a branch
        const float signal = fold * fold * weight[i];
        ridges[i] += amplitude * signal;
        weight[i] = std::min(1.0F, 2.0F * signal);
    }
}

/// One row of the terrain, before it is scaled to its relief.
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
        addOctave(noise.data(), amplitude, count, hills.data(), ridges.data(), weight.data());
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float share = kRidges * std::clamp(0.5F + 2.0F * mask[i], 0.0F, 1.0F);
        heights[i] = between(0.4F * hills[i], ridges[i], share);
    }
}

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
    map.spacingM = glm::vec2(terrain.spacingM);
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

HeightMap fractalTerrainInFile(const FractalTerrain& terrain, std::uint64_t seed,
                               const std::filesystem::path& folder, const std::string& key) {
    HeightMap map;
    map.sizeSamples = glm::ivec2(terrain.sizeSamples);
    map.spacingM = glm::vec2(terrain.spacingM);
    // The rows are made twice: how high they reach decides their scale.
    std::optional<glm::vec2> ends;
    const auto makeRow = [&](int row, float* heights) {
        fractalRow(terrain, seed, row, heights);
        const float scale = ends->y > ends->x ? terrain.reliefM / (ends->y - ends->x) : 0.0F;
        for (int i = 0; i < terrain.sizeSamples; ++i) heights[i] = (heights[i] - ends->x) * scale;
    };
    const auto prepare = [&] {
        ends = fractalEnds(terrain, seed);
        return std::size_t{0};
    };
    try {
        map.file =
            HeightFile::openOrBuild(folder, key, map.sizeSamples,
                                    HeightFile::inParallel(map.sizeSamples.x, makeRow), prepare);
    } catch (const WriteError& error) {
        settleForMemory("a generated terrain", map.sizeSamples, error);
        return fractalTerrain(terrain, seed);
    }
    return map;
}

Scene terrain(Params& params, std::uint64_t seed) {
    FractalTerrain shape;
    shape.sizeSamples =
        params.getInt("size_samples", shape.sizeSamples,
                      {"samples a side", "", kMinHeightMapSide, kMaxHeightFileSide});
    shape.spacingM = static_cast<float>(params.getDouble(
        "spacing_m", static_cast<double>(shape.spacingM), {"between samples", "m", 1e-3, 1e5}));
    shape.reliefM =
        static_cast<float>(params.getDouble("relief_m", static_cast<double>(shape.reliefM),
                                            {"from the lowest to the highest", "m", 0, 1e5}));
    shape.featureM =
        static_cast<float>(params.getDouble("feature_m", static_cast<double>(shape.featureM),
                                            {"the longest wave of the noise", "m", 1, 1e7}));
    shape.octaves = params.getInt("octaves", shape.octaves, {"octaves of the noise", "", 1, 20});
    params.finish();
    Scene scene;
    scene.heights =
        shape.sizeSamples > kMostSamplesInMemory
            ? fractalTerrainInFile(shape, seed, cacheFolder() / "heights", keyOf(shape, seed))
            : fractalTerrain(shape, seed);
    addTerrainCameras(scene);
    return scene;
}

}  // namespace gfxrepro::scene
