#include "techniques/point_splatting/splat_renderer.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::point_splatting {

namespace {

/// Quads that 16-bit indices reach.
constexpr std::uint32_t kMaxRange = 1U << 14;

/// Of the low-pass filter's radius, in the visibility pass, as the least. With all of it, surfaces
/// would grow by the filter over what lies behind and end there at a hard edge, where their faint
/// rims should blend; with none, discs less than a pixel wide would hide nothing.
constexpr float kVisibleShare = 0.5F;

enum VertexLocation : GLuint { kBoxMinLocation = 0, kBoxSizeLocation = 1 };

/// DrawElementsIndirectCommand, or DrawArraysIndirectCommand with a word to spare.
struct Command {
    std::uint32_t words[5];
};

Command commandOf(const PointRange& range, bool isQuads) {
    if (isQuads) return {{6 * range.count, 1, 0, 4 * range.first, range.record}};
    return {{range.count, 1, range.first, range.record, 0}};
}

bool isQuads(SplatMode mode) {
    return mode == SplatMode::FullEwa;
}

float maxPointSizePx() {
    std::array<GLfloat, 2> range{};
    glGetFloatv(GL_POINT_SIZE_RANGE, range.data());
    return range[1];
}

gl::Buffer quadIndices() {
    std::vector<std::uint16_t> indices;
    indices.reserve(std::size_t{6} * kMaxRange);
    for (std::uint32_t quad = 0; quad < kMaxRange; ++quad) {
        for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) {
            indices.push_back(static_cast<std::uint16_t>(4 * quad + corner));
        }
    }
    return gl::Buffer::of(indices);
}

gl::Defines passDefines(const DevicePoints& points) {
    gl::Defines defines = points.defines();
    defines["BOX_MIN_LOCATION"] = static_cast<int>(kBoxMinLocation);
    defines["BOX_SIZE_LOCATION"] = static_cast<int>(kBoxSizeLocation);
    return defines;
}

/// Colours of modes, linear: orange, blue, green.
const char* colorOf(SplatMode mode) {
    switch (mode) {
        case SplatMode::Reconstruction:
            return "vec3(0.08, 0.3, 1.0)";
        case SplatMode::LowPass:
            return "vec3(0.12, 0.75, 0.15)";
        default:
            return "vec3(1.0, 0.35, 0.05)";
    }
}

gl::Pass modePass(const gl::ShaderLibrary& shaders, const gl::Defines& common, SplatMode mode,
                  bool isVisibility, bool showsModes) {
    gl::Defines defines = common;
    if (showsModes) defines["MODE_COLOR"] = std::string(colorOf(mode));
    if (mode == SplatMode::Reconstruction) defines["DISC"] = 1;
    if (mode == SplatMode::LowPass) defines["ROUND"] = 1;
    if (isVisibility) defines["VISIBILITY"] = 1;
    std::vector<std::string> files;
    switch (mode) {
        case SplatMode::Reconstruction:
            files.emplace_back("point_splatting/disc_splat.vert.glsl");
            if (isVisibility) files.emplace_back("point_splatting/disc_visibility.frag.glsl");
            break;
        case SplatMode::LowPass:
            files.emplace_back("point_splatting/round_splat.vert.glsl");
            break;
        default:
            files.emplace_back("point_splatting/ellipse_splat.vert.glsl");
    }
    if (!isVisibility) files.emplace_back("point_splatting/splat.frag.glsl");
    return {shaders, files, defines};
}

/// Grows to hold the values, by doubling.
template <class T>
bool writeGrowing(gl::Buffer& buffer, const std::vector<T>& values) {
    const std::size_t wanted = values.size() * sizeof(T);
    const bool grows = buffer.sizeBytes() < wanted;
    if (grows) buffer = gl::Buffer(std::max(wanted, 2 * buffer.sizeBytes()));
    buffer.write(std::span<const T>(values));
    return grows;
}

void bindRecords(const gl::VertexArray& array, const gl::Buffer& records) {
    glVertexArrayVertexBuffer(array.id(), 0, records.id(), 0, sizeof(DrawnRecord));
}

