#include "techniques/terrain_tessellation/terrain_renderer.h"

#include <algorithm>
#include <array>

#include "runner/core/error.h"

namespace gfxrepro::terrain_tessellation {

namespace {

constexpr unsigned kHeightUnit = 0;
constexpr unsigned kTileBinding = 0, kBlockBinding = 1, kFirstBlockBinding = 2;
// llvmpipe keeps a draw's triangles in memory until it is flushed.
constexpr int kGridTrianglesPerDraw = 1 << 16;

const char* spacingName(Spacing spacing) {
    if (spacing == Spacing::FractionalEven) return "fractional_even_spacing";
    return spacing == Spacing::FractionalOdd ? "fractional_odd_spacing" : "equal_spacing";
}

/// Hand-outs of whole patches, each of about `limit` triangles at most (a single patch may have
/// more); `flush` draws the pending ones.
class PatchRuns {
  public:
    PatchRuns(int limit) : limit_(limit) {}
    void add(int count, double triangles) {
        if (pending_ > 0 && limit_ > 0 && triangles_ + triangles > limit_) flush();
        pending_ += count;
        triangles_ += triangles;
    }
    void flush() {
        if (pending_ == 0) return;
        glDrawArrays(GL_PATCHES, 4 * first_, 4 * pending_);
        if (limit_ > 0) glFlush();
        first_ += pending_;
        pending_ = 0;
        triangles_ = 0.0;
        ++draws_;
    }
    int draws() const { return draws_; }

