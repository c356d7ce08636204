#include "techniques/reflection_reuse/reflection_reuse.h"
#include "techniques/reflections/frame.h"

namespace gfxrepro::reflection_reuse {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return reflections::withFrameOutputs({
        {
            {"recomputed_pct", "%",
             "share of the reflective samples that were traced, in frames between key frames",
             Better::Lower},
            {"saved_pct", "%",
             "share of the reflective samples that were not traced, over all frames",
             Better::Higher},
            {"undetected_pct", "%",
             "share of the reflective samples that were reused although they are off by more than "
             "16 levels",
             Better::Lower},
            {"recomputed_samples", "sample", "samples that were traced", Better::Neither,
             kIsDetail},
            {"is_key_frame", "1", "1 where all of the frame was traced", Better::Neither,
             kIsDetail},
            {"key_frame_interval", "frame", "frames since the key frame before", Better::Higher},
            {"unmatched_pct", "%",
             "share of the key frame's reflective samples for which the search found no place",
             Better::Lower},
            {"unshifted_pct", "%",
             "share of the key frame's reflective samples that were not shifted", Better::Lower},
            {"matching_steps", "step", "mean number of steps of a search", Better::Lower,
             kIsDetail},
            {"wrong_minimum_pct", "%",
             "share of the searches checked in full that ended at the wrong place", Better::Lower},
            {"recompute_time_r_squared", "1",
             "how well a line through the number of traced samples gives the time of tracing (R²)",
             Better::Neither, kIsDetail},
            {"recompute_fit_us_per_sample", "us", "time of tracing one sample more, by such a line",
             Better::Lower, kIsDetail},
            {"recompute_fit_fixed_ms", "ms", "time of tracing without any sample, by such a line",
             Better::Lower, kIsDetail},
        },
        {
            {"diffuse", "drawing what the eye sees"},
            {"recompute", "tracing what is not reused"},
            {"reflection_shift", "moving the key frame's reflections to their new places"},
            {"reflection_warp", "moving them by a grid instead"},
            {"pixel_matching", "searching where the new view shows a reflected point"},
        },
    });
}

}  // namespace gfxrepro::reflection_reuse
