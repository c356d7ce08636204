#include "scenes/terrain/terrain.h"

#include <fmt/format.h>

#include <algorithm>

#include "runner/core/files.h"
#include "runner/core/hash.h"
#include "runner/scene/generators.h"

namespace gfxrepro::scene {

namespace {

/// Maps with longer sides are made once and kept in a file, not by each worker in its memory.
constexpr int kMostSamplesInMemory = 4097;

std::string keyOf(const FractalTerrain& shape, std::uint64_t seed) {
    return sha256(fmt::format("terrain of generator {}: {} {} {} {} {} {}, seed {}",
                              kGeneratorVersion, shape.sizeSamples, shape.spacingM, shape.reliefM,
                              shape.featureM, shape.octaves, shape.ridges, seed));
}

}  // namespace

Scene terrain(config::Params& params, std::uint64_t seed) {
    FractalTerrain shape;
    shape.sizeSamples = params.getInt("size_samples", shape.sizeSamples,
                                      {"samples a side", "", 1, kMaxHeightFileSide});
    shape.spacingM = static_cast<float>(params.getDouble(
        "spacing_m", static_cast<double>(shape.spacingM), {"between samples", "m", 1e-3, 1e5}));
    shape.reliefM =
        static_cast<float>(params.getDouble("relief_m", static_cast<double>(shape.reliefM),
                                            {"from the lowest to the highest", "m", 0, 1e5}));
    shape.featureM =
        static_cast<float>(params.getDouble("feature_m", static_cast<double>(shape.featureM),
                                            {"the longest wave of the noise", "m", 1, 1e7}));
    shape.octaves = params.getInt("octaves", shape.octaves, {"octaves of the noise", "", 1, 20});
    shape.ridges =
        static_cast<float>(params.getDouble("ridges", static_cast<double>(shape.ridges),
                                            {"0: rolling hills only, 1: ridges only", "", 0, 1}));
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
