#include "techniques/terrain_tessellation/terrain_tessellation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/core/files.h"
#include "engine/gl/gl.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Adaptive, "adaptive", "patches tessellated to the screen"},
    {Method::Patches, "patches", "the patches as they reach the GPU, two triangles each"},
    {Method::UniformGrid, "uniform_grid", "every sample of the height map: the truth"},
    {Method::Cdlod, "cdlod", "levels by distance that morph into each other, no tessellation"},
};
constexpr Choice<Culling> kCullings[] = {
    {Culling::None, "none", "everything is drawn"},
    {Culling::Tile, "tile", "tiles outside the frustum are dropped on the CPU"},
    {Culling::TileAndPatch, "tile_and_patch", "patches, too, in the control stage"},
};
constexpr Choice<Shading> kShadings[] = {
    {Shading::SlopeAltitude, "slope_altitude", "grass, rock and snow"},
    {Shading::ColourMap, "colour_map", "the scene's picture of the ground"},
    {Shading::GeneratedMap, "generated_map", "a picture of the ground, made from the heights"},
    {Shading::Patches, "patches", "a chequer of the patches, those of coarser tiles darker"},
};
constexpr Choice<Segment> kSegments[] = {
    {Segment::Vertical, "vertical", "along the world's up, as printed"},
    {Segment::ViewFacing, "view_facing", "parallel to the picture"},
    {Segment::Sphere, "sphere", "the apparent diameter of a sphere"},
};
constexpr Choice<InnerFactors> kInnerFactors[] = {
    {InnerFactors::Mean, "mean", "of the opposite edges', as printed"},
    {InnerFactors::Minimum, "minimum", "after Yusov and Shevtsov"},
    {InnerFactors::Maximum, "maximum", ""},
};
constexpr Choice<EdgeRule> kEdgeRules[] = {
    {EdgeRule::Shared, "shared", "from the edge alone, equal on both of its sides"},
    {EdgeRule::OwnPatch, "own_patch", "the patch's mean, unequal on both sides: cracks"},
};
constexpr Choice<Spacing> kSpacings[] = {
    {Spacing::FractionalEven, "fractional_even", "as printed"},
    {Spacing::FractionalOdd, "fractional_odd", ""},
    {Spacing::Equal, "integer", "factors rounded up"},
};

FactorSettings readFactors(Params& params) {
    FactorSettings factors;
    factors.segmentPx = static_cast<float>(
        params.getDouble("delta_s", 5.0, {"ΔS of eq. (4)", "pixels", 0.1, 1000.0}));
    factors.segment = params.getEnum("segment", Segment::Vertical, kSegments,
                                     {"which way the segment AB of eq. (4) points"});
    factors.inner = params.getEnum("inner", InnerFactors::Mean, kInnerFactors,
                                   {"a patch's inner factors from its edges'"});
    factors.edges = params.getEnum("edges", EdgeRule::Shared, kEdgeRules,
                                   {"where an edge's factor comes from"});
    factors.tile.patchesPerTile =
        params.getInt("tile_patches", 8, {"M: patches along a tile's side", "patches", 1, 64});
    factors.tile.blocksPerPatch =
        params.getInt("patch_blocks", 2, {"N: blocks along a patch's side", "blocks", 1, 32});
    return factors;
}

bool isPowerOfTwo(int value) {
    return (value & (value - 1)) == 0;
}

void requireShape(int blockSegments, const TileSettings& tile, const Params& params) {
    const auto require = [&](const char* name, int value) {
        if (isPowerOfTwo(value)) return;
        throw Error(params.locationOf(name), fmt::format("{} {} is no power of two", name, value));
    };
    require("block", blockSegments);
    require("tile_patches", tile.patchesPerTile);
    require("patch_blocks", tile.blocksPerPatch);
    if (tile.blocksPerPatch * blockSegments > 64) {
        throw Error(
            params.locationOf("patch_blocks"),
            fmt::format("a patch of {} blocks of {} segments is {} wide; allowed: 64, the "
                        "largest factor",
                        tile.blocksPerPatch, blockSegments, tile.blocksPerPatch * blockSegments));
    }
}

}  // namespace

