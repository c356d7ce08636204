// Step 1 of [xie2017] Algorithm 6: what the eye sees, a sample a pixel.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "techniques/kit/view.h"
#include "techniques/reflections/gpu_objects.h"

namespace gfxrepro::reflections {

/// Texels hold square roots of linear colours, 0 to 1, in 10 bits: as shown they are at most a
/// fifth of a level of 255 off. Linear ones would be up to 1.6 levels off near black.
constexpr GLenum kKeptColourFormat = GL_RGB10_A2;

/// As shaders/kept_colour.glsl has it.
inline glm::vec3 keptColour(const glm::vec3& linear) {
    return glm::sqrt(linear);
}
inline glm::vec3 linearColour(const glm::vec3& kept) {
    return kept * kept;
}

/// 24 bytes a sample with the depth buffer, and 4 of triangles' normals for what traces rays.
/// Positions are not kept: a sample lies at kit::worldFromPixels(view) · (x·d, y·d, d, 1), (x, y)
/// the pixel's centre.
struct GBuffer {
    kit::View view;
    gl::Texture diffuse;  // keptColour(): rgb_d of Algorithm 6, as shadeDiffuse() gives it
    gl::Texture normal;   // RG32F, octahedral, unit world normal turned to the eye
    gl::Texture depth;    // R32F, d: distance along the view axis in metres; 0: nothing there
    gl::Texture surface;  // R32UI: reflector id | s in 255ths << 16 | g in 255ths << 24
    /// R32UI, octahedral, two snorm16: unit world normal of the triangle on the side that is seen;
    /// empty where it is not asked for.
    gl::Texture triangleNormal;
    gl::Texture depthBuffer;
    gl::Framebuffer framebuffer;

    explicit GBuffer(const kit::View& view, bool hasTriangleNormals = true);
    /// For passes that include gbuffer.glsl.
    gl::Resources resources() const;
    void setUniforms(const gl::Program& program) const;
    bool hasTriangleNormals() const { return triangleNormal.id() != 0; }
    gl::Resources resourcesFor(const gl::Program& program) const {
        setUniforms(program);
        return resources();
    }
    std::size_t sizeBytes() const;
};

struct HostGBuffer;

/// Of a sample of `surface`; 0: none.
inline int reflectorOf(std::uint32_t surface) {
    return static_cast<int>(surface & 0xFFFFU);
}
inline bool isReflective(std::uint32_t surface) {
    return reflectorOf(surface) != 0;
}

class GBufferRenderer {
  public:
    GBufferRenderer(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene);
    /// `objects` are of the constructor's scene. Clears and draws; no culling, so that a surface is
    /// seen from both sides.
    void render(const GpuObjects& objects, GBuffer& target) const;
    /// What readGBuffer() gives, with triangles' normals: drawn again where `gbuffer`, of the same
    /// objects, has none. Rays need them, methods without rays do not, nor does their memory.
    HostGBuffer readForRays(const GpuObjects& objects, const GBuffer& gbuffer) const;

  private:
    gl::Pass pass_;
};

/// The same on the host, rows from the bottom. The shaders read it by shaders/gbuffer.glsl.
struct HostGBuffer {
    kit::View view;
    glm::mat4 worldFromPixels{1.0F};
    std::vector<glm::vec3> diffuse;
    std::vector<glm::vec3> normalWorld;
    std::vector<glm::vec2> normalOctahedral;     // as stored: for replays that must be exact
    std::vector<glm::vec3> triangleNormalWorld;  // 0 where the device has none
    std::vector<float> depthM;
    std::vector<std::uint32_t> surface;

    std::size_t indexOf(glm::ivec2 pixel) const {
        return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(view.sizePx.x) +
               static_cast<std::size_t>(pixel.x);
    }
    bool isReflective(std::size_t index) const { return reflections::isReflective(surface[index]); }
    int reflector(std::size_t index) const { return reflectorOf(surface[index]); }
    bool holds(glm::ivec2 pixel) const {
        return glm::min(glm::max(pixel, 0), view.sizePx - 1) == pixel;
    }
    /// 0 beyond the image, too.
    int reflectorAt(glm::ivec2 pixel) const { return holds(pixel) ? reflector(indexOf(pixel)) : 0; }
    float glossiness(std::size_t index) const;
    glm::vec3 positionWorld(glm::ivec2 pixel) const;
    /// The mirror direction at a sample: unit.
    glm::vec3 mirrorDirection(glm::ivec2 pixel) const;
    /// What a sample's reflected rays cover t metres on, in m²: |x + y·t + z·t²|, as
    /// shaders/beam.glsl has it.
    glm::vec3 beam(glm::ivec2 pixel) const;
};
float beamArea(const glm::vec3& beam, float distanceM);

/// As shaders/octahedral.glsl has it: not of unit length, but the same as on the device.
glm::vec3 directionFromOctahedral(const glm::vec2& e);

/// Reads back; waits for the device.
HostGBuffer readGBuffer(const GBuffer& gbuffer);
/// Likewise, `surface` alone: a fifth of the bytes, and nothing to unpack.
std::vector<std::uint32_t> readSurfaces(const GBuffer& gbuffer);
/// Likewise a texture of a byte a sample.
std::vector<std::uint8_t> readMask(const gl::Texture& mask);

}  // namespace gfxrepro::reflections
