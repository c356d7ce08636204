#include "techniques/reflection_reuse/reflection_reuse.h"

namespace gfxrepro::reflection_reuse {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"recomputed_pct", "%",
             "of the reflective samples of a frame between key frames, that were traced",
             Better::Lower},
            {"saved_pct", "%", "of the reflective samples of any frame, that were not traced",
             Better::Higher},
            {"channel_error", "level",
             "mean absolute difference of a channel, 0 … 255, over reflective pixels",
             Better::Lower},
            {"channel_error_image", "level", "over all pixels", Better::Lower, kIsDetail},
            {"psnr_db", "dB", "of the whole picture", Better::Higher},
            {"flip_mean", "1", "FLIP of the whole picture", Better::Lower},
            {"undetected_pct", "%",
             "of the reflective samples, that were reused and are off by more than 16 levels",
             Better::Lower},
            {"reflective_pct", "%", "of all samples"},
            {"recomputed_samples", "sample", "that were traced", Better::Neither, kIsDetail},
            {"is_key_frame", "1", "1: all of the frame was traced", Better::Neither, kIsDetail},
            {"key_frame_interval", "frame", "frames since the key frame before", Better::Higher},
            {"unmatched_pct", "%",
             "of the key frame's reflective samples, that the search found no place for",
             Better::Lower},
            {"unshifted_pct", "%", "of them, that were not shifted", Better::Lower},
            {"matching_steps", "step", "of a search, in the mean", Better::Lower, kIsDetail},
            {"wrong_minimum_pct", "%", "of searches checked in full, that ended at another place",
             Better::Lower},
            {"recompute_time_r_squared", "1", "how well the time follows the number of samples",
             Better::Neither, kIsDetail},
            {"recompute_fit_us_per_sample", "us", "of that line: a sample", Better::Lower,
             kIsDetail},
            {"recompute_fit_fixed_ms", "ms", "of that line: without any", Better::Lower, kIsDetail},
            {"memory_bytes", "byte", "on the device", Better::Lower},
        },
        {
            {"diffuse", "what the eye sees"},
            {"recompute", "tracing what is not reused"},
            {"reflection_shift", "the key frame's reflections to their new places"},
            {"reflection_warp", "the same by a grid"},
            {"pixel_matching", "where the new view shows a reflected point"},
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

}  // namespace gfxrepro::reflection_reuse
