#include "techniques/terrain_tessellation/terrain_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runner/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::terrain_tessellation {

namespace {

constexpr unsigned kHeightUnit = 0, kColourUnit = 1;
constexpr unsigned kTileBinding = 0, kBlockBinding = 1, kFirstBlockBinding = 2;

const char* spacingName(Spacing spacing) {
    if (spacing == Spacing::FractionalEven) return "fractional_even_spacing";
    return spacing == Spacing::FractionalOdd ? "fractional_odd_spacing" : "equal_spacing";
}

}  // namespace

void DrawCounts::add(const DrawCounts& other) {
    triangles += other.triangles;
    tiles += other.tiles;
    patches += other.patches;
    culledPatches += other.culledPatches;
    drawCalls += other.drawCalls;
}

gl::Defines terrainDefines(const DeviceTerrain& terrain, const RenderSettings& settings) {
    const FactorSettings& factors = settings.factors;
    return {{"TILE_BINDING", int(kTileBinding)},
            {"BLOCK_BINDING", int(kBlockBinding)},
            {"FIRST_BLOCK_BINDING", int(kFirstBlockBinding)},
            {"COUNTER_BINDING", int(kCounterBinding)},
            {"HEIGHT_UNIT", int(kHeightUnit)},
            {"COLOUR_UNIT", int(kColourUnit)},
            {"PAGE_BORDER", HeightPages::kBorder},
            {"PATCHES_PER_TILE_SIDE", factors.tile.patchesPerTile},
            {"BLOCKS_PER_PATCH", factors.tile.blocksPerPatch},
            {"BLOCK_FLOATS", kBlockFloats},
            {"BLOCK_SEGMENTS", terrain.metadata().settings().blockSegments},
            {"LEVEL_COUNT", terrain.metadata().levelCount()},
            {"SEGMENT", static_cast<int>(factors.segment)},
            {"INNER", static_cast<int>(factors.inner)},
            {"OWN_FACTORS", factors.edges == EdgeRule::OwnPatch ? 1 : 0},
            {"SPACING", std::string(spacingName(settings.spacing))},
            {"CAPTURE", settings.capturesVertices ? 1 : 0},
            {"SHADING", static_cast<int>(hasColourMap(settings.shading) ? Shading::ColourMap
                                                                        : settings.shading)}};
}

gl::Buffer bindTiles(std::span<const Tile> tiles, std::span<const int> layers) {
    GFXREPRO_ASSERT_EQ(tiles.size(), layers.size());
    std::vector<glm::ivec4> values;
    values.reserve(tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        values.emplace_back(tiles[i].originSample, tiles[i].level, layers[i]);
    }
    gl::Buffer buffer = gl::Buffer::of(values);
    buffer.bindStorage(kTileBinding);
    return buffer;
}

void bindTerrain(const gl::Program& program, const DeviceTerrain& terrain, const kit::View& view) {
    terrain.pages().texture().bind(kHeightUnit);
    program.setIfActive("heightOfTexel", terrain.heightOfTexel());
    program.setIfActive("spacing", terrain.metadata().spacingM());
    program.setIfActive("clipFromWorld", view.clipFromWorld());
}

void bindFactors(const gl::Program& program, const DeviceTerrain& terrain,
                 const RenderSettings& settings, const kit::View& view) {
    terrain.blocks().bindStorage(kBlockBinding);
    terrain.firstBlocks().bindStorage(kFirstBlockBinding);
    const glm::vec2 size(view.sizePx);
    program.setIfActive("imageSize", size);
    program.setIfActive("eye", view.eyeWorld);
    program.setIfActive("focalPx",
                        0.5F * size * glm::vec2(view.clipFromView[0].x, view.clipFromView[1].y));
    program.setIfActive("segmentPx", settings.factors.segmentPx);
    program.setIfActive("factorLimits",
                        glm::vec2(settings.factors.smallest, settings.factors.greatest));
    program.setIfActive("nearDistance", view.nearM);
    program.setIfActive("isCulling", settings.cullsPatches ? 1 : 0);
    const std::array<glm::vec4, 6> planes = frustumPlanes(view);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        program.setIfActive(fmt::format("frustumPlanes[{}]", i).c_str(), planes[i]);
    }
}

TerrainRenderer::TerrainRenderer(const gl::ShaderLibrary& shaders, DeviceTerrain& terrain,
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
    const std::array<const gl::Texture*, 1> colours{&nothing_};
    nowhere_ = gl::Framebuffer(colours, nullptr);
}