gl::VertexArray drawnArray(const gl::Buffer& indices) {
    gl::VertexArray array;
    const GLuint id = array.id();
    array.setIndices(indices);
    glVertexArrayAttribFormat(id, kBoxMinLocation, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribFormat(id, kBoxSizeLocation, 3, GL_FLOAT, GL_FALSE,
                              offsetof(DrawnRecord, boxSize));
    for (const GLuint location : {kBoxMinLocation, kBoxSizeLocation}) {
        glVertexArrayAttribBinding(id, location, 0);
        glEnableVertexArrayAttrib(id, location);
    }
    // One record an instance: a draw's base instance is its patch's record.
    glVertexArrayBindingDivisor(id, 0, 1);
    return array;
}

}  // namespace

SplatRenderer::SplatRenderer(const gl::ShaderLibrary& shaders, const ModelFile& model,
                             const SplatSettings& settings, glm::ivec2 sizePx)
    : settings_(settings),
      sizePx_(sizePx),
      points_(model, settings.storage),
      hasColors_(settings.showsModes || points_.hasColors()),
      quadIndices_(quadIndices()),
      drawnArray_(drawnArray(quadIndices_)) {
    settings_.lightDirectionView = glm::normalize(settings.lightDirectionView);
    maxPointPx_ = maxPointSizePx();
    gl::Defines defines = passDefines(points_);
    if (hasColors_) defines["COLORS"] = 1;
    for (const SplatMode mode :
         {SplatMode::FullEwa, SplatMode::Reconstruction, SplatMode::LowPass}) {
        ModePasses& passes = modes_[static_cast<std::size_t>(mode)];
        passes.visibility = modePass(shaders, defines, mode, true, settings.showsModes);
        passes.splats = modePass(shaders, defines, mode, false, settings.showsModes);
    }
    sprites_ = {
        shaders, {"point_splatting/sprite.vert.glsl", "point_splatting/sprite.frag.glsl"}, defines};
    normalization_ = {
        shaders, {"kit/whole_image.vert.glsl", "point_splatting/normalization.frag.glsl"}, defines};

    depth_ = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx);
    normalSums_ = gl::Texture::make2D(GL_RGBA16F, sizePx);
    output_ = gl::Texture::make2D(GL_RGBA8, sizePx);
    std::vector<const gl::Texture*> sums{&normalSums_};
    if (hasColors_) {
        colorSums_ = gl::Texture::make2D(GL_RGBA16F, sizePx);
        sums.push_back(&colorSums_);
    }
    const std::array<const gl::Texture*, 1> output{&output_};
    visibilityTarget_ = gl::Framebuffer({}, &depth_);
    sumTarget_ = gl::Framebuffer(sums, &depth_);
    outputTarget_ = gl::Framebuffer(output);
    spriteTarget_ = gl::Framebuffer(output, &depth_);
}

std::size_t SplatRenderer::targetBytes() const {
    std::size_t size = depth_.sizeBytes() + normalSums_.sizeBytes() + output_.sizeBytes();
    if (hasColors_) size += colorSums_.sizeBytes();
    return size;
}

bool SplatRenderer::fitsGlPoints(const DrawnPatch& drawn, const PatchView& view) const {
    const Patch& patch = points_.patches()[drawn.patch];
    const float radius = points_.levels()[patch.firstLevel + drawn.level].maxRadius;
    const float reach = settings_.cutoff * radius;
    const float nearest = nearestDepth(patch.bounds, view) - reach;
    if (nearest <= 0.0F) return false;
    // A disc along the ray to a corner of the window's border (slopeLimit) is the widest.
    const float slope = 1.3F * std::tan(0.5F * view.fovRad);
    const float aspect = static_cast<float>(sizePx_.x) / static_cast<float>(sizePx_.y);
    const float widest = std::sqrt(1.0F + slope * slope * (1.0F + aspect * aspect));
    return 2.0F * view.focalPx * reach * widest / nearest < maxPointPx_;
}

void SplatRenderer::upload(std::span<const DrawnPatch> drawn, const PatchView& view) {
    items_.assign(drawn.begin(), drawn.end());
    for (DrawnPatch& item : items_) {
        // Of so many pixels full EWA is the reconstruction filter.
        if (item.mode == SplatMode::Reconstruction && !fitsGlPoints(item, view)) {
            item.mode = SplatMode::FullEwa;
        }
    }
    drawList_.assign(points_, items_, kMaxRange, kit::FlushedDraws().mostPrimitives());
    if (drawList_.ranges.empty()) return;
    std::vector<Command> commands;
    commands.reserve(drawList_.ranges.size());
    for (const Batch& batch : drawList_.batches) {
        for (std::uint32_t i = 0; i < batch.rangeCount; ++i) {
            commands.push_back(
                commandOf(drawList_.ranges[batch.firstRange + i], isQuads(batch.mode)));
        }
    }
    writeGrowing(commands_, commands);
    if (writeGrowing(records_, drawList_.records)) bindRecords(drawnArray_, records_);
}

