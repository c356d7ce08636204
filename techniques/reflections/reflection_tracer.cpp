#include "techniques/reflections/reflection_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

namespace {

constexpr float kGoldenAngleRad = 2.39996323F;
constexpr float kFewestRays = 8.0F, kMostRays = 49.0F;  // Sec. 4.6

}  // namespace

int raysOf(const LobeSettings& lobe, float glossiness) {
    if (glossiness <= 0.0F) return 1;
    if (lobe.rays > 0) return lobe.rays;
    return static_cast<int>(std::round(glm::mix(kFewestRays, kMostRays, glossiness)));
}

glm::vec3 lobeDirection(const LobeSettings& lobe, const glm::vec3& mirrorDirection,
                        float glossiness, int index, int count) {
    if (glossiness <= 0.0F) return mirrorDirection;
    const float place = (static_cast<float>(index) + 0.5F) / static_cast<float>(count);
    const float cosine = 1.0F - place * (1.0F - std::cos(glossiness * lobe.maxHalfAngleRad));
    const float sine = std::sqrt(std::max(1.0F - cosine * cosine, 0.0F));
    const float angle = kGoldenAngleRad * static_cast<float>(index);
    const glm::vec3 n = mirrorDirection;
    const float s = n.z >= 0.0F ? 1.0F : -1.0F;
    const float a = -1.0F / (s + n.z);
    const float b = n.x * n.y * a;
    const glm::vec3 tangent(1.0F + s * n.x * n.x * a, s * b, -s * n.x);
    const glm::vec3 bitangent(b, s + n.y * n.y * a, -n.y);
    return glm::normalize(cosine * n +
                          sine * (std::cos(angle) * tangent + std::sin(angle) * bitangent));
}

float farPlaneM(const LobeSettings& lobe, float glossiness, float diagonalM) {
    return diagonalM * std::pow(1.0F - glossiness, lobe.farExponent);
}

float fadeOf(const LobeSettings& lobe, float glossiness, float distanceM, float diagonalM) {
    if (glossiness <= 0.0F) return 1.0F;
    return std::clamp(3.0F * (1.0F - distanceM / farPlaneM(lobe, glossiness, diagonalM)), 0.0F,
                      1.0F);
}

void setLobe(const gl::Program& program, const LobeSettings& lobe, float diagonalM) {
    program.setIfActive("lobeRays", lobe.rays);
    program.setIfActive("lobeMaxHalfAngle", lobe.maxHalfAngleRad);
    program.setIfActive("lobeFarExponent", lobe.farExponent);
    program.setIfActive("lobeDiagonal", diagonalM);
}

ReflectionTarget::ReflectionTarget(glm::ivec2 sizePx)
    : radiance(gl::Texture::make2D(GL_RGBA16F, sizePx)),
      distance(gl::Texture::make2D(GL_R32F, sizePx)),
      framebuffer(std::array<const gl::Texture*, 2>{&radiance, &distance}) {}

std::size_t ReflectionTarget::sizeBytes() const {
    return radiance.sizeBytes() + distance.sizeBytes();
}

namespace {

/// As OpenGL has cube maps: where a face looks, and which way its rows go.
struct Face {
    glm::vec3 forward;
    glm::vec3 up;
};
constexpr Face kFaces[6] = {{{1, 0, 0}, {0, -1, 0}}, {{-1, 0, 0}, {0, -1, 0}},
                            {{0, 1, 0}, {0, 0, 1}},  {{0, -1, 0}, {0, 0, -1}},
                            {{0, 0, 1}, {0, -1, 0}}, {{0, 0, -1}, {0, -1, 0}}};

/// The farthest corner of the objects' boxes.
float reachOf(std::span<const scene::Box> boxes, const glm::vec3& from) {
    float reach = 0.0F;
    for (const scene::Box& box : boxes) {
        if (box.isEmpty()) continue;
        const glm::vec3 farthest = glm::max(glm::abs(box.min - from), glm::abs(box.max - from));
        reach = std::max(reach, glm::length(farthest));
    }
    return reach;
}

/// By a pass over the whole image that knows which samples are wanted.
void drawReflections(const gl::Pass& pass, const kit::WholeImage& wholeImage,
                     const EnvironmentMap& map, const GBuffer& gbuffer, const gl::Texture* wanted,
                     ReflectionTarget& target) {
    GFXREPRO_ASSERT(wanted == nullptr || wanted->size() == gbuffer.depth.size());
    pass.set("hasWanted", wanted != nullptr ? 1 : 0);
    pass.use(gl::Resources{{"wanted", wanted != nullptr ? *wanted : gbuffer.surface}}
                 .with(gbuffer.resourcesFor(pass))
                 .with(map.resources()));
    target.framebuffer.bind();
    wholeImage.draw();
}

}  // namespace