  private:
    int limit_, first_ = 0, pending_ = 0, draws_ = 0;
    double triangles_ = 0.0;
};

}  // namespace

int splitPrimitivesFor(bool isSoftwareDevice) {
    return isSoftwareDevice ? 1 << 14 : 0;
}

gl::Defines terrainDefines(const DeviceTerrain& terrain, const RenderSettings& settings) {
    const FactorSettings& factors = settings.factors;
    return {{"TILE_BINDING", int(kTileBinding)},
            {"BLOCK_BINDING", int(kBlockBinding)},
            {"FIRST_BLOCK_BINDING", int(kFirstBlockBinding)},
            {"COUNTER_BINDING", int(kCounterBinding)},
            {"HEIGHT_UNIT", int(kHeightUnit)},
            {"PATCHES_PER_TILE_SIDE", factors.tile.patchesPerTile},
            {"BLOCKS_PER_PATCH", factors.tile.blocksPerPatch},
            {"BLOCK_SEGMENTS", terrain.metadata().settings().blockSegments},
            {"LEVEL_COUNT", terrain.metadata().levelCount()},
            {"SEGMENT", static_cast<int>(factors.segment)},
            {"INNER", static_cast<int>(factors.inner)},
            {"OWN_FACTORS", factors.edges == EdgeRule::OwnPatch ? 1 : 0},
            {"SPACING", std::string(spacingName(settings.spacing))},
            {"SHADING", static_cast<int>(settings.shading)}};
}

gl::Buffer bindTiles(std::span<const Tile> tiles, int stepSamples) {
    std::vector<glm::ivec4> values;
    values.reserve(tiles.size());
    for (const Tile& tile : tiles) {
        values.emplace_back(tile.originSample, tile.level,
                            stepSamples > 0 ? stepSamples : 1 << tile.level);
    }
    gl::Buffer buffer = gl::Buffer::of(values);
    buffer.bindStorage(kTileBinding);
    return buffer;
}

void bindTerrain(const gl::Program& program, const DeviceTerrain& terrain,
                 const depth_images::View& view) {
    const auto setIfRead = [&](const char* name, const auto& value) {
        if (program.isActive(name)) program.set(name, value);
    };
    terrain.heights().bind(kHeightUnit);
    setIfRead("heightOfTexel", terrain.heightOfTexel());
    setIfRead("spacing", terrain.metadata().spacingM());
    setIfRead("clipFromWorld", view.clipFromWorld());
}

void bindFactors(const gl::Program& program, const DeviceTerrain& terrain,
                 const RenderSettings& settings, const depth_images::View& view) {
    const auto setIfRead = [&](const char* name, const auto& value) {
        if (program.isActive(name)) program.set(name, value);
    };
    terrain.blocks().bindStorage(kBlockBinding);
    terrain.firstBlocks().bindStorage(kFirstBlockBinding);
    const glm::vec2 size(view.sizePx);
    setIfRead("imageSize", size);
    setIfRead("eye", view.eyeWorld);
    setIfRead("focalPx", 0.5F * size * glm::vec2(view.clipFromView[0].x, view.clipFromView[1].y));
    setIfRead("segmentPx", settings.factors.segmentPx);
    setIfRead("factorLimits", glm::vec2(settings.factors.smallest, settings.factors.greatest));
    setIfRead("nearDistance", view.nearM);
    setIfRead("isCulling", settings.cullsPatches ? 1 : 0);
    // −w ≤ x, y, z ≤ w, a plane each.
    static constexpr std::array kNames{"frustumPlanes[0]", "frustumPlanes[1]", "frustumPlanes[2]",
                                       "frustumPlanes[3]", "frustumPlanes[4]", "frustumPlanes[5]"};
    const glm::mat4 rows = glm::transpose(view.clipFromWorld());
    for (int i = 0; i < 6; ++i) {
        const glm::vec4 plane = i % 2 == 0 ? rows[3] + rows[i / 2] : rows[3] - rows[i / 2];
        setIfRead(kNames[static_cast<std::size_t>(i)], plane / glm::length(glm::vec3(plane)));
    }
}

TerrainRenderer::TerrainRenderer(const gl::ShaderLibrary& shaders, const DeviceTerrain& terrain,
                                 const RenderSettings& settings)
    : terrain_(&terrain), settings_(settings) {
    const TileSettings& tile = settings.factors.tile;
    const MetadataSettings& blocks = terrain.metadata().settings();
    GFXREPRO_ASSERT_EQ(tile.blocksPerTile(), blocks.tileBlocks);
    gl::Defines defines = terrainDefines(terrain, settings);
    const std::string folder = "terrain_tessellation/";
    const std::string fragment = folder + "surface.frag.glsl";
    tessellated_ = gl::Program(shaders,
                               {folder + "patch.vert.glsl", folder + "patch.tesc.glsl",
                                folder + "patch.tese.glsl", fragment},
                               defines);
    defines["MORPH"] = 0;
    grid_ = gl::Program(shaders, {folder + "grid.vert.glsl", fragment}, defines);
    defines["MORPH"] = 1;
    morphed_ = gl::Program(shaders, {folder + "grid.vert.glsl", fragment}, defines);
    counters_ = gl::Buffer(sizeof(std::uint32_t));
}

void TerrainRenderer::bindShading(const gl::Program& program) const {
    program.use();
    noAttributes_.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glPolygonMode(GL_FRONT_AND_BACK, settings_.isWireframe ? GL_LINE : GL_FILL);
    if (program.isActive("heightExtent")) {
        program.set("heightExtent", glm::vec2(terrain_->lowestM(), terrain_->highestM()));
    }
}

std::array<double, 4> TerrainRenderer::outerFactors(const Patch& patch,
                                                    const depth_images::View& view,
                                                    const glm::dmat4& clipFromWorld) const {
    std::array<double, 4> outer;
    for (const Edge edge : {kWest, kNorth, kEast, kSouth}) {
        outer[edge] =
            edgeFactor(terrain_->metadata(), settings_.factors, view, clipFromWorld, patch, edge);
    }
    if (settings_.factors.edges == EdgeRule::OwnPatch) {
        outer.fill(0.25 * (outer[0] + outer[1] + outer[2] + outer[3]));
    }
    return outer;
}

int TerrainRenderer::drawPatches(std::span<const Tile> tiles, const depth_images::View& view,
                                 int patchesPerTile) const {
    PatchRuns runs(settings_.splitPrimitives);
    const int m = settings_.factors.tile.patchesPerTile;
    const glm::dmat4 clipFromWorld = glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld);
    for (const Tile& tile : tiles) {
        if (settings_.splitPrimitives == 0) {
            runs.add(patchesPerTile, 0.0);
            continue;
        }
        for (int i = 0; i < m * m; ++i) {
            const Patch patch = patchOf(tile, settings_.factors.tile, i);
            runs.add(1, triangleBound(outerFactors(patch, view, clipFromWorld),
                                      settings_.factors.inner));
        }
        for (int i = m * m; i < patchesPerTile; ++i) {
            const int rim = (i - m * m) / m, along = (i - m * m) % m;
            const int far = rim == kEast || rim == kSouth ? m - 1 : 0;
            const bool isAlongZ = rim == kWest || rim == kEast;
            const Patch patch =
                patchOf(tile, settings_.factors.tile, isAlongZ ? along * m + far : far * m + along);
            const double factor =
                outerFactors(patch, view, clipFromWorld)[static_cast<std::size_t>(rim)];
            // Two segments downwards at most, of two triangles each.
            runs.add(1, 4.0 * (factor + 2.0));
        }
    }
    runs.flush();
    return runs.draws();
}

