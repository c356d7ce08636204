// Voxels that leave: .npy for numpy, .vox for MagicaVoxel, .binvox.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "techniques/voxelization/grid_shape.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// The full voxels of a grid, and what the surface looks like where it is nearest to each one's
/// centre. Those that are farther from it than a voxel, within a solid, have zeros there.
struct VoxelModel {
    GridShape shape;
    glm::dvec3 origin{0.0};  // corner of voxel (0, 0, 0), in the units and the place of the file
    double voxelSize = 1.0;
    std::string source;              // the model's file, without its folder
    std::vector<glm::ivec3> voxels;  // z runs fastest, then y
    std::vector<glm::vec3> normals;  // unit: the mesh's own where it has some, else its triangles'
    std::vector<std::array<std::uint8_t, 3>> colors;  // sRGB: material times texture times vertex
};

/// `box` is the grid's, in the coordinates of `scene`.
VoxelModel voxelModelOf(const DenseGrid& grid, const scene::Box& box, const scene::Scene& scene);

/// Throws Error for another extension than .npy, .vox and .binvox, and for a grid of more than 256
/// voxels along an axis as .vox.
void requireVoxelFile(const std::filesystem::path& path, int resolution);

/// Writes the file, and beside it a .json with shape, origin and voxel size. Returns the paths.
///
/// - m.npy: bool, [x][y][z]. m.normals.npy and m.colors.npy: floats and bytes, three a full voxel,
///   in the order of a mask: `colors[m] = …`.
/// - m.vox: z is up there, so that ours are (x, −z, y); of more than 255 colours similar ones
/// become
///   one.
/// - m.binvox: its readers want cubes. A grid that is none is the lower corner of one.
std::vector<std::filesystem::path> writeVoxels(const std::filesystem::path& path,
                                               const VoxelModel& model);

}  // namespace gfxrepro::voxelization
