#include "techniques/point_splatting/yardsticks.h"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr int kGroupSize = 128;
/// Points a work group: eight steps of each invocation.
constexpr std::uint32_t kChunkPoints = 8 * kGroupSize;
/// Groups a dispatch may have anywhere.
constexpr std::uint32_t kMaxGroups = 65535;
/// Sums of 2²² points a pixel fit; an average is exact to a thousandth, finer than its 8 bits.
constexpr float kFixedOne = 512.0F;
/// Points within this share of a pixel's least distance are averaged.
constexpr float kDepthTolerance = 0.01F;

gl::Defines computeDefines(const DevicePoints& points, int pixelWords) {
    gl::Defines defines = points.defines();
    defines["GROUP_SIZE"] = kGroupSize;
    defines["PIXEL_WORDS"] = pixelWords;
    defines["FIXED_ONE"] = kFixedOne;
    return defines;
}

/// No point: farther than all, none summed.
gl::Buffer emptyPixels(glm::ivec2 sizePx, int words) {
    const auto count = static_cast<std::size_t>(sizePx.x) * static_cast<std::size_t>(sizePx.y);
    const auto step = static_cast<std::size_t>(words);
    std::vector<std::uint32_t> values(count * step, 0U);
    constexpr std::uint32_t kInfinity = 0x7F800000U;
    for (std::size_t i = 0; i < count; ++i) values[i * step] = kInfinity;
    return gl::Buffer::of(values);
}

}  // namespace

ComputeSplatter::ComputeSplatter(const gl::ShaderLibrary& shaders, const ModelFile& model,
                                 PointStorage storage, glm::ivec2 sizePx)
    : sizePx_(sizePx),
      points_(model, storage),
      pixelWords_(points_.hasColors() ? 8 : 5),
      emptyPixels_(emptyPixels(sizePx, pixelWords_)) {
    const gl::Defines defines = computeDefines(points_, pixelWords_);
    nearest_ = {shaders, {"point_splatting/nearest_point.comp.glsl"}, defines};
    sum_ = {shaders, {"point_splatting/sum_points.comp.glsl"}, defines};
    resolve_ = {shaders,
                {"kit/whole_image.vert.glsl", "point_splatting/resolve_points.frag.glsl"},
                defines};
    pixels_ = gl::Buffer(emptyPixels_.sizeBytes());
    output_ = gl::Texture::make2D(GL_RGBA8, sizePx);
    const std::array<const gl::Texture*, 1> output{&output_};
    outputTarget_ = gl::Framebuffer(output);
}

void ComputeSplatter::upload(std::span<const DrawnPatch> drawn) {
    drawList_.assign(points_, drawn, kChunkPoints, kMaxGroups * kChunkPoints);
    std::vector<Chunk> chunks;
    chunks.reserve(drawList_.ranges.size());
    for (const PointRange& range : drawList_.ranges) {
        const DrawnRecord& record = drawList_.records[range.record];
        chunks.push_back({range.first, range.count, {}, record.boxMinScale, record.boxSize});
    }
    if (!chunks.empty()) chunks_ = gl::Buffer::of(chunks);
}

void ComputeSplatter::dispatch(const gl::Pass& pass, const PatchView& view) const {
    setView(pass, view);
    pass.setIfActive("depthTolerance", kDepthTolerance);
    for (const Batch& batch : drawList_.batches) {
        const gl::Resources resources =
            gl::Resources{{"Pixels", pixels_}, {"Chunks", chunks_}}.with(
                points_.resources(batch.piece));
        for (std::uint32_t first = 0; first < batch.rangeCount; first += kMaxGroups) {
            pass.set("firstChunk", batch.firstRange + first);
            pass.dispatch({std::min(batch.rangeCount - first, kMaxGroups), 1, 1}, resources);
        }
    }
}

void ComputeSplatter::render(std::span<const DrawnPatch> drawn, const PatchView& view,
                             gl::Profiler& profiler) {
    GFXREPRO_ASSERT(view.sizePx == sizePx_);
    upload(drawn);
    {
        const gl::GpuScope scope(profiler, "visibility");
        pixels_.awaitPasses(GL_BUFFER_UPDATE_BARRIER_BIT);
        glCopyNamedBufferSubData(emptyPixels_.id(), pixels_.id(), 0, 0,
                                 static_cast<GLsizeiptr>(pixels_.sizeBytes()));
        dispatch(nearest_, view);
    }
    {
        const gl::GpuScope scope(profiler, "splats");
        dispatch(sum_, view);
    }
    const gl::GpuScope scope(profiler, "normalization");
    outputTarget_.bind();
    setView(resolve_, view);
    resolve_.set("lightDirectionView", glm::normalize(kLightDirectionView));
    resolve_.use({{"Pixels", pixels_}});
    wholeImage_.draw();
}

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
