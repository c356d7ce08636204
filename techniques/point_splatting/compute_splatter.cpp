#include "techniques/point_splatting/compute_splatter.h"

#include <algorithm>
#include <array>

#include "engine/core/error.h"

namespace gfxrepro::point_splatting {

namespace {

constexpr int kGroupSize = 128;
/// Points a work group: eight steps of each invocation.
constexpr std::uint32_t kChunkPoints = 8 * kGroupSize;
/// Groups a dispatch may have anywhere.
constexpr std::uint32_t kMaxGroups = 65535;
/// Sums of 2²² points a pixel fit; an average is exact to a thousandth, finer than its 8 bits.
constexpr float kFixedOne = 512.0F;

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
                                 const ComputeSplatSettings& settings, glm::ivec2 sizePx)
    : settings_(settings),
      sizePx_(sizePx),
      points_(model, settings.storage),
      pixelWords_(points_.hasColors() ? 8 : 5),
      emptyPixels_(emptyPixels(sizePx, pixelWords_)) {
    settings_.lightDirectionView = glm::normalize(settings.lightDirectionView);
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
    pass.setIfActive("depthTolerance", settings_.depthTolerance);
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
    resolve_.set("lightDirectionView", settings_.lightDirectionView);
    resolve_.use({{"Pixels", pixels_}});
    wholeImage_.draw();
}

}  // namespace gfxrepro::point_splatting
