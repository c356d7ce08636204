#include "techniques/terrain_tessellation/terrain_renderer.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/gl/gl.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::terrain_tessellation {

namespace {

int pageCount(std::size_t budgetBytes, std::size_t pageBytes, int side, int tileCount) {
    if (budgetBytes < pageBytes) {
        throw Error(fmt::format(
            "{:.2f} MiB for heights hold no tile of {} × {}; allowed: {:.2f} MiB or more",
            static_cast<double>(budgetBytes) / (1 << 20), side, side,
            std::ceil(100.0 * static_cast<double>(pageBytes) / (1 << 20)) / 100.0));
    }
    GLint mostLayers = 1;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &mostLayers);
    const std::size_t pages = budgetBytes / pageBytes;
    return static_cast<int>(std::min(
        pages, static_cast<std::size_t>(std::min(std::max(1, tileCount), int{mostLayers}))));
}

}  // namespace

HeightPages::HeightPages(const scene::HeightMap& map, std::size_t budgetBytes, int tileSegments,
                         int tileCount)
    : map_(&map) {
    const int side = tileSegments + kMoreTexels;
    const std::size_t pageBytes =
        static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * sizeof(float);
    const int count = pageCount(budgetBytes, pageBytes, side, tileCount);
    texture_ = gl::Texture::make2DArray(GL_R32F, glm::ivec2(side), count);
    keys_.resize(static_cast<std::size_t>(count));
    lastUse_.resize(keys_.size(), 0);
}

int HeightPages::leastRecentlyUsed() const {
    return static_cast<int>(std::min_element(lastUse_.begin(), lastUse_.end()) - lastUse_.begin());
}

std::vector<int> HeightPages::load(std::span<const Tile> tiles) {
    GFXREPRO_ASSERT(tiles.size() <= keys_.size());
    ++clock_;
    const auto keyOf = [](const Tile& tile) {
        return Key(tile.level, tile.originSample.x, tile.originSample.y);
    };
    // First those that are there: they must not make room for the others.
    for (const Tile& tile : tiles) {
        const auto found = layers_.find(keyOf(tile));
        if (found != layers_.end()) lastUse_[static_cast<std::size_t>(found->second)] = clock_;
    }
    std::vector<int> result;
    for (const Tile& tile : tiles) {
        const Key key = keyOf(tile);
        auto found = layers_.find(key);
        if (found == layers_.end()) {
            const int layer = leastRecentlyUsed();
            const auto index = static_cast<std::size_t>(layer);
            if (lastUse_[index] != 0) layers_.erase(keys_[index]);
            fill(layer, tile);
            keys_[index] = key;
            lastUse_[index] = clock_;
            found = layers_.emplace(key, layer).first;
        }
        result.push_back(found->second);
    }
    return result;
}

void HeightPages::fill(int layer, const Tile& tile) {
    const int side = texture_.size().x;
    std::vector<float> heightsM;
    heightsM.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    const int step = 1 << tile.level;
    // Rows of a coarse tile beyond the map's rim repeat samples that are far apart in the file.
    constexpr int kRowsAtOnce = 16;
    for (int j = 0; j < side; ++j) {
        if (j % kRowsAtOnce == 0) map_->release();
        for (int i = 0; i < side; ++i) {
            const glm::ivec2 at = tile.originSample + (glm::ivec2(i, j) - kBorder) * step;
            heightsM.push_back(map_->clampedHeightM(at.x, at.y, tile.level));
        }
    }
    glTextureSubImage3D(texture_.id(), 0, 0, 0, layer, side, side, 1, GL_RED, GL_FLOAT,
                        heightsM.data());
    map_->release();
    ++loadedCount_;
}

