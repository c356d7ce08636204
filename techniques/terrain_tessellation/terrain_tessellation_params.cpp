#include <fmt/format.h>

#include "techniques/terrain_tessellation/terrain_tessellation.h"

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
constexpr Choice<HeightFormat> kHeightFormats[] = {
    {HeightFormat::Float32, "float32", "exact"},
    {HeightFormat::Unorm16, "unorm16", "half the memory, 65,536 steps"},
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
    finestRangeM = static_cast<float>(params.getDouble(
        "finest_range", 0.0,
        {"to where cdlod draws every sample; 0: to where a cell is delta_s wide", "m", 0.0, 1e9}));
    heights.format = params.getEnum("height_format", HeightFormat::Float32, kHeightFormats,
                                    {"of the tiles' height textures"});
    heights.budgetBytes = static_cast<std::size_t>(
        params.getDouble("height_memory_mib", 256.0,
                         {"for the heights of tiles on the device; tiles are loaded when they come "
                          "into view, in the place of those longest out of it",
                          "MiB", 0.001, 65536.0}) *
        (1 << 20));
    view = params.getText(
        "view", "valley",
        {"a camera or path of the scene, or overview, valley, steep or round_flight"});
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
    if (method == Method::Cdlod) {
        params.refuseGiven({"tau"}, "another method");
    } else {
        params.refuseGiven({"finest_range"}, "'method: cdlod'");
    }
    if (!measuresErrors && !showsPictures) {
        params.refuseGiven({"supersampling"}, "'errors: true' or 'pictures: true'");
    }
}

}  // namespace gfxrepro::terrain_tessellation
