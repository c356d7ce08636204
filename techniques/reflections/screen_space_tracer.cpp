#include "techniques/reflections/screen_space_tracer.h"

#include "engine/core/error.h"

namespace gfxrepro::reflections {

ScreenSpaceTracer::ScreenSpaceTracer(const gl::ShaderLibrary& shaders, const EnvironmentMap& map,
                                     const LobeSettings& lobe, float diagonalM, float thicknessM)
    : map_(map),
      lobe_(lobe),
      diagonalM_(diagonalM),
      thicknessM_(thicknessM),
      pass_(shaders, {"kit/whole_image.vert.glsl", "reflections/screen_space.frag.glsl"}) {}

void ScreenSpaceTracer::trace(const GBuffer& gbuffer, const gl::Texture* wanted,
                              ReflectionTarget& target, gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "intersection");
    target.framebuffer.bind();
    GFXREPRO_ASSERT(wanted == nullptr || wanted->size() == gbuffer.depth.size());
    pass_.set("hasWanted", wanted != nullptr ? 1 : 0);
    pass_.set("pixelsFromWorld",
              glm::mat4(glm::inverse(glm::dmat4(kit::worldFromPixels(gbuffer.view)))));
    pass_.set("nearM", gbuffer.view.nearM);
    pass_.set("thicknessM", thicknessM_);
    setLobe(pass_, lobe_, diagonalM_);
    pass_.use(gl::Resources{{"wanted", wanted != nullptr ? *wanted : gbuffer.surface}}
                  .with(gbuffer.resourcesFor(pass_))
                  .with(map_.resources()));
    wholeImage_.draw();
}

}  // namespace gfxrepro::reflections