// Colours are in [0, 1], as in the G-buffer.
EnvironmentMap::EnvironmentMap(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene,
                               const glm::vec3& centreWorld)
    : centreWorld_(centreWorld),
      cube_(gl::Texture::makeCube(kKeptColourFormat, kFaceSizePx)),
      depth_(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, glm::ivec2(kFaceSizePx))),
      pass_(shaders, {"reflections/surface.vert.glsl", "reflections/environment_map.frag.glsl"},
            surfaceDefines(scene)) {}

void EnvironmentMap::render(const GpuObjects& objects) {
    // Everything lies before the far plane; what is nearer than a thousandth of it is cut off.
    const float farM = std::max(1.001F * reachOf(objects.boundsWorld(), centreWorld_), 1e-3F);
    const glm::mat4 clipFromView = glm::perspective(glm::radians(90.0F), 1.0F, 1e-3F * farM, farM);
    kit::setNearestWins();
    pass_.set("eyeWorld", centreWorld_);
    pass_.use(objects.resources());
    for (int i = 0; i < 6; ++i) {
        const gl::Framebuffer framebuffer = gl::Framebuffer::ofLayer(cube_, i, &depth_);
        framebuffer.clearColour(0, glm::vec4(keptColour(kBackground), 1.0F));
        framebuffer.clearDepth(1.0F);
        framebuffer.bind();
        const glm::mat4 clipFromWorld =
            clipFromView *
            glm::lookAt(centreWorld_, centreWorld_ + kFaces[i].forward, kFaces[i].up);
        pass_.set("clipFromWorld", clipFromWorld);
        objects.draw(objects.within(clipFromWorld));
    }
}

std::size_t EnvironmentMap::sizeBytes() const {
    return cube_.sizeBytes() + depth_.sizeBytes();
}

EnvironmentTracer::EnvironmentTracer(const gl::ShaderLibrary& shaders, EnvironmentMap& map,
                                     const LobeSettings& lobe, float diagonalM)
    : map_(map),
      lobe_(lobe),
      diagonalM_(diagonalM),
      pass_(shaders, {"kit/whole_image.vert.glsl", "reflections/environment_trace.frag.glsl"}) {}

void EnvironmentTracer::update(const GpuObjects& objects, gl::Profiler& profiler) {
    if (!poses_.hasChanged(objects.poses())) return;
    const gl::GpuScope scope(profiler, "environment_map");
    map_.render(objects);
}

void EnvironmentTracer::trace(const GBuffer& gbuffer, const gl::Texture* wanted,
                              ReflectionTarget& target, gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "intersection");
    setLobe(pass_, lobe_, diagonalM_);
    drawReflections(pass_, wholeImage_, map_, gbuffer, wanted, target);
}

std::size_t EnvironmentTracer::sizeBytes() const {
    return map_.sizeBytes();
}

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
    pass_.set("pixelsFromWorld",
              glm::mat4(glm::inverse(glm::dmat4(kit::worldFromPixels(gbuffer.view)))));
    pass_.set("nearM", gbuffer.view.nearM);
    pass_.set("thicknessM", thicknessM_);
    setLobe(pass_, lobe_, diagonalM_);
    drawReflections(pass_, wholeImage_, map_, gbuffer, wanted, target);
}

}  // namespace gfxrepro::reflections