TerrainTessellationParams::TerrainTessellationParams(Params& params)
    : method(params.getEnum("method", Method::Adaptive, kMethods, {"how terrain is drawn"})),
      culling(params.getEnum("culling", Culling::TileAndPatch, kCullings,
                             {"what is dropped outside the frustum"})) {
    render.factors = readFactors(params);
    const TileSettings& tile = render.factors.tile;
    metadata.blockSegments =
        params.getInt("block", 32, {"segments along a block's side", "segments", 2, 64});
    metadata.tileBlocks = tile.blocksPerTile();
    render.spacing = params.getEnum("partitioning", Spacing::FractionalEven, kSpacings,
                                    {"where the vertices of an edge lie"});
    render.hasSkirts = params.getBool("skirts", true, {"walls below the rims of tiles"});
    render.shading = params.getEnum("shading", Shading::SlopeAltitude, kShadings,
                                    {"what the colours of the ground are from"});
    render.isWireframe = params.getBool("wireframe", false, {"draws the triangles' edges"});
    render.cullsPatches = culling == Culling::TileAndPatch;
    maxTileErrorPx = static_cast<float>(params.getDouble(
        "tau", 1.0, {"τ: a tile with a smaller ρ is not divided", "pixels", 0.0, 1e6}));
    heightBudgetBytes = static_cast<std::size_t>(
        params.getDouble("height_memory_mib", 256.0,
                         {"for the heights of tiles on the device; tiles are loaded when they come "
                          "into view, in the place of those longest out of it",
                          "MiB", 0.001, 65536.0}) *
        (1 << 20));
    view = params.getText(
        "view", "valley",
        {"a camera or path of the scene; overview, valley, steep or round_flight; \"X Y Z > X Y "
         "Z\" from and to, more such behind ';' a path; or \"AZIMUTH ELEVATION\" in degrees"});
    keepsMetadata = params.getBool("cache", true, {"keeps the preprocess's result on disk"});
    measuresErrors = params.getBool("errors", false, {"compares with the full resolution"});
    checksSeams = params.getBool("seams", false,
                                 {"captures the triangles and looks for edges that fit no other"});
    drawsYardstick = params.getBool(
        "yardstick", false,
        {"draws the frame's patches untessellated, too: what the window alone costs"});
    showsPictures = params.getBool("pictures", false, {"the picture, and what is wrong in it"});
    supersampling =
        params.getInt("supersampling", 1,
                      {"samples per pixel along each axis of errors and pictures", "1", 1, 8});
    params.finish();

    requireShape(metadata.blockSegments, tile, params);
    const bool tessellates = method == Method::Adaptive;
    if (!tessellates) {
        params.refuseGiven(
            {"segment", "inner", "edges", "partitioning", "skirts", "seams", "yardstick"},
            "'method: adaptive'");
        if (culling == Culling::TileAndPatch && params.isGiven("culling")) {
            throw Error(params.locationOf("culling"),
                        "'culling: tile_and_patch' needs 'method: adaptive'");
        }
        render.cullsPatches = false;
    }
    const bool hasPatches = tessellates || method == Method::Patches;
    if (render.shading == Shading::Patches && (!hasPatches || measuresErrors)) {
        throw Error(params.locationOf("shading"),
                    "'shading: patches' needs 'method: adaptive' or 'patches', without 'errors: "
                    "true': the truth has none");
    }
    if (method == Method::UniformGrid) params.refuseGiven({"tau", "delta_s"}, "another method");
    if (method == Method::Patches) params.refuseGiven({"delta_s"}, "another method");
    if (method == Method::Cdlod) params.refuseGiven({"tau"}, "another method");
    if (!measuresErrors && !showsPictures) {
        params.refuseGiven({"supersampling"}, "'errors: true' or 'pictures: true'");
    }
}

