#include "techniques/clustered_reflections/clustered_reflections.h"
#include "techniques/reflections/frame.h"

namespace gfxrepro::clustered_reflections {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return reflections::withFrameOutputs({
        {
            {"channel_error_r", "level", "channel_error of red alone", Better::Lower, kIsDetail},
            {"channel_error_g", "level", "channel_error of green alone", Better::Lower, kIsDetail},
            {"channel_error_b", "level", "channel_error of blue alone", Better::Lower, kIsDetail},
            {"channel_error_converged", "level", "channel_error to a truth of many rays per sample",
             Better::Lower},
            {"clusters", "cluster", "clusters of reflective samples"},
            {"environment_pct", "%",
             "share of the clustered samples that fell back to the environment map", Better::Lower},
            {"occlusion_error_pct", "%",
             "share of the reflective samples whose cluster's image does not hold what they "
             "reflect",
             Better::Lower},
            {"occlusion_hidden_pct", "%", "of these: it is hidden by something else", Better::Lower,
             kIsDetail},
            {"occlusion_near_pct", "%", "of these: it lies before the image's near plane",
             Better::Lower, kIsDetail},
            {"occlusion_side_pct", "%", "of these: it lies beside the image", Better::Lower,
             kIsDetail},
            {"occlusion_self_pct", "%", "of these: it lies on the reflector itself", Better::Lower,
             kIsDetail},
            {"occlusion_error_planar_pct", "%", "occlusion_error_pct of planar reflectors",
             Better::Lower, kIsDetail},
            {"planar_pct", "%", "share of the reflective samples that lie on planes",
             Better::Neither, kIsDetail},
            {"visible_reflectors", "reflector", "reflecting objects that are seen"},
            {"visible_parts", "reflector", "smooth parts of the reflecting objects that are seen",
             Better::Neither, kIsDetail},
            {"reflectors", "reflector", "reflecting objects"},
            {"parts", "reflector", "smooth parts of the reflecting objects", Better::Neither,
             kIsDetail},
            {"diffuse_triangles", "triangle", "triangles that do not reflect"},
            {"reflective_triangles", "triangle", "triangles that reflect"},
            {"drawn_triangles", "triangle", "triangles drawn into all depth images", Better::Lower},
            {"drawn_left_out", "triangle",
             "triangles left out because the lists of `atlas` or `visible` had no room",
             Better::Neither, kIsDetail},
            {"texels_per_sample", "texel", "texels of the depth images for each reflective sample",
             Better::Lower},
            {"frame_buffer_bytes", "byte",
             "memory of colours and depths, of the screen and of the clusters", Better::Lower,
             kIsDetail},
        },
        {
            {"first_pass", "drawing what the eye sees"},
            {"first_pass_and_clustering",
             "drawing what the eye sees, and clustering its reflective samples"},
            {"cluster_cameras", "placing a camera for each cluster"},
            {"depth_images", "drawing the depth images of the clusters"},
        },
    });
}

}  // namespace gfxrepro::clustered_reflections
