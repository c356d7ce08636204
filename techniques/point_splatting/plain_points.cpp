#include "techniques/point_splatting/plain_points.h"

#include <array>
#include <limits>
#include <vector>

#include "engine/gpu_scene/gpu_mesh.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

}  // namespace

PlainPoints::PlainPoints(const gl::ShaderLibrary& shaders, const ModelFile& model,
                         glm::ivec2 sizePx)
    : patches_(model.patches()),
      levels_(model.levels()),
      sizePx_(sizePx),
      nearest_(shaders, {"point_splatting/plain_point.vert.glsl"}, gpu_scene::attributeDefines()),
      show_(shaders, {"kit/whole_image.vert.glsl", "point_splatting/plain_point.frag.glsl"},
            {{"NOTHING", kNothing}}),
      positions_(gl::Buffer::of(model.positions())),
      depths_(sizeof(std::uint32_t) * static_cast<std::size_t>(sizePx.x) *
              static_cast<std::size_t>(sizePx.y)),
      output_(gl::Texture::make2D(GL_RGBA8, sizePx)) {
    const std::array<const gl::Texture*, 1> output{&output_};
    target_ = gl::Framebuffer(output);
    array_.setAttribute(gpu_scene::kPosition, positions_, 3);
}

void PlainPoints::render(std::span<const DrawnPatch> drawn, const PatchView& view,
                         gl::Profiler& profiler) {
    GFXREPRO_ASSERT(view.sizePx == sizePx_);
    const gl::GpuScope scope(profiler, "points");
    std::vector<GLint> firsts;
    std::vector<GLsizei> counts;
    for (const DrawnPatch& item : drawn) {
        const Patch& patch = patches_[item.patch];
        firsts.push_back(static_cast<GLint>(patch.firstPoint));
        counts.push_back(static_cast<GLsizei>(levels_[patch.firstLevel + item.level].count));
    }
    depths_.clear(kNothing);
    target_.bind();
    nearest_.set("clipFromModel", view.clipFromWorld());
    nearest_.set("sizePx", sizePx_);
    nearest_.use({{"Depths", depths_}});
    array_.bind();
    glEnable(GL_RASTERIZER_DISCARD);
    glMultiDrawArrays(GL_POINTS, firsts.data(), counts.data(), static_cast<GLsizei>(firsts.size()));
    glDisable(GL_RASTERIZER_DISCARD);
    show_.set("sizePx", sizePx_);
    show_.use({{"Depths", depths_}});
    wholeImage_.draw();
}

}  // namespace gfxrepro::point_splatting
