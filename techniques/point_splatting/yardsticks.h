// What splats are measured against: one pixel per point, by compute shaders, the modern yardstick,
// and by a plain draw.
#pragma once

#include <span>

#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/kit/whole_image.h"
#include "techniques/point_splatting/device_points.h"
#include "techniques/point_splatting/patch_selection.h"
#include "techniques/point_splatting/point_model.h"

namespace gfxrepro::point_splatting {

/// Points drawn by compute shaders, one pixel per point (Schütz, Kerbl, Wimmer: "Rendering Point
/// Clouds with Compute Shaders and Vertex Order Optimization", 2021).
/// Departure, Schütz et al. 2021: depth and point are not packed into 64 bits, whose atomics OpenGL
/// 4.5 lacks, so that the points are traversed twice; their "high-quality" variant does so, too.
class ComputeSplatter final : public PointRenderer {
  public:
    ComputeSplatter(const gl::ShaderLibrary& shaders, const ModelFile& model, PointStorage storage,
                    glm::ivec2 sizePx);
    /// Passes: `visibility`, `splats`, `normalization`. The patches' modes make no difference.
    void render(std::span<const DrawnPatch> drawn, const PatchView& view,
                gl::Profiler& profiler) override;
    /// RGBA8, linear; alpha 1 where a point fell.
    const gl::Texture& output() const override { return output_; }
    std::size_t pointBytes() const override { return points_.sizeBytes(); }
    std::size_t targetBytes() const override { return pixels_.sizeBytes() + output_.sizeBytes(); }

  private:
    struct Chunk {  // of point_projection.glsl
        std::uint32_t first, count, padding[2];
        glm::vec4 boxMin, boxSize;
    };
    static_assert(sizeof(Chunk) == 48);
    void upload(std::span<const DrawnPatch> drawn);
    void dispatch(const gl::Pass& pass, const PatchView& view) const;

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

/// As many points as another method draws, as GL draws them at the least: white GL points of one
/// pixel, from a vertex buffer of positions. The yardstick of sprites.
class PlainPoints final : public PointRenderer {
  public:
    PlainPoints(const gl::ShaderLibrary& shaders, const ModelFile& model, glm::ivec2 sizePx);
    /// Pass: `points`. Of the patches' levels; their modes make no difference.
    void render(std::span<const DrawnPatch> drawn, const PatchView& view,
                gl::Profiler& profiler) override;
    /// RGBA8; alpha 1 where a point fell.
    const gl::Texture& output() const override { return output_; }
    std::size_t pointBytes() const override { return positions_.sizeBytes(); }
    std::size_t targetBytes() const override { return depth_.sizeBytes() + output_.sizeBytes(); }

  private:
    std::span<const Patch> patches_;  // the model's, which must live as long
    std::span<const Level> levels_;
    gl::Pass pass_;
    gl::Buffer positions_;
    gl::VertexArray array_;
    gl::Texture depth_, output_;
    gl::Framebuffer target_;
};

}  // namespace gfxrepro::point_splatting