namespace {

/// Tiles of all levels that have ground.
int tileCountOf(const TerrainMetadata& metadata) {
    const int perTile = metadata.settings().tileBlocks;
    const glm::ivec2 cells = glm::max(metadata.sizeSamples() - 1, 1);
    int count = 0;
    for (int level = 0; level < metadata.levelCount() && metadata.blocksPerSide(level) >= perTile;
         ++level) {
        const int span = perTile * metadata.blockSizeSamples(level);
        const glm::ivec2 tiles = (cells + span - 1) / span;
        count += tiles.x * tiles.y;
    }
    return count;
}

const TerrainMetadata& requireOfMap(const TerrainMetadata& metadata, const scene::HeightMap& map) {
    if (map.sizeSamples == metadata.sizeSamples()) return metadata;
    throw Error(fmt::format("height map of {} × {} samples with metadata of {} × {}",
                            map.sizeSamples.x, map.sizeSamples.y, metadata.sizeSamples().x,
                            metadata.sizeSamples().y));
}

}  // namespace

DeviceTerrain::DeviceTerrain(const scene::HeightMap& map, const TerrainMetadata& metadata,
                             std::size_t budgetBytes)
    : metadata_(&requireOfMap(metadata, map)),
      lowestM_(metadata.blocks().back().whole.minM),  // the root's
      highestM_(metadata.blocks().back().whole.maxM),
      pages_(map, budgetBytes, metadata.settings().tileBlocks * metadata.settings().blockSegments,
             tileCountOf(metadata)),
      blocks_(gl::Buffer::of(metadata.blocks())),
      firstBlocks_(gl::Buffer::of(metadata.firstBlocks())) {}

gl::Resources DeviceTerrain::resources() const {
    return {{"heightPages", pages_.texture()}, {"Blocks", blocks_}, {"FirstBlocks", firstBlocks_}};
}

std::size_t DeviceTerrain::sizeBytes() const {
    return pages_.texture().sizeBytes() + blocks_.sizeBytes() + firstBlocks_.sizeBytes();
}

namespace {

const char* spacingName(Spacing spacing) {
    if (spacing == Spacing::FractionalEven) return "fractional_even_spacing";
    return spacing == Spacing::FractionalOdd ? "fractional_odd_spacing" : "equal_spacing";
}

}  // namespace