namespace {

/// In [0, 1).
float hashed(int x, int y, int octave) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^
                      static_cast<std::uint32_t>(y) * 0x85EBCA77U ^
                      static_cast<std::uint32_t>(octave) * 0xC2B2AE3DU;
    h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12)) * 0x297A2D39U;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24F;
}

/// Value noise, smooth, in [0, 1).
float noise(glm::vec2 at, int octave) {
    const glm::ivec2 cell(glm::floor(at));
    glm::vec2 t = at - glm::vec2(cell);
    t = t * t * (3.0F - 2.0F * t);
    const auto corner = [&](int x, int y) { return hashed(cell.x + x, cell.y + y, octave); };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), t.x),
                    glm::mix(corner(0, 1), corner(1, 1), t.x), t.y);
}

float summed(glm::vec2 at, int octaves) {
    float sum = 0.0F, weight = 0.5F;
    for (int octave = 0; octave < octaves; ++octave, at *= 2.0F, weight *= 0.5F) {
        sum += weight * noise(at, octave);
    }
    return sum;
}

/// `altitude`: 0 at the lowest ground, 1 at the highest; `slope`: metres a metre.
glm::vec3 groundColour(glm::vec2 place, float altitude, float slope) {
    const float speckle = hashed(static_cast<int>(place.x), static_cast<int>(place.y), 99);
    const float grain = 0.7F * summed(0.25F * place, 3) + 0.3F * speckle;
    const float patches = summed(0.02F * place, 3);
    if (altitude < 1e-3F && slope < 1e-3F) return {0.16F, 0.25F, 0.33F + 0.03F * grain};
    // Fields with straight borders in the lowland, turned against the grid.
    const glm::vec2 turned(0.8F * place.x + 0.6F * place.y, 0.8F * place.y - 0.6F * place.x);
    const glm::ivec2 field(glm::floor(turned / glm::vec2(17.0F, 11.0F)));
    const float crop = hashed(field.x, field.y, 77);
    const glm::vec3 fields =
        glm::mix(glm::vec3(0.36F, 0.42F, 0.18F), glm::vec3(0.62F, 0.55F, 0.30F), crop);
    const glm::vec3 wood = glm::vec3(0.2F, 0.33F, 0.15F) * (0.4F + 1.2F * grain);
    const float open = glm::smoothstep(0.42F, 0.47F, patches) *
                       (1.0F - glm::smoothstep(0.05F, 0.15F, altitude)) *
                       (1.0F - glm::smoothstep(0.05F, 0.15F, slope));
    glm::vec3 colour = glm::mix(wood, fields, open);
    const glm::vec3 heath = glm::vec3(0.42F, 0.38F, 0.24F) * (0.75F + 0.5F * grain);
    const float above = altitude + 0.15F * (patches - 0.45F);
    colour = glm::mix(colour, heath, glm::smoothstep(0.36F, 0.44F, above));
    const glm::vec3 rock = glm::vec3(0.42F, 0.39F, 0.36F) * (0.6F + 0.8F * grain);
    colour = glm::mix(colour, rock, glm::smoothstep(0.5F, 0.9F, slope + 0.4F * (grain - 0.45F)));
    const float snow =
        glm::smoothstep(0.52F, 0.6F, above) * (1.0F - glm::smoothstep(0.9F, 1.5F, slope));
    return glm::mix(colour, glm::vec3(0.92F, 0.94F, 0.97F), snow);
}

