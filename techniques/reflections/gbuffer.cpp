#include "techniques/reflections/gbuffer.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <glm/packing.hpp>
#include <limits>

#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

namespace {

/// Outputs in the order of the framebuffer's attachments.
enum Target {
    kDiffuseTarget = 0,
    kNormalTarget = 1,
    kDepthTarget = 2,
    kSurfaceTarget = 3,
    kTriangleNormalTarget = 4
};

gl::Defines gbufferDefines(const ReflectiveScene& scene) {
    gl::Defines defines = surfaceDefines(scene);
    defines["kDepthTarget"] = kDepthTarget;
    defines["kDiffuseTarget"] = kDiffuseTarget;
    defines["kNormalTarget"] = kNormalTarget;
    defines["kSurfaceTarget"] = kSurfaceTarget;
    defines["kTriangleNormalTarget"] = kTriangleNormalTarget;
    return defines;
}

void clear(const GBuffer& target) {
    constexpr GLuint kNoSurface[4] = {};
    target.framebuffer.clearColour(kDiffuseTarget, glm::vec4(keptColour(kBackground), 0.0F));
    target.framebuffer.clearColour(kNormalTarget, glm::vec4(0.0F));
    target.framebuffer.clearColour(kDepthTarget, glm::vec4(0.0F));
    glClearNamedFramebufferuiv(target.framebuffer.id(), GL_COLOR, kSurfaceTarget, kNoSurface);
    if (target.hasTriangleNormals()) {
        glClearNamedFramebufferuiv(target.framebuffer.id(), GL_COLOR, kTriangleNormalTarget,
                                   kNoSurface);
    }
    target.framebuffer.clearDepth(1.0F);
}

/// besideMirror() of shaders/beam.glsl.
struct BesideMirror {
    glm::vec3 begin{0.0F}, perMetre{0.0F};
};
BesideMirror besideMirror(const HostGBuffer& gbuffer, glm::ivec2 pixel, glm::ivec2 axis) {
    const glm::vec3& eye = gbuffer.view.eyeWorld;
    const auto viewDirection = [&](glm::ivec2 through) {
        const glm::vec4 place((glm::vec2(through) + 0.5F), 1.0F, 1.0F);
        return glm::normalize(glm::vec3(gbuffer.worldFromPixels * place) - eye);
    };
    const glm::vec3 normal = gbuffer.normalWorld[gbuffer.indexOf(pixel)];
    float least = std::numeric_limits<float>::max();
    int side = 1;
    glm::vec3 besideNormal = normal;
    for (const int i : {-1, 1}) {
        const glm::ivec2 beside = pixel + i * axis;
        if (!gbuffer.holds(beside)) continue;
        if (gbuffer.reflectorAt(beside) != gbuffer.reflectorAt(pixel)) continue;
        const glm::vec3& there = gbuffer.normalWorld[gbuffer.indexOf(beside)];
        const float bend = glm::dot(there - normal, there - normal);
        if (bend >= least) continue;
        least = bend;
        side = i;
        besideNormal = there;
    }
    const glm::vec3 view = viewDirection(pixel), besideView = viewDirection(pixel + side * axis);
    const float distanceM = glm::distance(gbuffer.positionWorld(pixel), eye);
    const auto sign = static_cast<float>(side);
    return {sign * distanceM * glm::reflect(besideView - view, normal),
            sign * (glm::reflect(besideView, besideNormal) - glm::reflect(view, normal))};
}

float signNotZero(float value) {
    return value >= 0.0F ? 1.0F : -1.0F;
}

}  // namespace

glm::vec3 directionFromOctahedral(const glm::vec2& e) {
    glm::vec3 v(e, 1.0F - std::abs(e.x) - std::abs(e.y));
    if (v.z < 0.0F) {
        v = glm::vec3((1.0F - std::abs(v.y)) * signNotZero(v.x),
                      (1.0F - std::abs(v.x)) * signNotZero(v.y), v.z);
    }
    return v;
}

GBuffer::GBuffer(const kit::View& ofView, bool hasTriangleNormals)
    : view(ofView),
      diffuse(gl::Texture::make2D(kKeptColourFormat, view.sizePx)),
      normal(gl::Texture::make2D(GL_RG32F, view.sizePx)),
      depth(gl::Texture::make2D(GL_R32F, view.sizePx)),
      surface(gl::Texture::make2D(GL_R32UI, view.sizePx)),
      depthBuffer(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, view.sizePx)) {
    std::vector<const gl::Texture*> targets{&diffuse, &normal, &depth, &surface};
    if (hasTriangleNormals) {
        triangleNormal = gl::Texture::make2D(GL_R32UI, view.sizePx);
        targets.push_back(&triangleNormal);
    }
    framebuffer = gl::Framebuffer(targets, &depthBuffer);
}

