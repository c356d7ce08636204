// What is recorded of a frame: what was drawn, how far it is from the full resolution, pictures.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/image/resample.h"
#include "engine/metrics/flip.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/terrain_tessellation/patch_checks.h"
#include "techniques/terrain_tessellation/terrain_tessellation.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr glm::vec3 kDrawn(0.35F, 0.75F, 0.3F), kCulledPatch(0.95F, 0.55F, 0.15F),
    kCulledTile(0.4F, 0.4F, 0.42F), kTileBorder(1.0F);

/// Lit from the north-west, so that the ground can be told.
float lightAt(const scene::HeightMap& map, glm::ivec2 at, glm::ivec2 step) {
    const glm::ivec2 from = at - step, to = at + step;
    const float rise = map.clampedHeightM(from.x, from.y) - map.clampedHeightM(to.x, to.y);
    const glm::vec2 stepM = glm::vec2(step) * map.spacingM;
    const float ratio = stepM.y / stepM.x;
    const float slope = rise / (2.0F * std::sqrt(1.0F + ratio * ratio) *
                                static_cast<float>(step.x) * map.spacingM.x);
    return std::clamp(0.8F - 1.5F * slope, 0.35F, 1.2F);
}

/// Figure 10 as a map: which tiles and patches of a view are drawn, and which were culled. North is
/// up, `sizePx` along the map's longer side. Drawn patches are green, culled ones orange, culled
/// tiles grey; lines are the borders of patches and, white, of tiles. `tiles` cover the map,
/// `factors` are theirs as FactorReplay gives them; `isCulling`: whether tiles were culled.
image::ImageF cullingPicture(const scene::HeightMap& map, std::span<const Tile> tiles,
                             const TileSettings& settings, std::span<const PatchFactors> factors,
                             const glm::mat4& clipFromWorld, bool isCulling, int sizePx) {
    const glm::ivec2 cells = glm::max(map.sizeSamples - 1, 1);
    const glm::vec2 samplesPerPx = samplesPerPixel(map, sizePx);
    const glm::ivec2 size = glm::max(glm::ivec2(glm::vec2(cells) / samplesPerPx), glm::ivec2(1));
    image::ImageF picture(size.x, size.y, 3);
    const int side = settings.patchesPerTile;
    const glm::ivec2 step = glm::max(glm::ivec2(samplesPerPx), 1);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        const Tile& tile = tiles[t];
        const bool isTileCulled = isCulling && !mayBeVisible(tile.box, clipFromWorld);
        const glm::vec2 origin = glm::vec2(tile.originSample) / samplesPerPx;
        const glm::vec2 tilePx = static_cast<float>(tile.sizeSamples) / samplesPerPx;
        const glm::vec2 patchPx = tilePx / static_cast<float>(side);
        const glm::ivec2 from(glm::ceil(origin)),
            to = glm::min(glm::ivec2(glm::ceil(origin + tilePx)), size);
        for (int y = from.y; y < to.y; ++y) {
            for (int x = from.x; x < to.x; ++x) {
                const glm::vec2 inside = (glm::vec2(x, y) - origin) / patchPx;
                const glm::ivec2 cell = glm::clamp(glm::ivec2(inside), 0, side - 1);
                const glm::vec2 fromBorderPx = (inside - glm::vec2(cell)) * patchPx;
                const auto patch = t * static_cast<std::size_t>(side * side) +
                                   static_cast<std::size_t>(cell.y * side + cell.x);
                glm::vec3 colour = isTileCulled                    ? kCulledTile
                                   : factors[patch].outer.x < 0.0F ? kCulledPatch
                                                                   : kDrawn;
                colour *= lightAt(map, glm::ivec2(glm::vec2(x, y) * samplesPerPx), step);
                // Borders of patches only where patches are wider than lines.
                if (std::min(patchPx.x, patchPx.y) >= 4.0F &&
                    glm::any(glm::lessThan(fromBorderPx, glm::vec2(1.0F)))) {
                    colour *= 0.6F;
                }
                if (x == from.x || y == from.y) colour = kTileBorder;
                for (int c = 0; c < 3; ++c) picture.at(x, y, c) = colour[c];
            }
            map.release();
        }
    }
    return picture;
}

