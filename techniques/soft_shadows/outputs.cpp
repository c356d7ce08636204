#include "techniques/soft_shadows/outputs.h"

namespace gfxrepro::soft_shadows {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"intensity_error_mean", "light sample",
             "how many light samples too many or too few light a pixel, mean of all pixels",
             Better::Lower},
            {"intensity_error_max", "light sample", "intensity error of the worst pixel",
             Better::Lower},
            {"visibility_error_mean", "light sample",
             "light samples that a pixel sees wrongly either way, mean of all pixels",
             Better::Lower},
            {"wrongly_lit_mean", "light sample",
             "of these, samples that light a pixel and should not", Better::Lower, kIsDetail},
            {"wrongly_dark_mean", "light sample",
             "of these, samples that should light a pixel and do not", Better::Lower, kIsDetail},
            {"visibility_error_max", "light sample", "visibility error of the worst pixel",
             Better::Lower},
            {"coverage_pct", "%", "share of the picture's pixels that show a surface",
             Better::Neither, kIsDetail},
            {"caster_triangles", "triangle", "triangles that cast the shadows"},
            {"mesh_triangles", "triangle", "triangles of the meshes made of depth images"},
            {"mesh_bytes", "byte", "memory of these meshes", Better::Lower},
            {"reference_samples", "sample", "samples of the depth images"},
            {"bytes_per_sample", "byte", "memory of the meshes for each sample of the depth images",
             Better::Lower, kIsDetail},
            {"fitted_corners_pct", "%",
             "share of a mesh's corners that were fitted and are not shared", Better::Neither,
             kIsDetail},
            {"simplification_error", "m", "largest distance by which simplification moved a mesh",
             Better::Lower},
            {"missing_pct", "%", "share of the casters seen from the light that the meshes lack",
             Better::Lower},
            {"nearer_pct", "%",
             "share of the casters seen from the light that the meshes stand before",
             Better::Lower},
        },
        {
            {"depth_and_pass", "drawing the receivers' points as the eye sees them"},
            {"reference_images", "drawing depth images of the casters"},
            {"reconstruction", "making meshes of the depth images"},
            {"offset_images", "of that: finding which samples neighbouring images have"},
            {"simplification", "reducing the triangles of the meshes"},
            {"soft_shadow", "testing the visibility of all light samples"},
            {"geometry", "errors against shadow maps of the geometry"},
            {"ray_traced", "errors against traced rays"},
            {"inside", "as seen from the light's centre"},
            {"outside", "as seen from beyond the light's edge"},
        }};
}

}  // namespace gfxrepro::soft_shadows
