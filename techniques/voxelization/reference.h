// Voxelization on the CPU, slow and exact: what the rules are compared with. It works on the
// snapped mesh (LatticeMesh) and visits every voxel or scan line of a triangle's box. In
// doubles, whose products are exact for triangles of up to about 400 voxels.
#pragma once

#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization::reference {

/// Every voxel whose closed cube meets a triangle of the mesh as given, and those that come as near
/// to the snapped one as half a lattice unit: 13 separating axes (Akenine-Möller 2001).
DenseGrid conservative(const LatticeMesh& mesh, const GridShape& shape);

/// Every voxel in which one of the three axis-parallel lines through voxel centres crosses a
/// triangle. 6-separating (Laine 2013). Lines that meet an edge are shifted by (ε, ε², ε³).
DenseGrid thin(const LatticeMesh& mesh, const GridShape& shape);

/// Those of thin() that lines along a triangle's dominant axis cross: what `rule: rasterized` sets
/// where nothing is rounded.
DenseGrid thinAlongDominantAxes(const LatticeMesh& mesh, const GridShape& shape);

/// Over the three axes, the scan lines on which an odd number of voxels hold their crossings: what
/// `fill_rule: surface_voxels` leaves open where nothing is rounded.
std::size_t countOddScanLines(const LatticeMesh& mesh, const GridShape& shape);

/// Voxels whose centre lies inside on two of three axes, by the parity of the crossings before it.
struct SolidVoxels {
    DenseGrid grid;
    std::size_t ambiguousScanLines = 0;  // over the three axes: an odd number of crossings
    std::size_t disagreeingVoxels = 0;   // where the axes differ
};
SolidVoxels solid(const LatticeMesh& mesh, const GridShape& shape);

/// Number of voxels that are full in `expected` and empty in `grid`.
std::size_t countMissing(const DenseGrid& expected, const DenseGrid& grid);

}  // namespace gfxrepro::voxelization::reference
