#include "techniques/reflections/screen_space_tracer.h"

#include "runner/core/error.h"

namespace gfxrepro::reflections {

namespace {

constexpr unsigned kGBufferUnit = kFirstFreeUnit;  // four of them
constexpr unsigned kEnvironmentUnit = kGBufferUnit + 4;
constexpr unsigned kWantedUnit = kEnvironmentUnit + 1;

}  // namespace

ScreenSpaceTracer::ScreenSpaceTracer(const gl::ShaderLibrary& shaders, const EnvironmentMap& map,
                                     const LobeSettings& lobe, float diagonalM, float thicknessM)
    : map_(map),
      lobe_(lobe),
      diagonalM_(diagonalM),
      thicknessM_(thicknessM),
      program_(shaders, {"kit/whole_image.vert.glsl", "reflections/screen_space.frag.glsl"},
               {{"ENVIRONMENT_UNIT", kEnvironmentUnit},
                {"GBUFFER_UNIT", kGBufferUnit},
                {"WANTED_UNIT", kWantedUnit}}) {}

void ScreenSpaceTracer::trace(const GBuffer& gbuffer, const gl::Texture* wanted,
                              ReflectionTarget& target, gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "intersection");
    target.framebuffer.bind();
    program_.use();
    gbuffer.bind(program_, kGBufferUnit);
    map_.bind(kEnvironmentUnit);
    program_.set("hasWanted", wanted != nullptr ? 1 : 0);
    if (wanted != nullptr) {
        GFXREPRO_ASSERT(wanted->size() == gbuffer.depth.size());
        wanted->bind(kWantedUnit);
    }
    program_.set("pixelsFromWorld",
                 glm::mat4(glm::inverse(glm::dmat4(kit::worldFromPixels(gbuffer.view)))));
    program_.set("nearM", gbuffer.view.nearM);
    program_.set("thicknessM", thicknessM_);
    setLobe(program_, lobe_, diagonalM_);
    wholeImage_.draw();
}

}  // namespace gfxrepro::reflections