/// Of the one scope of a profiler; not a number by a device without a clock.
double secondsOf(gl::Profiler& profiler) {
    return 1e-3 * profiler.collect().front().timeMs.value_or(std::nan(""));
}

DepthMap readDepths(const gl::Texture& depth, const kit::View& view) {
    DepthMap map{view, depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1)};
    for (float& value : map.depthM) value = kit::depthOfWindow(view, value);
    return map;
}

}  // namespace

void TerrainTessellation::record(technique::Recorder& recorder) {
    recordDrawn(recorder);
}

void TerrainTessellation::recordOnce(technique::Recorder& recorder) {
    if (params_.method == Method::Adaptive) recordFactors(recorder);
    if (!params_.measuresErrors && !params_.showsPictures) return;
    const Drawn drawn = drawnAgain(params_.method, selection_, params_.measuresErrors);
    std::shared_ptr<const Truth> truth;
    if (params_.measuresErrors) truth = truthOfFrame();
    if (params_.showsPictures) {
        const image::ImageF picture = image::averaged(drawn.picture, params_.supersampling);
        kit::ImageLayers layers(drawn.depths.view, params_.supersampling);
        layers.depths(drawn.depths.depthM);
        if (truth) layers.errors(picture, truth->picture);
        recorder.image("image", picture, layers.options());
        if (params_.method == Method::Adaptive) recordCulling(recorder);
    }
    if (truth) recordErrors(recorder, drawn, *truth);
}

std::size_t TerrainTessellation::Truth::sizeBytes() const {
    return sizeof(float) * (drawn.picture.values().size() + drawn.depths.depthM.size() +
                            drawn.upperDepths.depthM.size() + picture.values().size());
}

/// Every sample of the map, however it is tessellated otherwise. Of several frames the tiles that a
/// truth loads are there for the next one: each has its own.
std::shared_ptr<const TerrainTessellation::Truth> TerrainTessellation::truthOfFrame() {
    return technique::sharedResult<Truth>(
        frameCount_ == 1 ? shared_ : nullptr, "truth",
        {"delta_s", "tau", "edges", "inner", "partitioning", "skirts"}, [&] {
            Drawn drawn = drawnAgain(Method::UniformGrid, selectAll(), true);
            image::ImageF picture = image::averaged(drawn.picture, params_.supersampling);
            return Truth{std::move(drawn), std::move(picture)};
        });
}

void TerrainTessellation::recordDrawn(technique::Recorder& recorder) {
    const DrawCounts counts = renderer_->counts();
    const double drawS = secondsOf(*drawTime_);
    const auto triangles = static_cast<double>(counts.triangles);
    recorder.metric("drawn_triangles", triangles);
    if (drawS > 0.0) recorder.metric("triangles_per_second", triangles / drawS);
    recorder.metric("draw_calls", counts.drawCalls);
    recorder.metric("tiles", static_cast<double>(selection_.tiles.size()));
    float errorPx = 0.0F;
    for (const Tile& tile : selection_.tiles) errorPx = std::max(errorPx, tile.screenErrorPx);
    recorder.metric("tile_error_px", errorPx);
    recorder.metric("preprocess_ms", preprocessMs_);
    recorder.metric("loaded_tiles", static_cast<double>(loadedTiles_));
    const glm::dvec2 samples(scene_->heights->sizeSamples);
    recorder.metric("map_mib", samples.x * samples.y * sizeof(float) / (1 << 20));
    recorder.metric("memory_bytes", static_cast<double>(terrain_->sizeBytes()));
    const bool hasPatches = params_.method == Method::Adaptive || params_.method == Method::Patches;
    if (!hasPatches) return;
    recorder.metric("patches", counts.patches);
    recorder.metric("culled_patches", counts.culledPatches);
    recorder.metric("culled_patches_pct", kit::percent(counts.culledPatches, counts.patches));
    if (params_.method != Method::Adaptive) return;
    const auto skirts =
        params_.render.hasSkirts
            ? static_cast<double>(renderer_->countSkirtTriangles(selection_.tiles, view_))
            : 0.0;
    recorder.metric("surface_triangles", triangles - skirts);
    if (params_.drawsYardstick && drawS > 0.0) recordNetRate(recorder, counts, drawS);
}

