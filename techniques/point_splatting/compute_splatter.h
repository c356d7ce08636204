// Points drawn by compute shaders, one pixel per point: the modern yardstick (Schütz, Kerbl,
// Wimmer: "Rendering Point Clouds with Compute Shaders and Vertex Order Optimization", 2021).
#pragma once

#include <span>
#include <vector>

#include "engine/gl/profiler.h"
#include "techniques/kit/whole_image.h"
#include "techniques/point_splatting/device_points.h"

namespace gfxrepro::point_splatting {

struct ComputeSplatSettings {
    PointStorage storage = PointStorage::Compressed;
    /// Points within this share of a pixel's least distance are averaged.
    float depthTolerance = 0.01F;
    glm::vec3 lightDirectionView{0.3F, 0.5F, 0.8F};
};

/// Departure, Schütz et al. 2021: depth and point are not packed into 64 bits, whose atomics OpenGL
/// 4.5 lacks, so that the points are traversed twice; their "high-quality" variant does so, too.
class ComputeSplatter {
  public:
    ComputeSplatter(const gl::ShaderLibrary& shaders, const ModelFile& model,
                    const ComputeSplatSettings& settings, glm::ivec2 sizePx);
    /// Passes: `visibility`, `splats`, `normalization`. The patches' modes make no difference.
    void render(std::span<const DrawnPatch> drawn, const PatchView& view, gl::Profiler& profiler);
    /// RGBA8, linear; alpha 1 where a point fell.
    const gl::Texture& output() const { return output_; }
    std::size_t pointBytes() const { return points_.sizeBytes(); }
    std::size_t targetBytes() const { return pixels_.sizeBytes() + output_.sizeBytes(); }

  private:
    struct Chunk {  // of point_projection.glsl
        std::uint32_t first, count, padding[2];
        glm::vec4 boxMin, boxSize;
    };
    static_assert(sizeof(Chunk) == 48);
    void upload(std::span<const DrawnPatch> drawn);
    void dispatch(const gl::Pass& pass, const PatchView& view) const;

    ComputeSplatSettings settings_;
    glm::ivec2 sizePx_;
    DevicePoints points_;
    int pixelWords_;  // distance, count, normal, and colour where there is one
    gl::Pass nearest_, sum_, resolve_;
    gl::Buffer chunks_, pixels_, emptyPixels_;
    gl::Texture output_;
    gl::Framebuffer outputTarget_;
    kit::WholeImage wholeImage_;
    DrawList drawList_;
};

}  // namespace gfxrepro::point_splatting
