#include "techniques/terrain_tessellation/terrain_tessellation.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "engine/core/files.h"
#include "engine/gl/gl.h"
#include "techniques/kit/requirements.h"
#include "techniques/terrain_tessellation/ground_picture.h"
#include "techniques/terrain_tessellation/outputs.h"

namespace gfxrepro::terrain_tessellation {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The horizontal angle of view has the same pixels per tangent.
TileView tileViewOf(const kit::View& view) {
    return {view.eyeWorld, view.clipFromWorld(),
            0.5F * static_cast<float>(view.sizePx.x) * view.clipFromView[0].x};
}

constexpr bool kIsSrgb = true;
/// Of a picture of the ground that is made here: at the papers' map, 80 m a texel.
constexpr int kGroundPicturePx = 2048;

/// The picture of the ground: the colours of the scene's first material, or one made of heights.
gl::Texture colourMapOf(const scene::Scene& scene, Shading shading) {
    if (shading == Shading::GeneratedMap) {
        return gl::Texture::fromImage(groundPicture(*scene.heights, kGroundPicturePx), kIsSrgb);
    }
    const auto index = static_cast<std::size_t>(scene.materials.front().baseColorTexture);
    return gl::Texture::fromImage(scene.textures[index], kIsSrgb);
}

/// Patches as they come take one segment an edge.
RenderSettings untessellated(RenderSettings settings) {
    settings.factors.smallest = settings.factors.greatest = 1.0F;
    settings.spacing = Spacing::Equal;
    settings.hasSkirts = false;
    return settings;
}

}  // namespace

TerrainTessellation::Target::Target(glm::ivec2 sizePx)
    : colour(gl::Texture::make2D(GL_RGBA16F, sizePx)),
      depth(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx)) {
    const gl::Texture* colours[] = {&colour};
    framebuffer = gl::Framebuffer(colours, &depth);
}

void TerrainTessellation::Target::clear() const {
    // A contrasting sky: no ground has this blue, so that a crack is seen.
    framebuffer.clearColour(0, {0.45F, 0.65F, 0.95F, 0.0F});
    framebuffer.clearDepth(1.0F);
}

TerrainTessellation::TerrainTessellation(Params& params) : params_(params) {}

void TerrainTessellation::requireScene(const scene::Scene& scene) const {
    if (!scene.heights || scene.heights->isEmpty()) {
        throw Error("technique 'terrain_tessellation' needs a scene with a height map");
    }
    const bool hasColours =
        !scene.materials.empty() && scene.materials.front().baseColorTexture >= 0;
    if (params_.render.shading == Shading::ColourMap && !hasColours) {
        throw Error(
            "'shading: colour_map' needs a scene with a colour map; sources of height maps take "
            "one as 'colour_map'");
    }
    TerrainView(scene, params_.view);
}

void TerrainTessellation::setup(technique::SetupContext& context) {
    scene_ = context.scene;
    shaders_ = &context.shaders;
    isSoftware_ = context.device.info().isSoftware;
    sizePx_ = context.outputSizePx;
    const scene::HeightMap& map = *scene_->heights;
    const Clock::time_point begin = Clock::now();
    metadata_ = params_.keepsMetadata
                    ? TerrainMetadata::openOrBuild(cacheFolder() / "terrain", map, params_.metadata)
                    : TerrainMetadata::build(map, params_.metadata);
    preprocessMs_ = 1000.0 * secondsSince(begin);
    tree_.emplace(*metadata_, params_.render.factors.tile);
    terrain_.emplace(map, *metadata_, params_.heights);
    camera_.emplace(*scene_, params_.view);
    RenderSettings settings = params_.render;
    if (isSoftware_) settings.batches.emplace();
    if (params_.method == Method::Patches) settings = untessellated(settings);
    if (hasColourMap(settings.shading)) {
        colourMap_ = colourMapOf(*scene_, settings.shading);
        colourMap_.setWrap(GL_CLAMP_TO_EDGE);
        settings.colourMap = &colourMap_;
    }
    renderer_.emplace(context.shaders, *terrain_, settings);
    if (params_.drawsYardstick) {
        yardstick_.emplace(context.shaders, *terrain_, untessellated(settings));
    }
    target_.emplace(sizePx_);
}

TileSelection TerrainTessellation::selectAll() const {
    return tree_->select(tileView_, 0.0F, params_.culling != Culling::None);
}

TileSelection TerrainTessellation::selectTiles() const {
    const bool isCulling = params_.culling != Culling::None;
    switch (params_.method) {
        case Method::UniformGrid:
            return selectAll();
        case Method::Cdlod:
            return tree_->selectByDistance(tileView_, morphRanges().rangesM.front(), isCulling);
        case Method::Adaptive:
        case Method::Patches:
            break;
    }
    return tree_->select(tileView_, params_.maxTileErrorPx, isCulling);
}

/// Cells of the finest level end where they are ΔS pixels wide, but not nearer than a tile and a
/// half: a tile may not touch one two levels coarser.
MorphRanges TerrainTessellation::morphRanges() const {
    const float tileM =
        metadata_->spacingM() * static_cast<float>(params_.metadata.blockSegments *
                                                   params_.render.factors.tile.blocksPerTile());
    const float wantedM =
        params_.finestRangeM > 0.0F
            ? params_.finestRangeM
            : metadata_->spacingM() * tileView_.pixelsPerTangent / params_.render.factors.segmentPx;
    MorphRanges ranges;
    float rangeM = std::max(wantedM, 2.0F * std::sqrt(2.0F) * tileM);
    for (int level = 0; level < tree_->levelCount(); ++level, rangeM *= 2.0F) {
        ranges.rangesM.push_back(rangeM);
    }
    return ranges;
}

void TerrainTessellation::draw(Method method, const TileSelection& selection, const kit::View& view,
                               const Target& target) {
    target.clear();
    switch (method) {
        case Method::UniformGrid:
            renderer_->drawGrid(selection.tiles, view, target.framebuffer);
            break;
        case Method::Cdlod:
            renderer_->drawMorphed(selection.tiles, morphRanges(), view, target.framebuffer);
            break;
        case Method::Adaptive:
        case Method::Patches:
            renderer_->drawTessellated(selection.tiles, view, target.framebuffer);
            break;
    }
}

void TerrainTessellation::render(technique::FrameContext& context) {
    const glm::vec2 size(sizePx_);
    view_ =
        kit::viewOf(camera_->camera(context.frame, context.frameCount, size.x / size.y), sizePx_);
    tileView_ = tileViewOf(view_);
    {
        const gl::CpuScope scope(context.profiler, "tile_walk");
        selection_ = selectTiles();
    }
    const std::uint64_t loadedBefore = terrain_->pages().loadedCount();
    {
        // More tiles than there are pages are loaded in turns as they are drawn.
        const gl::CpuScope scope(context.profiler, "load_tiles");
        const auto pages = static_cast<std::size_t>(terrain_->pages().capacity());
        if (selection_.tiles.size() <= pages) terrain_->pages().load(selection_.tiles);
    }
    drawTime_.emplace(isSoftware_);
    {
        const gl::GpuScope own(*drawTime_, "draw");
        const gl::GpuScope scope(context.profiler, "draw");
        draw(params_.method, selection_, view_, *target_);
    }
    loadedTiles_ = terrain_->pages().loadedCount() - loadedBefore;
}

namespace {
std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<TerrainTessellation>(params);
}
}  // namespace

const technique::TechniqueInfo kTerrainTessellation{
    "terrain_tessellation", "height maps tessellated to the screen's resolution (zhang2012)",
    create, outputs};

}  // namespace gfxrepro::terrain_tessellation
