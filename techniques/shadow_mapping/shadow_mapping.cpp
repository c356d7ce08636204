#include "techniques/shadow_mapping/shadow_mapping.h"

#include "techniques/kit/requirements.h"

namespace gfxrepro::shadow_mapping {

ShadowMapping::ShadowMapping(Params& params) : params_(params) {}

void ShadowMapping::requireScene(const scene::Scene& scene) const {
    kit::requireTriangles(scene, "shadow_mapping");
    makeLights(params_, scene);  // refuses a scene with fewer lights than are asked for
}

void ShadowMapping::setup(technique::SetupContext& context) {
    const scene::Scene& scene = *context.scene;
    shaders_ = &context.shaders;
    lights_ = makeLights(params_, scene);
    tracer_.emplace(scene);
    requireOutside(*tracer_, lights_);
    lightsWithoutCaster_ = lightsWithoutCaster(lights_, scene, params_.maps.sizePx);

    drawable_.emplace(scene);
    maps_.emplace(context.shaders, params_.maps);
    if (params_.drawsYardstick) {
        ShadowMapSettings depthAlone;
        depthAlone.sizePx = params_.maps.sizePx;
        depthAlone.format = params_.maps.format;
        yardstick_.emplace(context.shaders, depthAlone);
    }
    shadedView_.emplace(context.shaders, params_.maps);
    const glm::vec2 size(context.outputSizePx);
    const scene::Camera camera = scene.cameras.empty()
                                     ? scene::framingCamera(scene.bounds(), size.x / size.y)
                                     : scene.cameras.front();
    image_.emplace(makeShadedImage(kit::viewOf(camera, context.outputSizePx), false));
    // [zju2005] Sec. 4.1: the map is used again while the light and the objects stand still.
    if (params_.isStatic) maps_->render(*drawable_, lights_);
}

// [zju2005] Sec. 4.1
void ShadowMapping::render(technique::FrameContext& context) {
    if (!params_.isStatic) {
        const gl::GpuScope scope(context.profiler, "depth_pass");
        maps_->render(*drawable_, lights_);
    }
    if (yardstick_) {
        const gl::GpuScope scope(context.profiler, "yardstick_pass");
        yardstick_->render(*drawable_, lights_);
    }
    const gl::GpuScope scope(context.profiler, "shading_pass");
    shadedView_->render(*drawable_, *maps_, *image_);
}

}  // namespace gfxrepro::shadow_mapping