DrawCounts TerrainRenderer::drawTessellated(std::span<const Tile> tiles,
                                            const depth_images::View& view,
                                            const gl::Framebuffer& target) {
    DrawCounts counts;
    if (tiles.empty()) return counts;
    const int m = settings_.factors.tile.patchesPerTile;
    const int patchesPerTile = m * m + (settings_.hasSkirts ? 4 * m : 0);
    // Skirts end below the lowest sample, by more than depth's rounding.
    const float relief = terrain_->highestM() - terrain_->lowestM();
    const float foot =
        terrain_->lowestM() - std::max(0.01F * relief, terrain_->metadata().spacingM());
    target.bind();
    bindShading(tessellated_);
    const gl::Buffer records = bindTiles(tiles, 0);
    bindTerrain(tessellated_, *terrain_, view);
    bindFactors(tessellated_, *terrain_, settings_, view);
    tessellated_.set("patchesPerTile", patchesPerTile);
    tessellated_.set("skirtFoot", foot);
    counters_.clear();
    counters_.bindStorage(kCounterBinding);
    glPatchParameteri(GL_PATCH_VERTICES, 4);
    primitives_.begin();
    counts.drawCalls = drawPatches(tiles, view, patchesPerTile);
    primitives_.end();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    counts.triangles = primitives_.result();
    counts.tiles = static_cast<int>(tiles.size());
    counts.patches = counts.tiles * m * m;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    counts.culledPatches = static_cast<int>(counters_.read<std::uint32_t>(1).front());
    return counts;
}

int TerrainRenderer::drawGridTile(const gl::Program& program, int tile, int cellsPerSide) const {
    program.set("tileIndex", tile);
    program.set("cellsPerSide", cellsPerSide);
    const int cells = cellsPerSide * cellsPerSide, step = kGridTrianglesPerDraw / 2;
    int draws = 0;
    for (int first = 0; first < cells; first += step, ++draws) {
        glDrawArrays(GL_TRIANGLES, 6 * first, 6 * std::min(step, cells - first));
        if (settings_.splitPrimitives > 0) glFlush();
    }
    return draws;
}

DrawCounts TerrainRenderer::drawGrid(std::span<const Tile> tiles, int stepSamples,
                                     const depth_images::View& view,
                                     const gl::Framebuffer& target) {
    GFXREPRO_ASSERT(stepSamples > 0);
    DrawCounts counts;
    if (tiles.empty()) return counts;
    target.bind();
    bindShading(grid_);
    const gl::Buffer records = bindTiles(tiles, stepSamples);
    bindTerrain(grid_, *terrain_, view);
    primitives_.begin();
    for (int i = 0; i < static_cast<int>(tiles.size()); ++i) {
        const int span = tiles[static_cast<std::size_t>(i)].sizeSamples;
        counts.drawCalls += drawGridTile(grid_, i, std::max(1, span / stepSamples));
    }
    primitives_.end();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    counts.triangles = primitives_.result();
    counts.tiles = static_cast<int>(tiles.size());
    return counts;
}

DrawCounts TerrainRenderer::drawMorphed(std::span<const Tile> tiles, const MorphRanges& ranges,
                                        const depth_images::View& view,
                                        const gl::Framebuffer& target) {
    DrawCounts counts;
    if (tiles.empty()) return counts;
    target.bind();
    bindShading(morphed_);
    const gl::Buffer records = bindTiles(tiles, 0);
    bindTerrain(morphed_, *terrain_, view);
    morphed_.set("eye", view.eyeWorld);
    primitives_.begin();
    for (int i = 0; i < static_cast<int>(tiles.size()); ++i) {
        const Tile& tile = tiles[static_cast<std::size_t>(i)];
        const float range = ranges.rangesM.at(static_cast<std::size_t>(tile.level));
        morphed_.set("morphRange", glm::vec2(ranges.startShare, 1.0F) * range);
        counts.drawCalls += drawGridTile(morphed_, i, tile.sizeSamples >> tile.level);
    }
    primitives_.end();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    counts.triangles = primitives_.result();
    counts.tiles = static_cast<int>(tiles.size());
    return counts;
}

}  // namespace gfxrepro::terrain_tessellation