void TerrainRenderer::bindShading(const gl::Program& program) const {
    program.use();
    noAttributes_.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    settings_.showsUnderside ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glPolygonMode(GL_FRONT_AND_BACK, settings_.isWireframe ? GL_LINE : GL_FILL);
    if (hasColourMap(settings_.shading)) settings_.colourMap->bind(kColourUnit);
    program.setIfActive("lastSample", glm::vec2(terrain_->metadata().sizeSamples() - 1));
    program.setIfActive("heightExtent", glm::vec2(terrain_->lowestM(), terrain_->highestM()));
}

template <class Draw>
DrawCounts TerrainRenderer::drawInTurns(std::span<const Tile> tiles, const Draw& draw) {
    DrawCounts counts;
    const auto turn = static_cast<std::size_t>(terrain_->pages().capacity());
    for (std::size_t first = 0; first < tiles.size(); first += turn) {
        const auto some = tiles.subspan(first, std::min(turn, tiles.size() - first));
        const std::vector<int> layers = terrain_->pages().load(some);
        primitives_.begin();
        DrawCounts drawn = draw(some, layers);
        primitives_.end();
        drawn.triangles = primitives_.result();
        drawn.tiles = static_cast<int>(some.size());
        counts.add(drawn);
    }
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CULL_FACE);
    return counts;
}

int TerrainRenderer::drawBatches(const PatchBatches& patches) const {
    std::vector<std::uint32_t> vertices;
    vertices.reserve(4 * patches.order.size());
    for (const std::uint32_t patch : patches.order) {
        for (std::uint32_t corner = 0; corner < 4; ++corner) vertices.push_back(4 * patch + corner);
    }
    const gl::Buffer indices = gl::Buffer::of(vertices);
    gl::VertexArray array;
    array.setIndices(indices);
    array.bind();
    std::size_t first = 0;
    double pending = 0.0;
    for (const PatchBatch& batch : patches.batches) {
        glDrawElements(GL_PATCHES, static_cast<GLsizei>(4 * batch.count), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(4 * sizeof(std::uint32_t) * first));
        first += batch.count;
        pending += batch.triangles;
        if (pending < settings_.batches->triangles) continue;
        glFlush();
        pending = 0.0;
    }
    noAttributes_.bind();
    return static_cast<int>(patches.batches.size());
}

DrawCounts TerrainRenderer::drawPatches(std::span<const Tile> tiles, std::span<const int> layers,
                                        const kit::View& view, Parts parts) const {
    const int m = settings_.factors.tile.patchesPerTile;
    const bool hasSkirts = parts == Parts::Skirts || (parts == Parts::AsSet && settings_.hasSkirts);
    const int patchesPerTile = m * m + (hasSkirts ? 4 * m : 0);
    // Skirts end below the lowest sample, by more than depth's rounding.
    const float relief = terrain_->highestM() - terrain_->lowestM();
    const float foot =
        terrain_->lowestM() - std::max(0.01F * relief, terrain_->metadata().spacingM());
    const gl::Buffer records = bindTiles(tiles, layers);
    tessellated_.set("patchesPerTile", patchesPerTile);
    tessellated_.set("skirtFoot", foot);
    DrawCounts counts;
    const int tileCount = static_cast<int>(tiles.size());
    if (settings_.batches) {
        counts.drawCalls = drawBatches(
            batchPatches(terrain_->metadata(), settings_.factors, view,
                         {tiles, hasSkirts, foot, settings_.cullsPatches, parts != Parts::Skirts},
                         *settings_.batches));
    } else if (parts == Parts::Skirts) {
        for (int tile = 0; tile < tileCount; ++tile, ++counts.drawCalls) {
            glDrawArrays(GL_PATCHES, 4 * (patchesPerTile * tile + m * m), 4 * 4 * m);
        }
    } else {
        glDrawArrays(GL_PATCHES, 0, 4 * patchesPerTile * tileCount);
        counts.drawCalls = 1;
    }
    counts.patches = m * m * tileCount;
    return counts;
}

void TerrainRenderer::bindTessellated(const kit::View& view) {
    bindShading(tessellated_);
    bindTerrain(tessellated_, *terrain_, view);
    bindFactors(tessellated_, *terrain_, settings_, view);
    counters_.clear();
    counters_.bindStorage(kCounterBinding);
    glPatchParameteri(GL_PATCH_VERTICES, 4);
}

