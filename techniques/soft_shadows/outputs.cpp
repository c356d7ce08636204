#include "techniques/soft_shadows/outputs.h"

namespace gfxrepro::soft_shadows {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"intensity_error_mean", "light sample",
             "unshadowed light samples more or fewer than the truth's, mean of the pixels",
             Better::Lower},
            {"intensity_error_max", "light sample", "the worst pixel's", Better::Lower},
            {"visibility_error_mean", "light sample",
             "light samples seen wrongly either way, mean of the pixels", Better::Lower},
            {"visibility_error_max", "light sample", "the worst pixel's", Better::Lower},
            {"caster_triangles", "triangle", "that cast the shadows"},
            {"mesh_triangles", "triangle", "of the meshes made of depth images"},
            {"mesh_bytes", "byte", "of these meshes", Better::Lower},
            {"reference_samples", "sample", "of the depth images"},
            {"bytes_per_sample", "byte", "of the meshes, a sample of the depth images",
             Better::Lower, kIsDetail},
            {"fitted_corners_pct", "%", "of a mesh's corners, that were fitted and are not shared",
             Better::Neither, kIsDetail},
            {"simplification_error", "m", "largest distance of a simplified mesh", Better::Lower},
            {"missing_pct", "%", "of the casters seen from the light, that the meshes lack",
             Better::Lower},
            {"nearer_pct", "%", "of the casters seen from the light, before which the meshes stand",
             Better::Lower},
        },
        {
            {"depth_and_pass", "the receivers' points, as the eye sees them"},
            {"reference_images", "depth images of the casters"},
            {"reconstruction", "meshes of the depth images"},
            {"offset_images", "which samples neighbouring images have"},
            {"simplification", "meshes of fewer triangles"},
            {"soft_shadow", "visibility of all light samples"},
            {"geometry", "against shadow maps of the geometry"},
            {"ray_traced", "against traced rays"},
            {"inside", "seen from the light's centre"},
            {"outside", "seen from beyond the light's edge"},
        }};
}

}  // namespace gfxrepro::soft_shadows