void SplatRenderer::render(std::span<const DrawnPatch> drawn, const PatchView& view,
                           gl::Profiler& profiler) {
    GFXREPRO_ASSERT(view.sizePx == sizePx_);
    const auto isSprite = [](const DrawnPatch& d) { return d.mode == SplatMode::Sprite; };
    const bool isSprites = !drawn.empty() && isSprite(drawn.front());
    GFXREPRO_ASSERT(std::all_of(drawn.begin(), drawn.end(),
                                [&](const DrawnPatch& d) { return isSprite(d) == isSprites; }));
    upload(drawn, view);
    glDisable(GL_CULL_FACE);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    if (isSprites) {
        const gl::GpuScope scope(profiler, "sprites");
        drawSprites(view);
    } else {
        {
            const gl::GpuScope scope(profiler, "visibility");
            drawBatches(true, view);
        }
        {
            const gl::GpuScope scope(profiler, "splats");
            drawBatches(false, view);
        }
        const gl::GpuScope scope(profiler, "normalization");
        normalize(view);
    }
    glDisable(GL_PROGRAM_POINT_SIZE);
}

void SplatRenderer::drawBatches(bool isVisibility, const PatchView& view) {
    glDisable(GL_BLEND);
    if (isVisibility) {
        visibilityTarget_.clearDepth(1.0F);
        visibilityTarget_.bind();
    } else {
        sumTarget_.clearColour(0, glm::vec4(0.0F));
        if (hasColors_) sumTarget_.clearColour(1, glm::vec4(0.0F));
        sumTarget_.bind();
        glDepthMask(GL_FALSE);
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE);
    }
    const gl::Pass* setUpPass = nullptr;
    kit::FlushedDraws flushes;
    for (const Batch& batch : drawList_.batches) {
        const ModePasses& passes = modes_[static_cast<std::size_t>(batch.mode)];
        const gl::Pass& pass = isVisibility ? passes.visibility : passes.splats;
        if (setUpPass != &pass) {
            setUp(pass, view);
            if (isVisibility) {
                pass.setIfActive("lowPassRadiusPx", kVisibleShare * settings_.lowPassRadiusPx);
            }
            setUpPass = &pass;
        }
        issue(pass, batch);
        flushes.drawn(batch.pointCount);
    }
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
}

void SplatRenderer::drawSprites(const PatchView& view) {
    glDisable(GL_BLEND);
    spriteTarget_.clearColour(0, glm::vec4(0.0F));
    spriteTarget_.clearDepth(1.0F);
    spriteTarget_.bind();
    setUp(sprites_, view);
    kit::FlushedDraws flushes;
    for (const Batch& batch : drawList_.batches) {
        issue(sprites_, batch);
        flushes.drawn(batch.pointCount);
    }
}

void SplatRenderer::normalize(const PatchView& view) {
    outputTarget_.bind();
    setUp(normalization_, view);
    normalization_.use({{"normalSums", normalSums_}, {"colorSums", colorSums_}});
    wholeImage_.draw();
}

void SplatRenderer::issue(const gl::Pass& pass, const Batch& batch) const {
    pass.use(points_.resources(batch.piece));
    drawnArray_.bind();
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
    const auto* offset = reinterpret_cast<const void*>(batch.firstRange * sizeof(Command));
    const auto count = static_cast<GLsizei>(batch.rangeCount);
    if (isQuads(batch.mode)) {
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, offset, count,
                                    sizeof(Command));
    } else {
        glMultiDrawArraysIndirect(GL_POINTS, offset, count, sizeof(Command));
    }
}

void SplatRenderer::setUp(const gl::Pass& pass, const PatchView& view) const {
    setView(pass, view);
    pass.setIfActive("lowPassRadiusPx", settings_.lowPassRadiusPx);
    pass.setIfActive("splatRadiusPx", settings_.lowPassRadiusPx);
    pass.setIfActive("cutoff", settings_.cutoff);
    pass.setIfActive("visibilityOffset", settings_.visibilityOffset);
    pass.setIfActive("lightDirectionView", settings_.lightDirectionView);
}

}  // namespace gfxrepro::point_splatting
