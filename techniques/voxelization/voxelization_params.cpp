#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "techniques/voxelization/voxelization.h"

namespace gfxrepro::voxelization {
namespace {

constexpr Choice<InputKind> kInputs[] = {
    {InputKind::Mesh, "mesh", "the case's scene"},
    {InputKind::Implicit, "implicit", "a surface f(x, y, z) = 0 (section 2.4.1)"},
    {InputKind::Parametric, "parametric", "a surface (x, y, z)(u, v) (section 2.4.1)"},
};
constexpr Choice<Method> kMethods[] = {
    {Method::Worksheet, "worksheet", "rasterization, texelization and synthesis of worksheets"},
    {Method::Direct, "direct", "one pass with image atomics into the grid"},
    {Method::Slices, "slices", "the mesh is drawn once per slice (section 2.5.3)"},
    {Method::DepthOnly, "depth_only", "no grid: a depth-only draw, the yardstick of speed"},
};
constexpr Choice<Rule> kRules[] = {
    {Rule::Rasterized, "rasterized", "pixels that the hardware samples, as the thesis"},
    {Rule::Thin, "thin", "6-separating: no path over faces leaks through"},
    {Rule::Conservative, "conservative", "every voxel whose closed cube meets a triangle"},
};
constexpr Choice<Fill> kFills[] = {
    {Fill::Surface, "surface", "voxels of the surface"},
    {Fill::Solid, "solid", "voxels whose centre lies inside, by scan-line parity on three axes"},
};
constexpr Choice<FillRule> kFillRules[] = {
    {FillRule::Crossings, "crossings", "exact crossings of the surface; two of three axes decide"},
    {FillRule::SurfaceVoxels, "surface_voxels",
     "rasterized voxels of the surface, as the thesis: leaves streaks"},
};
constexpr Choice<VoxelValue> kValues[] = {
    {VoxelValue::Occupancy, "occupancy", "full or empty"},
    {VoxelValue::Normal, "normal", "octahedral normal"},
    {VoxelValue::Color, "color", "the vertices' or the material's colour"},
};
constexpr Choice<Split> kSplits[] = {
    {Split::Once, "once", "a static model: split at set-up"},
    {Split::EveryFrame, "every_frame", "a deforming model: split and uploaded every frame"},
};
constexpr Choice<OpenMesh> kOpenMeshes[] = {
    {OpenMesh::Refuse, "refuse", "an error with the number of ambiguous scan lines"},
    {OpenMesh::Report, "report", "filled by the majority of three axes, and counted"},
};
constexpr Choice<Merging> kMergings[] = {
    {Merging::PerVoxel, "per_voxel", "a fetch per voxel, as the thesis"},
    {Merging::Transposed, "transposed", "tiles of voxels, a fetch per texel"},
    {Merging::Sparse, "sparse",
     "as transposed, and only tiles that hold fragments; not for solids"},
};
constexpr Choice<Addressing> kAddressings[] = {
    {Addressing::Instructions, "instructions", "shifts and masks"},
    {Addressing::Tables, "tables", "look-up textures, as the thesis; with synthesis: per_voxel"},
};

/// An integer that is one of `allowed`.
template <std::size_t N>
int getOneOf(Params& params, std::string_view name, int fallback, const std::array<int, N>& allowed,
             const ParamSpec& spec) {
    const int value = params.getInt(name, fallback, spec);
    std::string list;
    for (int candidate : allowed) {
        if (candidate == value) return value;
        list += fmt::format("{}{}", list.empty() ? "" : ", ", candidate);
    }
    throw Error(params.locationOf(name),
                fmt::format("{}: {} is not allowed; allowed: {}", name, value, list));
}

std::optional<scene::Box> readBox(Params& params) {
    const auto low = params.getOptionalVector(
        "box_min", 3, {"lowest corner of the grid; with box_max", "scene units"});
    const auto high = params.getOptionalVector(
        "box_max", 3, {"highest corner of the grid, which must be cubic", "scene units"});
    if (!low && !high) return std::nullopt;
    if (!low || !high) {
        throw Error(params.locationOf(low ? "box_min" : "box_max"),
                    "box_min and box_max must be given together");
    }
    const auto vector = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    const glm::dvec3 size = vector(*high) - vector(*low);
    const double longest = std::max({size.x, size.y, size.z});
    const double shortest = std::min({size.x, size.y, size.z});
    // A millionth: what decimal fractions lose as floats.
    if (!(shortest > 0.0) || longest - shortest > 1e-6 * longest) {
        throw Error(params.locationOf("box_max"),
                    fmt::format("the box must be cubic and not empty; it is {:g} × {:g} × {:g}",
                                size.x, size.y, size.z));
    }
    const glm::vec3 minimum(vector(*low));
    return scene::Box{minimum, minimum + static_cast<float>(longest)};
}

/// Solids are decided along scan lines, in the worksheets, and say occupancy only.
void checkSolid(const Params& params, const MeshVoxelizerSettings& settings) {
    if (settings.grid.fill != Fill::Solid) {
        params.refuseGiven({"fill_rule"}, "'fill: solid'");
        return;
    }
    const bool isByCrossings = settings.fillRule == FillRule::Crossings;
    if (params.isGiven("rule") &&
        settings.rule != (isByCrossings ? Rule::Thin : Rule::Rasterized)) {
        throw Error(params.locationOf("rule"),
                    isByCrossings
                        ? "'fill: solid' decides by crossings of scan lines; leave 'rule' "
                          "out or give 'thin'"
                        : "'fill_rule: surface_voxels' flips at rasterized voxels; leave "
                          "'rule' out or give 'rasterized'");
    }
    if (!isByCrossings && settings.openMesh == OpenMesh::Refuse) {
        throw Error(
            params.locationOf("open_mesh"),
            "'open_mesh: refuse' needs 'fill_rule: crossings'; flags that flip at voxels end "
            "inside closed meshes, too");
    }
    if (settings.method != Method::Worksheet) {
        throw Error(params.locationOf("method"), "'fill: solid' needs 'method: worksheet'");
    }
    if (settings.grid.value != VoxelValue::Occupancy) {
        throw Error(params.locationOf("value"), "'fill: solid' needs 'value: occupancy'");
    }
}

/// How the stages of the worksheet method address voxels; every way makes the same grid.
void readStages(Params& params, MeshVoxelizerSettings& settings) {
    const bool isSolid = settings.grid.fill == Fill::Solid;
    settings.merging =
        params.getEnum("synthesis", isSolid ? Merging::Transposed : Merging::Sparse, kMergings,
                       {"how the sheets of x and y are read, for the same grid"});
    settings.addressing = params.getEnum("addressing", Addressing::Instructions, kAddressings,
                                         {"how texelization and synthesis find a voxel's bits"});
    if (settings.method != Method::Worksheet) {
        params.refuseGiven({"synthesis", "addressing"}, "'method: worksheet'");
    }
    if (isSolid && settings.merging == Merging::Sparse) {
        throw Error(params.locationOf("synthesis"),
                    "'synthesis: sparse' skips tiles without a surface, which solids fill; allowed "
                    "with 'fill: solid': per_voxel, transposed");
    }
    if (settings.addressing == Addressing::Instructions) return;
    if (settings.merging != Merging::PerVoxel) {
        throw Error(params.locationOf("addressing"),
                    "'addressing: tables' needs 'synthesis: per_voxel'");
    }
    if (settings.grid.layout.layers() > 1) {
        throw Error(params.locationOf("addressing"),
                    fmt::format("'addressing: tables' needs a grid of one worksheet; {}³ voxels of "
                                "{} bits take {}",
                                settings.grid.layout.resolution(), settings.grid.layout.voxelBits(),
                                settings.grid.layout.layers()));
    }
}

MeshVoxelizerSettings readVoxelizer(Params& params) {
    MeshVoxelizerSettings settings;
    const int resolution =
        getOneOf(params, "resolution", 256, std::array{32, 64, 128, 256, 512, 1024},
                 {"voxels along each axis, a power of two", "voxels", 32, 1024});
    const int voxelBits = getOneOf(params, "voxel_bits", 1, std::array{1, 8, 16, 32},
                                   {"bits of each voxel: 1, 8, 16 or 32", "bits", 1, 32});
    settings.grid.layout = WorksheetLayout(resolution, voxelBits);
    settings.grid.value = params.getEnum("value", VoxelValue::Occupancy, kValues,
                                         {"what a voxel says; more than occupancy needs 8 bits"});
    settings.grid.fill = params.getEnum("fill", Fill::Surface, kFills, {"which voxels are full"});
    settings.fillRule = params.getEnum("fill_rule", FillRule::Crossings, kFillRules,
                                       {"what flips the inside flag along a solid's scan lines"});
    settings.method = params.getEnum("method", Method::Worksheet, kMethods, {"what is measured"});
    const bool isRasterizedOnly =
        settings.method == Method::Slices || settings.method == Method::DepthOnly;
    settings.rule = params.getEnum("rule", isRasterizedOnly ? Rule::Rasterized : Rule::Thin, kRules,
                                   {"which voxels a triangle fills (surface)"});
    settings.split =
        params.getEnum("split", Split::Once, kSplits, {"when the index buffer is split by axis"});
    settings.openMesh = params.getEnum("open_mesh", OpenMesh::Report, kOpenMeshes,
                                       {"solids of meshes that are not closed"});
    if (settings.grid.value != VoxelValue::Occupancy && voxelBits == 1) {
        throw Error(params.locationOf("value"),
                    "a voxel of 1 bit says occupancy only; allowed with 'value: normal' and "
                    "'value: color': voxel_bits 8, 16 or 32");
    }
    if (isRasterizedOnly && settings.rule != Rule::Rasterized) {
        throw Error(params.locationOf("rule"),
                    "'method: slices' and 'method: depth_only' need 'rule: rasterized'");
    }
    checkSolid(params, settings);
    readStages(params, settings);
    return settings;
}

/// Formulas know neither triangles nor the ways to them.
void checkInput(const Params& params, const VoxelizationParams& read) {
    if (read.input == InputKind::Mesh) {
        if (read.voxelizer.method != Method::DepthOnly) return;
        for (const char* name : {"collision", "csg", "draw", "pictures"}) {
            if (!params.isGiven(name)) continue;
            throw Error(params.locationOf(name),
                        fmt::format("'method: depth_only' makes no grid for '{}'", name));
        }
        return;
    }
    params.refuseGiven(
        {"addressing", "collision", "compare", "csg", "fill_rule", "method", "offset_b",
         "open_mesh", "padding", "rule", "scene_b", "split", "synthesis"},
        "'input: mesh'");
    if (read.drawing.draw.mode == DrawMode::Mixed) {
        throw Error(params.locationOf("draw"), "'draw: mixed' needs 'input: mesh'");
    }
}

}  // namespace

VoxelizationParams::VoxelizationParams(Params& params)
    : input(params.getEnum("input", InputKind::Mesh, kInputs, {"what is voxelized"})),
      voxelizer(readVoxelizer(params)),
      combination(params),
      drawing(params, voxelizer.grid.value),
      paddingVoxels(params.getInt(
          "padding", 1, {"free voxels around the mesh where no box is given", "voxels", 0, 8})),
      box(readBox(params)),
      readsBack(params.getBool("read_back", false,
                               {"copy the worksheet to the CPU each frame, timed as read_back"})),
      comparesWithReference(params.getBool("compare", false,
                                           {"count what the rule misses, against the CPU "
                                            "references of thin and conservative"})),
      exportsBinvox(params.getBool("export_binvox", false, {"write grid.binvox"})),
      showsSlices(params.getBool("show_slices", false, {"save the three middle slices"})) {
    checkInput(params, *this);
}

}  // namespace gfxrepro::voxelization
