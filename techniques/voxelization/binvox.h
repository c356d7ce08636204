// The .binvox exchange format: a grid of bits, run-length encoded.
#pragma once

#include <filesystem>

#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// A grid as a binvox file holds it.
struct BinvoxGrid {
    DenseGrid grid;             // 1 bit a voxel
    glm::vec3 translate{0.0F};  // world position of voxel (0, 0, 0)'s corner
    float scale = 1.0F;         // edge of the cubic grid in world units
};

/// Header `#binvox 1`, dim, translate, scale, then pairs of value and count; y runs fastest, then
/// z, then x. Every voxel that is not 0 is written as 1.
void writeBinvox(const std::filesystem::path& path, const DenseGrid& grid, const scene::Box& box);

/// Throws Error naming the file for anything that is not such a cubic grid of 32 … 1024 voxels, a
/// power of two.
BinvoxGrid readBinvox(const std::filesystem::path& path);

}  // namespace gfxrepro::voxelization
