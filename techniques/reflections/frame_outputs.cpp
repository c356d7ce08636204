#include <algorithm>
#include <iterator>
#include <utility>

#include "techniques/reflections/frame.h"

namespace gfxrepro::reflections {

config::Outputs withFrameOutputs(config::Outputs own) {
    using config::Better;
    constexpr bool kIsDetail = true;
    config::Outputs all;
    all.passes = std::move(own.passes);
    all.metrics = {
        {"channel_error", "level",
         "mean absolute difference of a colour channel (0 … 255) to the truth, over reflective "
         "pixels",
         Better::Lower},
        {"channel_error_image", "level", "channel_error over all pixels", Better::Lower, kIsDetail},
        {"psnr_db", "dB", "peak signal-to-noise ratio of the whole picture", Better::Higher},
        {"flip_mean", "1", "mean FLIP error of the whole picture", Better::Lower},
        {"reflective_pct", "%", "share of all samples that reflect"},
        {"memory_bytes", "byte", "memory on the device", Better::Lower},
    };
    std::ranges::move(own.metrics, std::back_inserter(all.metrics));
    all.passes.insert(all.passes.end(),
                      {
                          {"bvh_build", "building the ray tracer's bounding volume hierarchy"},
                          {"bvh_codes", "of that: places along a curve"},
                          {"bvh_sort", "of that: sorting"},
                          {"bvh_hierarchy", "of that: nodes"},
                          {"bvh_boxes", "of that: boxes"},
                          {"ray_list", "listing the samples that need rays"},
                          {"transfer", "copying between device and host"},
                          {"intersection", "tracing reflected rays to where they meet the scene"},
                          {"environment_map", "drawing the scene around the room's centre"},
                          {"composite", "joining diffuse and reflected light to the picture"},
                      });
    return all;
}

}  // namespace gfxrepro::reflections
