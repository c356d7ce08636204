#include "techniques/depth_sampling/outputs.h"

namespace gfxrepro::depth_sampling {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"redundant_pct", "%", "share of an image's samples that an earlier image has already",
             Better::Lower},
            {"occluded_pct", "%",
             "share of an image's samples that the output view's own image lacks", Better::Higher},
            {"useful_pct", "%", "share of the occluded samples that some output frame shows",
             Better::Higher},
            {"occluded_sum_pct", "%", "occluded_pct, summed over all images", Better::Higher},
            {"useful_sum_pct", "%", "useful_pct, summed over all images", Better::Higher},
            {"available_pct", "%", "share of an output frame's samples that the images have",
             Better::Higher},
            {"available_mean_pct", "%", "available_pct, mean of all output frames", Better::Higher},
            {"available_min_pct", "%", "available_pct of the worst output frame", Better::Higher},
            {"unavailable_mean_pct", "%", "100 less available_mean_pct", Better::Lower, kIsDetail},
            {"samples", "sample", "samples of an image", Better::Neither, kIsDetail},
            {"coverage_pct", "%", "share of an image's pixels that have a sample", Better::Neither,
             kIsDetail},
            {"redundant_of_pixels_pct", "%", "redundant samples as a share of an image's pixels",
             Better::Lower, kIsDetail},
            {"occluded_literal_pct", "%",
             "share of an image's samples that are occluded by the definition exactly as it is "
             "printed",
             Better::Higher, kIsDetail},
            {"useful_of_samples_pct", "%",
             "share of an image's samples that are occluded and useful", Better::Higher, kIsDetail},
            {"reference_image_bytes", "byte", "memory of all images on the device", Better::Lower},
            {"output_frames", "frame", "frames over which usefulness and availability are counted",
             Better::Neither, kIsDetail},
        },
        {
            {"reference_images", "drawing all depth images"},
            {"image_*", "drawing one depth image; they are counted from 0"},
            {"output_frame", "drawing a frame from the images"},
            {"availability_test", "testing which of the frame's samples the images have"},
        }};
}

}  // namespace gfxrepro::depth_sampling
