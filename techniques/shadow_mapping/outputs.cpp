#include "techniques/shadow_mapping/outputs.h"

namespace gfxrepro::shadow_mapping {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"wrong_pct", "%", "share of the compared points that are lit or shadowed wrongly",
             Better::Lower},
            {"acne_pct", "%", "share of the compared points that are shadowed by their own surface",
             Better::Lower},
            {"leak_pct", "%",
             "share of the compared points that are lit although a caster hides the light",
             Better::Lower},
            {"edge_pct", "%",
             "share of the compared points that are wrong within edge_texels of the shadow's edge",
             Better::Lower},
            {"compared_points", "pixel", "points that were compared, of all lights"},
            {"methods_differ_pct", "%",
             "share of the pixels where the other method shows another shadow", Better::Lower},
            {"memory_bytes", "byte", "memory of the shadow maps", Better::Lower},
            {"lights_without_caster", "light", "lights without anything before them", Better::Lower,
             kIsDetail},
            {"colour_writes", "1", "1 where the step writes colours", Better::Neither, kIsDetail},
            {"depth_writes", "1", "1 where the step writes depths", Better::Neither, kIsDetail},
            {"fragment_work", "1", "1 where the step runs a fragment program", Better::Neither,
             kIsDetail},
            {"fetches", "1", "texels that the step fetches", Better::Lower, kIsDetail},
            {"comparisons", "1", "comparisons in the step's program", Better::Lower, kIsDetail},
        },
        {
            {"depth_pass", "drawing the shadow maps"},
            {"shading_pass", "drawing the picture with shadows"},
            {"yardstick_pass", "drawing the same geometry without shadows"},
            {"blur_along_x", "blurring the maps' variances along x"},
            {"blur_along_y", "blurring the maps' variances along y"},
        }};
}

}  // namespace gfxrepro::shadow_mapping