void TerrainTessellation::recordFactors(technique::Recorder& recorder) {
    const FactorSettings& factors = renderer_->settings().factors;
    FactorReplay replay(*shaders_, *terrain_, renderer_->settings());
    const std::vector<PatchFactors> drawn = replay.run(selection_.tiles, view_);
    const EdgeAgreement agreement = compareEdges(selection_.tiles, factors.tile, drawn);
    recorder.metric("shared_edges", agreement.sharedEdges);
    recorder.metric("factor_mismatches", agreement.unequalEdges);
    if (params_.checksSeams) recordSeams(recorder, drawn);
    const EdgeJumps jumps = edgeJumps(drawn, factors.inner);
    recorder.metric("edge_jump", jumps.mean, "mean");
    recorder.metric("edge_jump", jumps.greatest, "max");
    replay.setSegmentPx(2.0F * factors.segmentPx);
    const FactorHalving halving =
        compareHalving(factors, drawn, replay.run(selection_.tiles, view_));
    recorder.metric("edges_at_greatest_pct", kit::percent(halving.greatestEdges, halving.edges));
    recorder.metric("unclamped_edges", halving.unclampedEdges);
    recorder.metric("unhalved_edges", halving.unhalvedEdges);
    if (params_.render.spacing != Spacing::FractionalEven ||
        params_.render.factors.edges != EdgeRule::Shared) {
        return;
    }
    int most = 0;
    for (const PatchFactors& patch : drawn) {
        if (patch.outer.x < 0.0F) continue;
        const glm::dvec4 outer(patch.outer);
        most = std::max(most, patchVertices({outer.x, outer.y, outer.z, outer.w}, factors.inner));
    }
    recorder.metric("most_patch_vertices", most);
}

/// What clearing the window and shading its ground cost without tessellation is taken off.
void TerrainTessellation::recordNetRate(technique::Recorder& recorder, const DrawCounts& counts,
                                        double drawS) {
    constexpr int kDraws = 3;
    double leastS = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kDraws; ++i) {
        gl::Profiler profiler(*device_);
        {
            const gl::GpuScope scope(profiler, "yardstick");
            target_->clear();
            yardstick_->drawTessellated(selection_.tiles, view_, target_->framebuffer);
        }
        leastS = std::min(leastS, secondsOf(profiler));
    }
    recorder.metric("yardstick_ms", 1000.0 * leastS);
    const auto triangles =
        static_cast<double>(counts.triangles) - static_cast<double>(yardstick_->counts().triangles);
    if (drawS <= leastS) return;
    recorder.metric("triangles_per_second", triangles / (drawS - leastS), "net");
}

void TerrainTessellation::recordSeams(technique::Recorder& recorder,
                                      std::span<const PatchFactors> drawn) {
    RenderSettings settings = renderer_->settings();
    settings.capturesVertices = true;
    TerrainRenderer captured(*shaders_, *terrain_, settings);
    const Seams seams = checkSeams(selection_.tiles, settings.factors.tile, drawn,
                                   captured.capture(selection_.tiles, view_));
    recorder.metric("seam_edges", static_cast<double>(seams.edges));
    recorder.metric("seam_edges", static_cast<double>(seams.patchEdges), "patches");
    recorder.metric("seam_edges", static_cast<double>(seams.tileEdges), "tiles");
    recorder.metric("open_edges", static_cast<double>(seams.openEdges));
    recorder.metric("largest_fan", static_cast<double>(seams.largestFan));
}

