#include "techniques/shadow_mapping/outputs.h"

namespace gfxrepro::shadow_mapping {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {{
                {"wrong_pct", "%", "of the compared points, that are lit or shadowed wrongly",
                 Better::Lower},
                {"acne_pct", "%", "of the compared points: shadowed by their own surface",
                 Better::Lower},
                {"leak_pct", "%", "of the compared points: lit behind a caster", Better::Lower},
                {"edge_pct", "%", "of the compared points: within a texel of the shadow's edge",
                 Better::Lower},
                {"compared_points", "pixel", "of all lights"},
                {"methods_differ_pct", "%",
                 "of the pixels: where the other method shows another shadow", Better::Lower},
                {"memory_bytes", "byte", "of the shadow maps", Better::Lower},
                {"lights_without_caster", "light", "that nothing stands before", Better::Lower,
                 kIsDetail},
                {"colour_writes", "1", "1: the step writes colours", Better::Neither, kIsDetail},
                {"depth_writes", "1", "1: the step writes depths", Better::Neither, kIsDetail},
                {"fragment_work", "1", "1: the step runs a fragment program", Better::Neither,
                 kIsDetail},
                {"fetches", "1", "texels that the step fetches", Better::Lower, kIsDetail},
                {"comparisons", "1", "that the step's program makes", Better::Lower, kIsDetail},
            },
            {
                {"depth_pass", "the shadow maps"},
                {"shading_pass", "the picture"},
                {"yardstick_pass", "the same geometry without shadows"},
                {"blur_along_x", "the maps' variances blurred"},
                {"blur_along_y", "the maps' variances blurred"},
            }};
}

}  // namespace gfxrepro::shadow_mapping