DrawCounts TerrainRenderer::drawTessellated(std::span<const Tile> tiles, const kit::View& view,
                                            const gl::Framebuffer& target) {
    target.bind();
    bindTessellated(view);
    DrawCounts counts =
        drawInTurns(tiles, [&](std::span<const Tile> some, std::span<const int> layers) {
            return drawPatches(some, layers, view);
        });
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    counts.culledPatches = static_cast<int>(counters_.read<std::uint32_t>(1).front());
    return counts;
}

/// Every triangle is culled. Not GL_RASTERIZER_DISCARD, with which llvmpipe counts no primitives.
void TerrainRenderer::bindNothing() const {
    nowhere_.bind();
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT_AND_BACK);
}

std::uint64_t TerrainRenderer::countSkirtTriangles(std::span<const Tile> tiles,
                                                   const kit::View& view) {
    bindTessellated(view);
    bindNothing();
    const DrawCounts counts =
        drawInTurns(tiles, [&](std::span<const Tile> some, std::span<const int> layers) {
            return drawPatches(some, layers, view, Parts::Skirts);
        });
    return counts.triangles;
}

std::vector<CapturedVertex> TerrainRenderer::capture(std::span<const Tile> tiles,
                                                     const kit::View& view) {
    GFXREPRO_ASSERT(settings_.capturesVertices);
    bindTessellated(view);
    bindNothing();
    std::vector<CapturedVertex> vertices;
    const int side = settings_.factors.tile.patchesPerTile;
    const auto turn = static_cast<std::size_t>(terrain_->pages().capacity());
    for (std::size_t first = 0; first < tiles.size(); first += turn) {
        const auto some = tiles.subspan(first, std::min(turn, tiles.size() - first));
        const std::vector<int> layers = terrain_->pages().load(some);
        primitives_.begin();
        drawPatches(some, layers, view, Parts::Surface);
        primitives_.end();
        const std::size_t count = 3 * primitives_.result();
        if (count == 0) continue;
        const gl::Buffer captured(count * sizeof(CapturedVertex));
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured.id());
        glBeginTransformFeedback(GL_TRIANGLES);
        drawPatches(some, layers, view, Parts::Surface);
        glEndTransformFeedback();
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
        for (CapturedVertex vertex : captured.read<CapturedVertex>(count)) {
            vertex.patch += side * side * static_cast<int>(first);
            vertices.push_back(vertex);
        }
    }
    glDisable(GL_CULL_FACE);
    return vertices;
}

int TerrainRenderer::drawGridTile(const gl::Program& program, int tile) const {
    program.set("tileIndex", tile);
    const int side =
        settings_.factors.tile.blocksPerTile() * terrain_->metadata().settings().blockSegments;
    const auto most = static_cast<int>(kit::FlushedDraws::kPrimitivesPerFlush);
    const int step = settings_.batches ? std::max(1, most / (2 * side)) : side;
    int draws = 0;
    for (int first = 0; first < side; first += step, ++draws) {
        program.set("firstRow", first);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (side + 1), std::min(step, side - first));
        if (settings_.batches) glFlush();
    }
    return draws;
}

DrawCounts TerrainRenderer::drawGrid(std::span<const Tile> tiles, const kit::View& view,
                                     const gl::Framebuffer& target) {
    target.bind();
    bindShading(grid_);
    bindTerrain(grid_, *terrain_, view);
    return drawInTurns(tiles, [&](std::span<const Tile> some, std::span<const int> layers) {
        const gl::Buffer records = bindTiles(some, layers);
        DrawCounts counts;
        for (int i = 0; i < static_cast<int>(some.size()); ++i) {
            counts.drawCalls += drawGridTile(grid_, i);
        }
        return counts;
    });
}

DrawCounts TerrainRenderer::drawMorphed(std::span<const Tile> tiles, const MorphRanges& ranges,
                                        const kit::View& view, const gl::Framebuffer& target) {
    target.bind();
    bindShading(morphed_);
    bindTerrain(morphed_, *terrain_, view);
    morphed_.set("eye", view.eyeWorld);
    return drawInTurns(tiles, [&](std::span<const Tile> some, std::span<const int> layers) {
        const gl::Buffer records = bindTiles(some, layers);
        DrawCounts counts;
        for (std::size_t i = 0; i < some.size(); ++i) {
            const float range = ranges.rangesM.at(static_cast<std::size_t>(some[i].level));
            morphed_.set("morphRange", glm::vec2(ranges.startShare, 1.0F) * range);
            counts.drawCalls += drawGridTile(morphed_, static_cast<int>(i));
        }
        return counts;
    });
}

}  // namespace gfxrepro::terrain_tessellation
