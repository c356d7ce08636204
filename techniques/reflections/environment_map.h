// Radiance around one point: the fallback of rays that meet nothing, and the comparator.
#pragma once

#include <cstdint>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// A cube map of the scene's diffuse colours from the middle of its box (or where told),
/// kBackground where nothing is seen. Made once; render() again for moved objects. Shaders:
/// shaders/environment.glsl, `radianceFrom(direction)`.
class EnvironmentMap {
  public:
    static constexpr int kFaceSizePx = 512;
    /// From the middle of the scene's box.
    EnvironmentMap(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene);
    EnvironmentMap(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene,
                   const glm::vec3& centreWorld);
    /// `objects` are of the constructor's scene.
    void render(const GpuObjects& objects);
    /// How often it was drawn: what was read of it is stale when this has grown.
    std::uint64_t version() const { return version_; }
    /// For passes that include environment.glsl.
    gl::Resources resources() const { return {{"environmentMap", cube_}}; }
    const gl::Texture& cube() const { return cube_; }
    const glm::vec3& centreWorld() const { return centreWorld_; }
    std::size_t sizeBytes() const;

    /// A face's rows as GL stores them, 3 values a texel; waits for the device. For tracers on the
    /// host, with `radianceFrom`.
    struct Host {
        int sizePx = 0;
        std::vector<glm::vec3> faces[6];
        /// Nearest texel: as the device samples it.
        glm::vec3 radianceFrom(const glm::vec3& direction) const;
    };
    Host read() const;

  private:
    std::uint64_t version_ = 0;
    glm::vec3 centreWorld_;
    gl::Texture cube_, depth_;
    gl::Pass pass_;
};

/// Environment mapping: every ray takes the map in its direction, wherever it starts. All rays
/// weigh the same, glossy ones too: the map knows no distances to fade by. Passes:
/// `environment_map` when it is drawn again, `intersection`.
class EnvironmentTracer final : public ReflectionTracer {
  public:
    EnvironmentTracer(const gl::ShaderLibrary& shaders, EnvironmentMap& map,
                      const LobeSettings& lobe, float diagonalM);
    /// Draws the map, again when an object has moved.
    void update(const GpuObjects& objects, gl::Profiler& profiler) override;
    void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
               gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override;

  private:
    EnvironmentMap& map_;
    LobeSettings lobe_;
    float diagonalM_;
    gl::Pass pass_;
    kit::WholeImage wholeImage_;
    std::vector<glm::mat4> poses_;  // in which the map was drawn
};

}  // namespace gfxrepro::reflections
