#include "techniques/point_splatting/plain_points.h"

#include <vector>

#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::point_splatting {

PlainPoints::PlainPoints(const gl::ShaderLibrary& shaders, const ModelFile& model,
                         glm::ivec2 sizePx)
    : patches_(model.patches()),
      levels_(model.levels()),
      pass_(shaders, {"point_splatting/plain_point.vert.glsl", "point_splatting/sprite.frag.glsl"},
            gpu_scene::attributeDefines()),
      positions_(gl::Buffer::of(model.positions())),
      depth_(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx)),
      output_(gl::Texture::make2D(GL_RGBA8, sizePx)) {
    const std::vector<const gl::Texture*> output{&output_};
    target_ = gl::Framebuffer(output, &depth_);
    array_.setAttribute(gpu_scene::kPosition, positions_, 3);
}

void PlainPoints::render(std::span<const DrawnPatch> drawn, const PatchView& view,
                         gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "points");
    target_.clearColour(0, glm::vec4(0.0F));
    target_.clearDepth(1.0F);
    target_.bind();
    glDisable(GL_BLEND);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    pass_.set("clipFromModel", view.clipFromWorld());
    pass_.use({});
    array_.bind();
    std::vector<GLint> firsts;
    std::vector<GLsizei> counts;
    std::uint32_t batch = 0;
    kit::FlushedDraws flushes;
    const auto issue = [&] {
        if (firsts.empty()) return;
        glMultiDrawArrays(GL_POINTS, firsts.data(), counts.data(),
                          static_cast<GLsizei>(firsts.size()));
        flushes.drawn(batch);
        firsts.clear();
        counts.clear();
        batch = 0;
    };
    for (const DrawnPatch& item : drawn) {
        const Patch& patch = patches_[item.patch];
        firsts.push_back(static_cast<GLint>(patch.firstPoint));
        counts.push_back(static_cast<GLsizei>(levels_[patch.firstLevel + item.level].count));
        batch += static_cast<std::uint32_t>(counts.back());
        if (batch >= flushes.mostPrimitives()) issue();
    }
    issue();
    glDisable(GL_PROGRAM_POINT_SIZE);
}

}  // namespace gfxrepro::point_splatting