void GBuffer::setUniforms(const gl::Program& program) const {
    program.setIfActive("gbufferWorldFromPixels", kit::worldFromPixels(view));
    program.setIfActive("gbufferEyeWorld", view.eyeWorld);
}

gl::Resources GBuffer::resources() const {
    gl::Resources resources{{"gbufferDiffuse", diffuse},
                            {"gbufferNormal", normal},
                            {"gbufferDepth", depth},
                            {"gbufferSurface", surface}};
    if (hasTriangleNormals()) resources.add({"gbufferTriangleNormal", triangleNormal});
    return resources;
}

std::size_t GBuffer::sizeBytes() const {
    return diffuse.sizeBytes() + normal.sizeBytes() + depth.sizeBytes() + surface.sizeBytes() +
           (hasTriangleNormals() ? triangleNormal.sizeBytes() : 0) + depthBuffer.sizeBytes();
}

GBufferRenderer::GBufferRenderer(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene)
    : pass_(shaders, {"reflections/surface.vert.glsl", "reflections/gbuffer.frag.glsl"},
            gbufferDefines(scene)) {}

void GBufferRenderer::render(const GpuObjects& objects, GBuffer& target) const {
    kit::setNearestWins();
    clear(target);
    target.framebuffer.bind();
    pass_.set("clipFromWorld", target.view.clipFromWorld());
    pass_.set("eyeWorld", target.view.eyeWorld);
    pass_.use(objects.resources());
    objects.drawAll();
}

HostGBuffer GBufferRenderer::readForRays(const GpuObjects& objects, const GBuffer& gbuffer) const {
    if (gbuffer.hasTriangleNormals()) return readGBuffer(gbuffer);
    GBuffer whole(gbuffer.view);
    render(objects, whole);
    return readGBuffer(whole);
}

HostGBuffer readGBuffer(const GBuffer& gbuffer) {
    HostGBuffer host;
    host.view = gbuffer.view;
    host.worldFromPixels = kit::worldFromPixels(host.view);
    host.diffuse = gbuffer.diffuse.read<glm::vec3>(GL_RGB, GL_FLOAT, 1);
    host.normalOctahedral = gbuffer.normal.read<glm::vec2>(GL_RG, GL_FLOAT, 1);
    host.depthM = gbuffer.depth.read<float>(GL_RED, GL_FLOAT, 1);
    host.surface = readSurfaces(gbuffer);
    std::vector<std::uint32_t> ofTriangles;
    if (gbuffer.hasTriangleNormals()) {
        ofTriangles =
            gbuffer.triangleNormal.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
    }
    host.normalWorld.resize(host.depthM.size());
    host.triangleNormalWorld.resize(host.depthM.size());
    tbb::parallel_for(std::size_t{0}, host.depthM.size(), [&](std::size_t i) {
        host.diffuse[i] = linearColour(host.diffuse[i]);
        host.normalWorld[i] = glm::normalize(directionFromOctahedral(host.normalOctahedral[i]));
        if (ofTriangles.empty()) return;
        host.triangleNormalWorld[i] =
            glm::normalize(directionFromOctahedral(glm::unpackSnorm2x16(ofTriangles[i])));
    });
    return host;
}

std::vector<std::uint32_t> readSurfaces(const GBuffer& gbuffer) {
    return gbuffer.surface.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
}

std::vector<std::uint8_t> readMask(const gl::Texture& mask) {
    return mask.read<std::uint8_t>(GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1);
}

float HostGBuffer::glossiness(std::size_t index) const {
    return static_cast<float>(surface[index] >> 24) / 255.0F;
}

glm::vec3 HostGBuffer::positionWorld(glm::ivec2 pixel) const {
    const float depth = depthM[indexOf(pixel)];
    return glm::vec3(worldFromPixels * glm::vec4((glm::vec2(pixel) + 0.5F) * depth, depth, 1.0F));
}

glm::vec3 HostGBuffer::mirrorDirection(glm::ivec2 pixel) const {
    return glm::normalize(
        glm::reflect(positionWorld(pixel) - view.eyeWorld, normalWorld[indexOf(pixel)]));
}

glm::vec3 HostGBuffer::beam(glm::ivec2 pixel) const {
    const BesideMirror a = besideMirror(*this, pixel, {1, 0});
    const BesideMirror b = besideMirror(*this, pixel, {0, 1});
    const glm::vec3 mirror = mirrorDirection(pixel);
    return {glm::dot(mirror, glm::cross(a.begin, b.begin)),
            glm::dot(mirror, glm::cross(a.begin, b.perMetre) + glm::cross(a.perMetre, b.begin)),
            glm::dot(mirror, glm::cross(a.perMetre, b.perMetre))};
}

float beamArea(const glm::vec3& beam, float distanceM) {
    return std::abs(beam.x + distanceM * (beam.y + distanceM * beam.z));
}

}  // namespace gfxrepro::reflections