void TerrainTessellation::recordCulling(technique::Recorder& recorder) {
    const std::vector<Tile> tiles = tree_->select(tileView_, params_.maxTileErrorPx, false).tiles;
    FactorReplay replay(*shaders_, *terrain_, renderer_->settings());
    recorder.image("culling", cullingPicture(*scene_->heights, tiles, params_.render.factors.tile,
                                             replay.run(tiles, view_), tileView_.clipFromWorld,
                                             params_.culling != Culling::None, sizePx_.y));
}

TerrainTessellation::Drawn TerrainTessellation::drawnAgain(Method method,
                                                           const TileSelection& selection,
                                                           bool showsUnderside) {
    const int scale = params_.supersampling;
    kit::View view = view_;
    view.sizePx *= scale;
    const Target target(view.sizePx);
    // Lengths in pixels are `scale` times as large: the factors stay as they were.
    const float segmentPx = params_.render.factors.segmentPx;
    renderer_->setSegmentPx(static_cast<float>(scale) * segmentPx);
    renderer_->setShowsUnderside(showsUnderside);
    draw(method, selection, view, target);
    renderer_->setShowsUnderside(false);
    renderer_->setSegmentPx(segmentPx);
    Drawn drawn{target.colour.readImage(3), readDepths(target.depth, view), {}, 0};
    drawn.upperDepths = drawn.depths;
    const std::vector<float> coverage = target.colour.read<float>(GL_ALPHA, GL_FLOAT, 1);
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        float& depthM = drawn.upperDepths.depthM[i];
        if (coverage[i] > 0.5F || depthM == 0.0F) continue;
        depthM = 0.0F;  // see surface.frag.glsl
        ++drawn.undersidePixels;
    }
    return drawn;
}

void TerrainTessellation::recordErrors(technique::Recorder& recorder, const Drawn& drawn,
                                       const Truth& known) {
    const Drawn& truth = known.drawn;
    const scene::HeightMap& map = *scene_->heights;
    // As frames are drawn: what shows the underside above may show the background here.
    const Drawn framed = drawnAgain(params_.method, selection_, false);
    const HeightErrors height = heightErrors(
        framed.depths, truth.depths, [&](float x, float z) { return drawnHeightAt(map, x, z); },
        [&] { map.release(); });
    recorder.metric("height_error_m", height.meanM, "mean");
    recorder.metric("height_error_m", height.maxM, "max");
    recorder.metric("height_error_px", height.meanPx / params_.supersampling, "mean");
    recorder.metric("height_error_px", height.maxPx / params_.supersampling, "max");
    const std::vector<std::uint8_t> cracks = crackMarks(drawn.upperDepths, truth.upperDepths);
    const std::size_t background = markedCount(crackMarks(framed.depths, truth.depths));
    recorder.metric("crack_pixels", static_cast<double>(background), "background");
    recorder.metric("crack_pixels", static_cast<double>(markedCount(cracks)), "underside");
    // Edge-on triangles may turn over when the device rounds their corners: the truth's, too.
    recorder.metric("truth_underside_pixels", static_cast<double>(truth.undersidePixels));

    const image::ImageF picture = image::averaged(drawn.picture, params_.supersampling);
    const image::ImageF& truthPicture = known.picture;
    const glm::dvec3 channels = kit::channelErrors(picture, truthPicture, nullptr);
    recorder.metric("channel_error", (channels.x + channels.y + channels.z) / 3.0);
    recorder.metric("display_psnr_db", kit::shownPsnrDb(picture, truthPicture));
    recorder.metric("display_flip", metrics::flip(truthPicture, picture));
    if (!params_.showsPictures) return;
    recorder.image("truth", truthPicture,
                   kit::ImageLayers(truth.depths.view, params_.supersampling)
                       .depths(truth.depths.depthM)
                       .options("image"));
    recorder.image("error", kit::errorPicture(picture, truthPicture, 8), kit::seenFrom(view_));
    recorder.image("cracks", withMarks(drawn.picture, cracks), kit::seenFrom(view_));
}

}  // namespace gfxrepro::terrain_tessellation
