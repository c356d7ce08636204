// What splats are measured against: one pixel per point.
#pragma once

#include <span>

#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/kit/whole_image.h"
#include "techniques/point_splatting/device_points.h"
#include "techniques/point_splatting/patch_selection.h"
#include "techniques/point_splatting/point_model.h"

namespace gfxrepro::point_splatting {

/// The least that as many points as another method draws cost: the nearest of each pixel, by
/// atomics over a vertex buffer of positions (Schütz, Kerbl and Wimmer 2021 have compute shaders;
/// atomics of 64 bits, which would keep the point beside its depth, are not in GL 4.5).
class PlainPoints final : public PointRenderer {
  public:
    PlainPoints(const gl::ShaderLibrary& shaders, const ModelFile& model, glm::ivec2 sizePx);
    /// Pass: `points`. Of the patches' levels; their modes make no difference.
    void render(std::span<const DrawnPatch> drawn, const PatchView& view,
                gl::Profiler& profiler) override;
    /// RGBA8; white where a point fell.
    const gl::Texture& output() const override { return output_; }
    std::size_t pointBytes() const override { return positions_.sizeBytes(); }
    std::size_t targetBytes() const override { return depths_.sizeBytes() + output_.sizeBytes(); }

    /// Of the last frame, in metres along the view axis, rows from the bottom; a NaN where nothing
    /// is.
    const gl::Buffer& depths() const { return depths_; }

  private:
    std::span<const Patch> patches_;  // the model's, which must live as long
    std::span<const Level> levels_;
    glm::ivec2 sizePx_;
    gl::Pass nearest_, show_;
    gl::Buffer positions_;
    gl::VertexArray array_;
    gl::Buffer depths_;  // bits of floats
    gl::Texture output_;
    gl::Framebuffer target_;
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::point_splatting