/// A picture of the ground, made from its heights: no aerial picture of the paper's map is at hand.
/// sRGB, north on top, `sidePx` along the map's longer side: water, fields and woods in patches,
/// bare rock on slopes, snow on summits, each mottled. Seeded by nothing: a map has one picture.
image::Image8 groundPicture(const scene::HeightMap& map, int sidePx) {
    const glm::ivec2 cells = glm::max(map.sizeSamples - 1, 1);
    const glm::vec2 samplesPerPx = samplesPerPixel(map, sidePx);
    const glm::ivec2 size =
        glm::max(glm::ivec2(glm::ceil(glm::vec2(cells) / samplesPerPx)), glm::ivec2(1));
    image::Image8 picture(size.x, size.y, 3);
    const scene::HeightMap::Extremes ends = map.extremes();
    const glm::ivec2 step = glm::max(glm::ivec2(samplesPerPx), 1);
    const glm::vec2 stepM = glm::vec2(step) * map.spacingM;
    const auto paintRow = [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::ivec2 at((glm::vec2(x, y) + 0.5F) * samplesPerPx);
            const float east =
                map.clampedHeightM(at.x + step.x, at.y) - map.clampedHeightM(at.x - step.x, at.y);
            const float south =
                map.clampedHeightM(at.x, at.y + step.y) - map.clampedHeightM(at.x, at.y - step.y);
            const float slope = std::hypot(east, south * (stepM.x / stepM.y)) / (2.0F * stepM.x);
            const float altitude = (map.clampedHeightM(at.x, at.y) - ends.lowestM) / ends.reliefM();
            const glm::vec3 colour = groundColour(glm::vec2(x, y), altitude, slope);
            for (int c = 0; c < 3; ++c) {
                picture.at(x, y, c) = static_cast<std::uint8_t>(
                    std::lround(255.0F * std::clamp(colour[c], 0.0F, 1.0F)));
            }
        }
    };
    // What the rows looked at leaves the memory with every few.
    constexpr int kRowsAtOnce = 16;
    for (int first = 0; first < size.y; first += kRowsAtOnce) {
        tbb::parallel_for(first, std::min(size.y, first + kRowsAtOnce), paintRow);
        map.release();
    }
    return picture;
}

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
    shared_ = context.shared;
    device_ = &context.device.info();
    sizePx_ = context.outputSizePx;
    const scene::HeightMap& map = *scene_->heights;
    const Clock::time_point begin = Clock::now();
    metadata_ = params_.keepsMetadata
                    ? TerrainMetadata::openOrBuild(cacheFolder() / "terrain", map, params_.metadata)
                    : TerrainMetadata::build(map, params_.metadata);
    preprocessMs_ = 1000.0 * secondsSince(begin);
    tree_.emplace(*metadata_, params_.render.factors.tile);
    terrain_.emplace(map, *metadata_, params_.heightBudgetBytes);
    camera_.emplace(*scene_, params_.view);
    RenderSettings settings = params_.render;
    if (device_->isSoftware) settings.batches.emplace();
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
    const float greaterM = std::max(metadata_->spacingM().x, metadata_->spacingM().y);
    const float tileM = greaterM * static_cast<float>(params_.metadata.blockSegments *
                                                      params_.render.factors.tile.blocksPerTile());
    const float wantedM = greaterM * tileView_.pixelsPerTangent / params_.render.factors.segmentPx;
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
        case Method::Cdlod: {
            const MorphRanges ranges = morphRanges();
            renderer_->drawGrid(selection.tiles, view, target.framebuffer, &ranges);
            break;
        }
        case Method::Adaptive:
        case Method::Patches:
            renderer_->drawTessellated(selection.tiles, view, target.framebuffer);
            break;
    }
}

void TerrainTessellation::render(technique::FrameContext& context) {
    const glm::vec2 size(sizePx_);
    frameCount_ = context.frameCount;
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
    drawTime_.emplace(*device_);
    {
        const gl::GpuScope own(*drawTime_, "draw");
        const gl::GpuScope scope(context.profiler, "draw");
        draw(params_.method, selection_, view_, *target_);
    }
    loadedTiles_ = terrain_->pages().loadedCount() - loadedBefore;
}