gl::Defines terrainDefines(const DeviceTerrain& terrain, const RenderSettings& settings) {
    const FactorSettings& factors = settings.factors;
    return {{"PAGE_BORDER", HeightPages::kBorder},
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

gl::Buffer tileRecords(std::span<const Tile> tiles, std::span<const int> layers) {
    GFXREPRO_ASSERT_EQ(tiles.size(), layers.size());
    std::vector<glm::ivec4> values;
    values.reserve(tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        values.emplace_back(tiles[i].originSample, tiles[i].level, layers[i]);
    }
    return gl::Buffer::of(values);
}

void setTerrain(const gl::Pass& pass, const DeviceTerrain& terrain, const kit::View& view) {
    const glm::vec2 spacing = terrain.metadata().spacingM();
    pass.setIfActive("spacing", spacing);
    pass.setIfActive("eastPerSouth", spacing.x / spacing.y);
    pass.setIfActive("lastSample", glm::vec2(terrain.metadata().sizeSamples() - 1));
    pass.setIfActive("clipFromWorld", view.clipFromWorld());
}

void setFactors(const gl::Pass& pass, const RenderSettings& settings, const kit::View& view) {
    const glm::vec2 size(view.sizePx);
    pass.setIfActive("imageSize", size);
    pass.setIfActive("eye", view.eyeWorld);
    pass.setIfActive("focalPx",
                     0.5F * size * glm::vec2(view.clipFromView[0].x, view.clipFromView[1].y));
    pass.setIfActive("segmentPx", settings.factors.segmentPx);
    pass.setIfActive("factorLimits",
                     glm::vec2(settings.factors.smallest, settings.factors.greatest));
    pass.setIfActive("nearDistance", view.nearM);
    pass.setIfActive("isCulling", settings.cullsPatches ? 1 : 0);
    const std::array<glm::vec4, 6> planes = frustumPlanes(view);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        pass.setIfActive(fmt::format("frustumPlanes[{}]", i).c_str(), planes[i]);
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
    tessellated_ = gl::Pass(shaders,
                            {folder + "patch.vert.glsl", folder + "patch.tesc.glsl",
                             folder + "patch.tese.glsl", fragment},
                            defines);
    defines["MORPH"] = 0;
    grid_ = gl::Pass(shaders, {folder + "grid.vert.glsl", fragment}, defines);
    defines["MORPH"] = 1;
    morphed_ = gl::Pass(shaders, {folder + "grid.vert.glsl", fragment}, defines);
    counters_ = gl::Buffer(sizeof(std::uint32_t));
    const std::array<const gl::Texture*, 1> colours{&nothing_};
    nowhere_ = gl::Framebuffer(colours, nullptr);
}

void TerrainRenderer::setShading(const gl::Pass& pass) const {
    noAttributes_.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    settings_.showsUnderside ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glPolygonMode(GL_FRONT_AND_BACK, settings_.isWireframe ? GL_LINE : GL_FILL);
    const scene::HeightMap::Extremes ends{terrain_->lowestM(), terrain_->highestM()};
    pass.setIfActive("lowestAndRelief", glm::vec2(ends.lowestM, ends.reliefM()));
}

template <class Draw>
void TerrainRenderer::inTurns(const gl::Pass& pass, std::span<const Tile> tiles, const Draw& draw) {
    const auto turn = static_cast<std::size_t>(terrain_->pages().capacity());
    for (std::size_t first = 0; first < tiles.size(); first += turn) {
        const auto some = tiles.subspan(first, std::min(turn, tiles.size() - first));
        const gl::Buffer records = tileRecords(some, terrain_->pages().load(some));
        gl::Resources resources = gl::Resources{{"Tiles", records}}
                                      .with(terrain_->resources())
                                      .with({gl::Resource("Counters", counters_).unordered()});
        if (settings_.colourMap) resources = resources.with({{"colourMap", *settings_.colourMap}});
        pass.use(resources);
        draw(some);
    }
}

template <class Draw>
void TerrainRenderer::drawInTurns(const gl::Pass& pass, std::span<const Tile> tiles,
                                  const Draw& draw) {
    counters_.clear();
    drawn_ = {};
    primitives_.begin();
    inTurns(pass, tiles, [&](std::span<const Tile> some) {
        const DrawCounts counts = draw(some);
        drawn_.patches += counts.patches;
        drawn_.drawCalls += counts.drawCalls;
        drawn_.tiles += static_cast<int>(some.size());
    });
    primitives_.end();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CULL_FACE);
}

DrawCounts TerrainRenderer::counts() const {
    DrawCounts counts = drawn_;
    counts.triangles = primitives_.result();
    counts.culledPatches = static_cast<int>(counters_.read<std::uint32_t>(1).front());
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
    kit::FlushedDraws draws(true, static_cast<std::uint32_t>(settings_.batches->triangles));
    for (const PatchBatch& batch : patches.batches) {
        glDrawElements(GL_PATCHES, static_cast<GLsizei>(4 * batch.count), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(4 * sizeof(std::uint32_t) * first));
        first += batch.count;
        draws.drawn(static_cast<std::uint32_t>(batch.triangles));
    }
    noAttributes_.bind();
    return static_cast<int>(patches.batches.size());
}

DrawCounts TerrainRenderer::drawPatches(std::span<const Tile> tiles, const kit::View& view,
                                        Parts parts) const {
    const int m = settings_.factors.tile.patchesPerTile;
    const bool hasSkirts = parts == Parts::Skirts || (parts == Parts::AsSet && settings_.hasSkirts);
    const int patchesPerTile = m * m + (hasSkirts ? 4 * m : 0);
    // Skirts end below the lowest sample, by more than depth's rounding.
    const float relief = terrain_->highestM() - terrain_->lowestM();
    const glm::vec2 spacing = terrain_->metadata().spacingM();
    const float foot = terrain_->lowestM() - std::max({0.01F * relief, spacing.x, spacing.y});
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
    for (const Tile& tile : tiles) {
        counts.patches +=
            patchesOnMap(tile, settings_.factors.tile, terrain_->metadata().sizeSamples());
    }
    return counts;
}

void TerrainRenderer::setTessellated(const kit::View& view) {
    setShading(tessellated_);
    setTerrain(tessellated_, *terrain_, view);
    setFactors(tessellated_, settings_, view);
    glPatchParameteri(GL_PATCH_VERTICES, 4);
}

void TerrainRenderer::drawTessellated(std::span<const Tile> tiles, const kit::View& view,
                                      const gl::Framebuffer& target) {
    target.bind();
    setTessellated(view);
    drawInTurns(tessellated_, tiles,
                [&](std::span<const Tile> some) { return drawPatches(some, view); });
}

/// Every triangle is culled. Not GL_RASTERIZER_DISCARD, with which llvmpipe counts no primitives.
void TerrainRenderer::bindNothing() const {
    nowhere_.bind();
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT_AND_BACK);
}

