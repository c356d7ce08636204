#include "techniques/depth_sampling/outputs.h"

namespace gfxrepro::depth_sampling {

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"redundant_pct", "%", "of an image's samples, that an earlier image has",
             Better::Lower},
            {"occluded_pct", "%", "of an image's samples, that the output view's own image lacks",
             Better::Higher},
            {"useful_pct", "%", "of the occluded samples, that some output frame shows",
             Better::Higher},
            {"occluded_sum_pct", "%", "occluded_pct of all images", Better::Higher},
            {"useful_sum_pct", "%", "useful_pct of all images", Better::Higher},
            {"available_pct", "%", "of an output frame's samples, that the images have",
             Better::Higher},
            {"available_mean_pct", "%", "of the samples of an output frame, over all frames",
             Better::Higher},
            {"available_min_pct", "%", "in the worst output frame", Better::Higher},
            {"unavailable_mean_pct", "%", "100 less available_mean_pct", Better::Lower, kIsDetail},
            {"samples", "sample", "of an image", Better::Neither, kIsDetail},
            {"coverage_pct", "%", "of an image's pixels, that have a sample", Better::Neither,
             kIsDetail},
            {"redundant_of_pixels_pct", "%", "redundant samples, of an image's pixels",
             Better::Lower, kIsDetail},
            {"occluded_literal_pct", "%", "occluded by the definition as it is printed",
             Better::Higher, kIsDetail},
            {"useful_of_samples_pct", "%", "of an image's samples, that are occluded and useful",
             Better::Higher, kIsDetail},
            {"reference_image_bytes", "byte", "of all images on the device", Better::Lower},
            {"output_frames", "frame", "over which usefulness and availability are counted",
             Better::Neither, kIsDetail},
        },
        {
            {"reference_images", "all depth images"},
            {"image_*", "one depth image, counted from 0"},
            {"output_frame", "a frame drawn from the images"},
            {"availability_test", "which samples of the frame the images have"},
        }};
}

}  // namespace gfxrepro::depth_sampling
