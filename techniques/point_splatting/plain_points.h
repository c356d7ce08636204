// What sprites are measured against: one pixel per point, by a plain draw.
#pragma once

#include <span>

#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/point_splatting/device_points.h"
#include "techniques/point_splatting/patch_selection.h"
#include "techniques/point_splatting/point_model.h"

namespace gfxrepro::point_splatting {

/// As many points as another method draws, as GL draws them at the least: white GL points of one
/// pixel, from a vertex buffer of positions.
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