namespace {

config::Outputs outputs() {
    using config::Better;
    const auto detail = [](const char* name, const char* unit, const char* doc,
                           Better better = Better::Neither) {
        return config::MetricInfo{name, unit, doc, better, true};
    };
    return {
        {
            {"drawn_triangles", "triangle", "triangles drawn, with skirts and before clipping"},
            {"triangles_per_second", "triangle/s", "triangles drawn per second of the draw alone",
             Better::Higher},
            {"tiles", "tile", "tiles drawn"},
            {"patches", "patch", "patches of the drawn tiles, but for those beyond the map"},
            {"draw_calls", "call", "draw calls of a frame", Better::Lower},
            detail("culled_patches", "patch", "patches left out because they lie outside the view"),
            {"culled_patches_pct", "%", "culled patches as a share of all patches"},
            {"tile_error_px", "pixel", "greatest error of a drawn tile, on the screen",
             Better::Lower},
            {"height_error_m", "m", "error of the drawn ground's height", Better::Lower},
            {"height_error_px", "pixel", "error of the drawn ground's height, on the screen",
             Better::Lower},
            {"crack_pixels", "pixel", "pixels that show what lies behind or under the ground",
             Better::Lower},
            detail("truth_underside_pixels", "pixel",
                   "pixels where the ground at full resolution shows its underside, too"),
            {"channel_error", "level",
             "mean absolute difference of a colour channel (0 … 255) to the truth", Better::Lower},
            {"display_psnr_db", "dB",
             "peak signal-to-noise ratio of the picture as displayed, in sRGB of 8 bits; 120 of "
             "equal ones",
             Better::Higher},
            {"display_flip", "1",
             "mean FLIP error of the picture as displayed, without values beyond 1", Better::Lower},
            detail("surface_triangles", "triangle", "triangles drawn, without skirts"),
            detail("shared_edges", "edge", "edges shared by two patches"),
            {"factor_mismatches", "edge",
             "shared edges with two different tessellation factors, where cracks open",
             Better::Lower},
            {"edge_jump", "1", "ratio of the factors of neighbouring edges", Better::Lower},
            detail("edges_at_greatest_pct", "%",
                   "share of the edges that have the greatest factor"),
            detail("unclamped_edges", "edge",
                   "edges whose factor lies between the least and the greatest"),
            detail("unhalved_edges", "edge",
                   "edges whose factor does not halve where edges may be twice as long",
                   Better::Lower),
            detail("most_patch_vertices", "vertex", "most vertices that a patch has"),
            detail("seam_edges", "edge", "edges along seams that were checked"),
            {"open_edges", "edge", "edges of the drawn ground that are open: cracks",
             Better::Lower},
            detail("largest_fan", "triangle", "most triangles around one vertex of a seam"),
            detail("yardstick_ms", "ms", "time of clearing and shading without tessellation"),
            {"preprocess_ms", "ms", "time to make the tree of tiles, or to map it from a file",
             Better::Lower, true, config::MetricInfo::Of::Either, true},
            detail("loaded_tiles", "tile", "tiles loaded in a frame"),
            detail("map_mib", "MiB", "size of the height map"),
            {"memory_bytes", "byte", "memory of tiles and patches on the device", Better::Lower},
        },
        {
            {"tile_walk", "choosing the tiles to draw"},
            {"load_tiles", "loading heights that came into view"},
            {"draw", "tessellation and shading"},
            {"mean", "mean of all places"},
            {"max", "the greatest of all places"},
            {"net", "without what the yardstick takes"},
            {"patches", "between patches of one tile"},
            {"tiles", "between tiles"},
            {"background", "pixels that show the background"},
            {"underside", "pixels that show the underside of the ground"},
        },
        false,
        {"image"},
        {"height_error_m", "height_error_px", "crack_pixels", "edge_jump"}};
}

}  // namespace

const technique::TechniqueInfo kTerrainTessellation{
    "terrain_tessellation", "height maps tessellated to the screen's resolution (zhang2012)",
    technique::make<TerrainTessellation>, outputs};

}  // namespace gfxrepro::terrain_tessellation
