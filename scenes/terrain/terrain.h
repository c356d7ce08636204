// Generated height maps as scenes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/core/params.h"
#include "engine/scene/height_map.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// Seeded terrain: ridged mountains that fade into rolling lowland (noise summed over octaves).
struct FractalTerrain {
    int sizeSamples = 4097;
    float spacingM = 10.0F;
    float reliefM = 3000.0F;   // from the lowest to the highest, at most
    float featureM = 8000.0F;  // the longest wave of the noise
    int octaves = 11;
};
HeightMap fractalTerrain(const FractalTerrain& terrain, std::uint64_t seed);
/// The same in a file of `folder`, as resampledInFile() keeps its own.
HeightMap fractalTerrainInFile(const FractalTerrain& terrain, std::uint64_t seed,
                               const std::filesystem::path& folder, const std::string& key);

/// Mountains and lowland of fractal noise (fractalTerrain), a height map without triangles.
Scene terrain(Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
