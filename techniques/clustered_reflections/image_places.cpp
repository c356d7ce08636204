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
    program_ = gl::Program(shaders, {"clustered_reflections/place_images.comp.glsl"}, defines);
}

void ImagePlaces::place(const gl::Buffer& cameras, const Clusters& clusters,
                        const CameraSettings& settings, glm::ivec2 atlasSizePx) const {
    cameras.bindStorage(kCamerasBinding);
    clusters.counts.bindStorage(kImageCountsBinding);
    clusters.ranges.bindStorage(kRangesBinding);
    places_.bindStorage(kPlacesBinding);
    order_.bindStorage(kOrderBinding);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program_.use();
    program_.set("atlasSizePx", atlasSizePx);
    program_.set("depthImageScale", settings.depthImageScale);
    program_.set("texelsPerSample", settings.texelsPerSample);
    program_.set("maxSizePx", std::min(settings.maxSizePx, atlasSizePx.x));
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

}  // namespace gfxrepro::clustered_reflections