std::uint64_t TerrainRenderer::countSkirtTriangles(std::span<const Tile> tiles,
                                                   const kit::View& view) {
    setTessellated(view);
    bindNothing();
    drawInTurns(tessellated_, tiles,
                [&](std::span<const Tile> some) { return drawPatches(some, view, Parts::Skirts); });
    return primitives_.result();
}

std::vector<CapturedVertex> TerrainRenderer::capture(std::span<const Tile> tiles,
                                                     const kit::View& view) {
    GFXREPRO_ASSERT(settings_.capturesVertices);
    setTessellated(view);
    bindNothing();
    std::vector<CapturedVertex> vertices;
    const int side = settings_.factors.tile.patchesPerTile;
    inTurns(tessellated_, tiles, [&](std::span<const Tile> some) {
        primitives_.begin();
        drawPatches(some, view, Parts::Surface);
        primitives_.end();
        const std::size_t count = 3 * primitives_.result();
        if (count == 0) return;
        const gl::Buffer captured(count * sizeof(CapturedVertex));
        glTransformFeedbackBufferBase(0, 0, captured.id());
        glBeginTransformFeedback(GL_TRIANGLES);
        drawPatches(some, view, Parts::Surface);
        glEndTransformFeedback();
        glTransformFeedbackBufferBase(0, 0, 0);
        const auto first = static_cast<int>(some.data() - tiles.data());
        for (CapturedVertex vertex : captured.read<CapturedVertex>(count)) {
            vertex.patch += side * side * first;
            vertices.push_back(vertex);
        }
    });
    glDisable(GL_CULL_FACE);
    return vertices;
}

int TerrainRenderer::drawGridTile(const gl::Pass& pass, int index, const Tile& tile) const {
    pass.set("tileIndex", index);
    const int side =
        settings_.factors.tile.blocksPerTile() * terrain_->metadata().settings().blockSegments;
    // Cells with ground; an even count, as every other vertex may slide onto the one before.
    const int span = 1 << tile.level;
    const glm::ivec2 ground = terrain_->metadata().sizeSamples() - 1 - tile.originSample;
    const glm::ivec2 cells =
        glm::clamp((ground + 2 * span - 1) / (2 * span) * 2, glm::ivec2(0), glm::ivec2(side));
    kit::FlushedDraws flushed(settings_.batches.has_value());
    const std::uint32_t rows = flushed.mostPrimitives() / (2U * static_cast<std::uint32_t>(side));
    const int step = std::clamp(static_cast<int>(rows), 1, side);
    int draws = 0;
    for (int first = 0; first < cells.y; first += step, ++draws) {
        const int count = std::min(step, cells.y - first);
        pass.set("firstRow", first);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (cells.x + 1), count);
        flushed.drawn(static_cast<std::uint32_t>(2 * cells.x * count));
    }
    return draws;
}

void TerrainRenderer::drawGrid(std::span<const Tile> tiles, const kit::View& view,
                               const gl::Framebuffer& target, const MorphRanges* morph) {
    const gl::Pass& pass = morph ? morphed_ : grid_;
    target.bind();
    setShading(pass);
    setTerrain(pass, *terrain_, view);
    if (morph) pass.set("eye", view.eyeWorld);
    drawInTurns(pass, tiles, [&](std::span<const Tile> some) {
        DrawCounts counts;
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (morph) {
                const float range = morph->rangesM.at(static_cast<std::size_t>(some[i].level));
                pass.set("morphRange", glm::vec2(morph->startShare, 1.0F) * range);
            }
            counts.drawCalls += drawGridTile(pass, static_cast<int>(i), some[i]);
        }
        return counts;
    });
}

}  // namespace gfxrepro::terrain_tessellation
