#include "techniques/clustered_reflections/clustered_reflections.h"

namespace gfxrepro::clustered_reflections {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"channel_error", "level",
             "mean absolute difference of a channel, 0 … 255, over reflective pixels",
             Better::Lower},
            {"channel_error_r", "level", "of red alone", Better::Lower, kIsDetail},
            {"channel_error_g", "level", "of green alone", Better::Lower, kIsDetail},
            {"channel_error_b", "level", "of blue alone", Better::Lower, kIsDetail},
            {"channel_error_converged", "level", "to the truth of many rays a sample",
             Better::Lower},
            {"channel_error_image", "level", "over all pixels", Better::Lower, kIsDetail},
            {"psnr_db", "dB", "of the whole picture", Better::Higher},
            {"flip_mean", "1", "FLIP of the whole picture", Better::Lower},
            {"clusters", "cluster", "of reflective samples"},
            {"environment_pct", "%", "of clustered samples, that fell back to the environment map",
             Better::Lower},
            {"occlusion_error_pct", "%",
             "of reflective samples, whose hit their image does not hold", Better::Lower},
            {"occlusion_hidden_pct", "%", "of them: hidden by something else", Better::Lower,
             kIsDetail},
            {"occlusion_near_pct", "%", "of them: before the near plane", Better::Lower, kIsDetail},
            {"occlusion_side_pct", "%", "of them: beside the image", Better::Lower, kIsDetail},
            {"occlusion_self_pct", "%", "of them: the reflector itself", Better::Lower, kIsDetail},
            {"occlusion_error_planar_pct", "%", "of the samples of planar reflectors",
             Better::Lower, kIsDetail},
            {"reflective_pct", "%", "of all samples"},
            {"planar_pct", "%", "of the reflective samples, on planes", Better::Neither, kIsDetail},
            {"visible_reflectors", "reflector", "objects that reflect and are seen"},
            {"visible_parts", "reflector", "smooth parts of them", Better::Neither, kIsDetail},
            {"reflectors", "reflector", "objects that reflect"},
            {"parts", "reflector", "smooth parts of them", Better::Neither, kIsDetail},
            {"diffuse_triangles", "triangle", "that do not reflect"},
            {"reflective_triangles", "triangle", "that reflect"},
            {"drawn_triangles", "triangle", "into all depth images", Better::Lower},
            {"drawn_left_out", "triangle", "that the lists of `atlas` or `visible` had no room for",
             Better::Neither, kIsDetail},
            {"texels_per_sample", "texel", "of the depth images, a reflective sample",
             Better::Lower},
            {"memory_bytes", "byte", "on the device", Better::Lower},
            {"frame_buffer_bytes", "byte", "of it: colours and depths of screen and clusters",
             Better::Lower, kIsDetail},
        },
        {
            {"first_pass", "what the eye sees"},
            {"first_pass_and_clustering",
             "what the eye sees, and clusters of its reflective samples"},
            {"cluster_cameras", "a camera a cluster"},
            {"depth_images", "depth images of the clusters"},
            {"bvh_build", "the ray tracer's bounding volume hierarchy"},
            {"bvh_codes", "of it: places along a curve"},
            {"bvh_sort", "of it: sorting"},
            {"bvh_hierarchy", "of it: nodes"},
            {"bvh_boxes", "of it: boxes"},
            {"ray_list", "which samples need rays"},
            {"transfer", "between device and host"},
            {"intersection", "where reflected rays meet the scene"},
            {"environment_map", "the scene around the room's centre"},
            {"composite", "the picture of diffuse and reflected light"},
        }};
}

}  // namespace gfxrepro::clustered_reflections
