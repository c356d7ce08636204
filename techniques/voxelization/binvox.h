// The .binvox exchange format: a grid of bits, run-length encoded.
#pragma once

#include <filesystem>

#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// Header `#binvox 1`, dim, translate, scale, then pairs of value and count; y runs fastest, then
/// z, then x. Every voxel that is not 0 is written as 1.
void writeBinvox(const std::filesystem::path& path, const DenseGrid& grid, const scene::Box& box);

}  // namespace gfxrepro::voxelization
