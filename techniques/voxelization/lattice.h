// A mesh snapped to a lattice of 2⁻⁸ voxels. On it the exact rules (thin, conservative, solid) are
// decided in integers on the device and in doubles that hold them on the CPU, alike.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::voxelization {

/// Lattice units a voxel.
inline constexpr int kLatticePerVoxel = 256;
/// Farthest that a vertex may lie from the box's corner, in voxels: keeps products of differences
/// of coordinates below 2⁵³.
inline constexpr int kMaxExtentVoxels = 65536;
/// Widest mesh that 64-bit integers decide: products of three differences of coordinates, six of
/// them, stay below 2⁶³.
inline constexpr int kIntegerExtentVoxels = 4096;

/// Positions in lattice units from the box's minimum; voxel (x, y, z) is the closed cube from
/// 256·(x, y, z) to 256·(x + 1, y + 1, z + 1), its centre at +128. `triangles` must outlive it.
struct LatticeMesh {
    std::vector<glm::ivec3> positions;
    std::span<const glm::uvec3> triangles;
};

/// Each vertex at the nearest lattice point. Throws Error for a vertex beyond kMaxExtentVoxels.
LatticeMesh snapped(const scene::Mesh& mesh, const scene::Box& box, int resolution);

/// Whether the mesh is wider than kIntegerExtentVoxels, so that doubles decide on the device too.
bool isWide(const scene::Mesh& mesh, const scene::Box& box, int resolution);

}  // namespace gfxrepro::voxelization
