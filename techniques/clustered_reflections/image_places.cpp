#include "techniques/clustered_reflections/image_places.h"

#include <algorithm>

namespace gfxrepro::clustered_reflections {
namespace {

/// Images begin at multiples of this, so that small tiles of the pyramid hold one image alone.
constexpr int kPlaceStepPx = 8;

}  // namespace

ImagePlaces::ImagePlaces(const gl::ShaderLibrary& shaders)
    : places_(kMaxClusters * sizeof(glm::ivec4)),
      order_(sizeof(AtlasHeader) + kMaxClusters * sizeof(std::uint32_t)) {
    gl::Defines defines = imageDefines();
    defines["PLACE_STEP_PX"] = kPlaceStepPx;
    pass_ = gl::Pass(shaders, {"clustered_reflections/place_images.comp.glsl"}, defines);
}

void ImagePlaces::place(const gl::Buffer& cameras, const Clusters& clusters,
                        const CameraSettings& settings, glm::ivec2 atlasSizePx) const {
    pass_.set("atlasSizePx", atlasSizePx);
    pass_.set("depthImageScale", settings.depthImageScale);
    pass_.set("texelsPerSample", settings.texelsPerSample);
    pass_.set("maxSizePx", std::min(settings.maxSizePx, atlasSizePx.x));
    pass_.dispatch({1, 1, 1},
                   gl::Resources{{"Ranges", clusters.ranges}}.with(resources(cameras, clusters)));
}

gl::Resources ImagePlaces::resources(const gl::Buffer& cameras, const Clusters& clusters) const {
    return {
        {"Cameras", cameras}, {"Counts", clusters.counts}, {"Places", places_}, {"Order", order_}};
}

}  // namespace gfxrepro::clustered_reflections
