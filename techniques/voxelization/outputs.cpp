#include "techniques/voxelization/outputs.h"

namespace gfxrepro::voxelization {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"voxels", "voxel", "full ones"},
            {"triangles", "triangle", "of the mesh"},
            {"vertices", "vertex", "of the mesh"},
            {"fragments", "fragment", "triangles' that were rasterized, over the three axes"},
            {"memory_bytes", "byte", "mesh, fragments and worksheets on the device", Better::Lower},
            {"worksheet_bytes", "byte", "a worksheet", Better::Neither, kIsDetail},
            {"voxel_bits", "bit", "of a voxel", Better::Neither, kIsDetail},
            {"digest", "1", "of all voxels: equal where two grids are", Better::Neither, kIsDetail},
            {"ambiguous_scan_lines", "scan line", "that end inside: of a mesh that is not closed",
             Better::Lower},
            {"disagreeing_voxels", "voxel", "of which the three axes say different things",
             Better::Lower},
            {"missed_solid_voxels", "voxel", "of the exact solid, that the grid lacks",
             Better::Lower},
            {"added_solid_voxels", "voxel", "of the grid, that the exact solid lacks",
             Better::Lower},
            {"stray_voxels", "voxel", "of the grid, that neither solid nor surface has",
             Better::Lower},
            {"missed_thin_voxels", "voxel", "of the exact thin surface, that the grid lacks",
             Better::Lower},
            {"missed_conservative_voxels", "voxel", "that the surface touches and the grid lacks",
             Better::Lower},
            {"added_conservative_voxels", "voxel", "of the grid, that the surface does not touch",
             Better::Lower},
            {"planes", "plane", "that were blended or searched for the picture", Better::Neither,
             kIsDetail},
            {"samples", "sample", "of a parametric surface"},
            {"samples_outside", "sample", "that fell outside the box", Better::Lower},
            {"sample_gap_voxels", "1", "largest distance of neighbouring samples, in voxels",
             Better::Lower},
            {"collision_voxels", "voxel", "that both solids have"},
            {"collision_min_x", "scene unit", "of the box of the collision", Better::Neither,
             kIsDetail},
            {"collision_max_x", "scene unit", "of the box of the collision", Better::Neither,
             kIsDetail},
            {"collision_min_y", "scene unit", "of the box of the collision", Better::Neither,
             kIsDetail},
            {"collision_max_y", "scene unit", "of the box of the collision", Better::Neither,
             kIsDetail},
            {"collision_min_z", "scene unit", "of the box of the collision", Better::Neither,
             kIsDetail},
            {"collision_max_z", "scene unit", "of the box of the collision", Better::Neither,
             kIsDetail},
        },
        {
            {"preprocess", "triangles sorted by their main axis"},
            {"voxelization", "the whole method, without drawing"},
            {"rasterization", "triangles into fragments"},
            {"texelization", "fragments into the worksheets of three axes"},
            {"fill", "solids from scan lines"},
            {"synthesis", "three worksheets into one"},
            {"implicit", "an implicit surface, by its formula"},
            {"parametric", "a parametric surface, by its samples"},
            {"csg", "union, intersection or difference of two grids"},
            {"collision", "what two grids share"},
            {"read_back", "the grid into the host's memory"},
            {"draw", "the picture of the grid"},
            {"draw_depth", "the baseline: depth images"},
        }};
}

}  // namespace gfxrepro::voxelization
