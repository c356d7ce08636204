#include "techniques/terrain_tessellation/outputs.h"

namespace gfxrepro::terrain_tessellation {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {{
                {"drawn_triangles", "triangle", "with skirts, before clipping"},
                {"triangles_per_second", "triangle/s", "drawn, by the draw alone", Better::Higher},
                {"tiles", "tile", "drawn"},
                {"patches", "patch", "drawn"},
                {"draw_calls", "call", "of a frame", Better::Lower},
                {"visited_tiles", "tile", "of the tree", Better::Neither, kIsDetail},
                {"culled_tiles", "tile", "outside the view", Better::Neither, kIsDetail},
                {"culled_patches", "patch", "outside the view", Better::Neither, kIsDetail},
                {"culled_patches_pct", "%", "of the patches"},
                {"tile_error_px", "pixel", "greatest error that was accepted, on the screen",
                 Better::Lower},
                {"height_error_m", "m", "of the drawn ground", Better::Lower},
                {"height_error_px", "pixel", "of the drawn ground, on the screen", Better::Lower},
                {"crack_pixels", "pixel", "that show what is behind or under the ground",
                 Better::Lower},
                {"truth_underside_pixels", "pixel",
                 "that show the underside of the full resolution", Better::Neither, kIsDetail},
                {"channel_error", "level", "mean absolute difference of a channel, 0 … 255",
                 Better::Lower},
                {"psnr_db", "dB", "of the picture", Better::Higher},
                {"flip_mean", "1", "FLIP of the picture", Better::Lower},
                {"surface_triangles", "triangle", "without skirts", Better::Neither, kIsDetail},
                {"shared_edges", "edge", "of two patches", Better::Neither, kIsDetail},
                {"factor_mismatches", "edge", "shared edges of two factors: cracks", Better::Lower},
                {"edge_jump", "1", "of factors at neighbouring edges", Better::Lower},
                {"edges_at_greatest_pct", "%", "of the edges, with the greatest factor",
                 Better::Neither, kIsDetail},
                {"unclamped_edges", "edge", "with a factor between the least and the greatest",
                 Better::Neither, kIsDetail},
                {"unhalved_edges", "edge",
                 "whose factor does not halve where edges may be twice as long", Better::Lower,
                 kIsDetail},
                {"most_patch_vertices", "vertex", "of a patch", Better::Neither, kIsDetail},
                {"seam_edges", "edge", "that were checked", Better::Neither, kIsDetail},
                {"open_edges", "edge", "of the drawn ground: cracks", Better::Lower},
                {"largest_fan", "triangle", "at one vertex of a seam", Better::Neither, kIsDetail},
                {"yardstick_ms", "ms", "clearing and shading without tessellation", Better::Neither,
                 kIsDetail},
                {"preprocess_ms", "ms", "the tree of tiles, made or mapped from a file",
                 Better::Lower, kIsDetail},
                {"loaded_tiles", "tile", "of a frame", Better::Neither, kIsDetail},
                {"map_mib", "MiB", "of the height map", Better::Neither, kIsDetail},
                {"memory_bytes", "byte", "of tiles and patches on the device", Better::Lower},
            },
            {
                {"tile_walk", "which tiles are drawn"},
                {"load_tiles", "heights that came into view"},
                {"draw", "tessellation and shading"},
                {"mean", "mean value"},
                {"max", "greatest value"},
                {"net", "less what the yardstick takes"},
                {"patches", "between patches of one tile"},
                {"tiles", "between tiles"},
                {"background", "that show the background"},
                {"underside", "that show the underside of the ground"},
            }};
}

}  // namespace gfxrepro::terrain_tessellation
