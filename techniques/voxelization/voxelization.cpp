#include "techniques/voxelization/voxelization.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "techniques/voxelization/combination.h"
#include "techniques/voxelization/formula_surface.h"
#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/mesh_voxelizer.h"
#include "techniques/voxelization/phantom.h"
#include "techniques/voxelization/reference.h"
#include "techniques/voxelization/volume_renderer.h"
#include "techniques/voxelization/voxel_files.h"

namespace gfxrepro::voxelization {
namespace {

/// What is voxelized.
enum class InputKind { Mesh, Implicit, Parametric };

constexpr Choice<InputKind> kInputs[] = {
    {InputKind::Mesh, "mesh", "the case's scene"},
    {InputKind::Implicit, "implicit", "a surface f(x, y, z) = 0 (section 2.4.1)"},
    {InputKind::Parametric, "parametric", "a surface (x, y, z)(u, v) (section 2.4.1)"},
};
// The largest texture that every device has.
constexpr int kMostVoxelsAlong = 16384;
// Where a fragment's voxel, or a pixel's, is a word.
constexpr int kMostVoxelsInWord = 1024;

constexpr Choice<Extent> kExtents[] = {
    {Extent::Cube, "cube", "as many voxels along each axis"},
    {Extent::Box, "box", "as many as the model, or the given box, takes along each"},
};
constexpr Choice<Method> kMethods[] = {
    {Method::Worksheet, "worksheet", "the thesis's: rasterization, texelization and synthesis"},
    {Method::Direct, "direct", "one pass with image atomics into the grid"},
    {Method::Slices, "slices", "the mesh is drawn once per slice (section 2.5.3)"},
    {Method::DepthOnly, "depth_only", "no grid: a depth-only draw, the yardstick of speed"},
};
constexpr Choice<Rule> kRules[] = {
    {Rule::Rasterized, "rasterized", "pixels that the hardware samples, as the thesis"},
    {Rule::Thin, "thin", "6-separating: no path over faces leaks through"},
    {Rule::Conservative, "conservative",
     "every voxel whose closed cube meets a triangle, and some that are within 1/256 voxel of one"},
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
    {VoxelValue::Normal, "normal",
     "octahedral normal: of exact rules the mean of the surface in the voxel, nearly by area, "
     "else the largest code of what fills it"},
};
constexpr Choice<Split> kSplits[] = {
    {Split::Once, "once", "a static model: split at set-up"},
    {Split::EveryFrame, "every_frame", "a deforming model: split and uploaded every frame"},
};
constexpr Choice<Addressing> kAddressings[] = {
    {Addressing::Instructions, "instructions", "shifts and masks"},
    {Addressing::Tables, "tables", "look-up textures, as the thesis"},
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

/// With Extent::Box of any shape.
std::optional<scene::Box> readBox(Params& params, Extent extent) {
    const auto low = params.getOptionalVector(
        "box_min", 3, {"lowest corner of the grid; with box_max", "scene units"});
    const auto high = params.getOptionalVector(
        "box_max", 3,
        {"highest corner of the grid, which is cubic but with 'grid: box'", "scene units"});
    if (!low && !high) return std::nullopt;
    if (!low || !high) {
        throw Error(params.locationOf(low ? "box_min" : "box_max"),
                    "box_min and box_max must be given together");
    }
    const auto vector = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    const glm::dvec3 size = vector(*high) - vector(*low);
    const double longest = std::max({size.x, size.y, size.z});
    const double shortest = std::min({size.x, size.y, size.z});
    const bool isCube = extent == Extent::Cube;
    // A millionth: what decimal fractions lose as floats.
    if (!(shortest > 0.0) || (isCube && longest - shortest > 1e-6 * longest)) {
        throw Error(params.locationOf("box_max"),
                    fmt::format("the box must {}not be empty; it is {:g} × {:g} × {:g}{}",
                                isCube ? "be cubic and " : "", size.x, size.y, size.z,
                                isCube ? "; allowed with 'grid: box': any other" : ""));
    }
    const glm::vec3 minimum(vector(*low));
    if (isCube) return scene::Box{minimum, minimum + static_cast<float>(longest)};
    return scene::Box{minimum, glm::vec3(vector(*high))};
}

/// Solids are decided along scan lines, and say occupancy only.
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
    if (settings.method != (isByCrossings ? Method::Direct : Method::Worksheet)) {
        throw Error(params.locationOf("method"),
                    isByCrossings ? "'fill_rule: crossings' needs 'method: direct'"
                                  : "'fill_rule: surface_voxels' needs 'method: worksheet'");
    }
    if (settings.grid.value != VoxelValue::Occupancy) {
        throw Error(params.locationOf("value"), "'fill: solid' needs 'value: occupancy'");
    }
}

/// How the worksheet method and drawing address voxels; either way makes the same grid.
void readAddressing(Params& params, MeshVoxelizerSettings& settings) {
    settings.addressing =
        params.getEnum("addressing", Addressing::Instructions, kAddressings,
                       {"how texelization, synthesis and drawing find a voxel's bits"});
    if (settings.method != Method::Worksheet) {
        params.refuseGiven({"addressing"}, "'method: worksheet'");
    }
    if (settings.addressing == Addressing::Tables && settings.grid.layout.layers() > 1) {
        throw Error(params.locationOf("addressing"),
                    fmt::format("'addressing: tables' needs a grid of one worksheet; {} voxels of "
                                "{} bits take {}",
                                settings.grid.layout.shape().text(),
                                settings.grid.layout.voxelBits(), settings.grid.layout.layers()));
    }
}

MeshVoxelizerSettings readVoxelizer(Params& params) {
    MeshVoxelizerSettings settings;
    const int resolution = params.getInt(
        "resolution", 256, {"voxels along the grid's longest side", "voxels", 1, kMostVoxelsAlong});
    settings.grid.extent = params.getEnum("grid", Extent::Cube, kExtents, {"the grid's shape"});
    const int voxelBits = getOneOf(params, "voxel_bits", 1, std::array{1, 8, 16, 32},
                                   {"bits of each voxel: 1, 8, 16 or 32", "bits", 1, 32});
    settings.grid.layout = WorksheetLayout(resolution, voxelBits);
    settings.grid.value = params.getEnum("value", VoxelValue::Occupancy, kValues,
                                         {"what a voxel says; more than occupancy needs 8 bits"});
    settings.grid.fill = params.getEnum("fill", Fill::Surface, kFills, {"which voxels are full"});
    settings.fillRule = params.getEnum("fill_rule", FillRule::Crossings, kFillRules,
                                       {"what flips the inside flag along a solid's scan lines"});
    const bool isFlipped =
        settings.grid.fill == Fill::Solid && settings.fillRule == FillRule::SurfaceVoxels;
    settings.method = params.getEnum("method", isFlipped ? Method::Worksheet : Method::Direct,
                                     kMethods, {"what is measured"});
    settings.rule =
        params.getEnum("rule", settings.method == Method::Direct ? Rule::Thin : Rule::Rasterized,
                       kRules, {"which voxels a triangle fills (surface)"});
    settings.split =
        params.getEnum("split", Split::Once, kSplits, {"when the index buffer is split by axis"});
    if (settings.grid.value != VoxelValue::Occupancy && voxelBits == 1) {
        throw Error(
            params.locationOf("value"),
            "a voxel of 1 bit says occupancy only; allowed with 'value: normal': voxel_bits "
            "8, 16 or 32");
    }
    checkSolid(params, settings);
    if (settings.method != Method::Direct && settings.rule != Rule::Rasterized) {
        throw Error(params.locationOf("rule"),
                    "'rule: thin' and 'rule: conservative' need 'method: direct'");
    }
    if (settings.method == Method::Worksheet && resolution > kMostVoxelsInWord) {
        throw Error(params.locationOf("resolution"),
                    fmt::format("resolution: {} is not allowed with 'method: worksheet'; allowed: "
                                "at most {}",
                                resolution, kMostVoxelsInWord));
    }
    readAddressing(params, settings);
    return settings;
}

/// Everything that a config may say of the grid and of the way to it.
struct VoxelizationParams {
    InputKind input = InputKind::Mesh;
    MeshVoxelizerSettings voxelizer;
    CombinationSettings combination;
    DrawingSettings drawing;
    int paddingVoxels = 1;
    std::optional<scene::Box> box;  // of the grid's shape; empty: around the mesh
    bool readsBack = false;
    bool comparesWithReference = false;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit VoxelizationParams(Params& params)
        : input(params.getEnum("input", InputKind::Mesh, kInputs, {"what is voxelized"})),
          voxelizer(readVoxelizer(params)),
          combination(params),
          drawing(params, voxelizer.grid.value),
          paddingVoxels(params.getInt(
              "padding", 1, {"free voxels around the mesh where no box is given", "voxels", 0, 8})),
          box(readBox(params, voxelizer.grid.extent)),
          readsBack(
              params.getBool("read_back", false,
                             {"copy the worksheet to the CPU each frame, timed as read_back"})),
          comparesWithReference(params.getBool("compare", false,
                                               {"count what the rule misses, against the CPU "
                                                "references of thin and conservative"})) {
        checkInput(params);
        drawing.draw.looksUpBits = voxelizer.addressing == Addressing::Tables;
        checkResolution(params);
        if (!box) return;
        voxelizer.grid.fitTo(*box, 0);
        // Whole voxels: the highest corner moves up to them.
        const GridShape& shape = voxelizer.grid.layout.shape();
        if (voxelizer.grid.extent == Extent::Box) {
            box->max = box->min + voxelSizeOf(*box, shape) * glm::vec3(shape.size);
        }
    }

    void checkResolution(const Params& params) const {
        const int resolution = voxelizer.grid.layout.shape().longest();
        if (drawing.isOn() && resolution > kMostVoxelsInWord) {
            throw Error(params.locationOf("resolution"),
                        fmt::format("resolution: {} is not allowed with a picture; allowed: at "
                                    "most {}",
                                    resolution, kMostVoxelsInWord));
        }
        if (!box && 2 * paddingVoxels >= resolution) {
            throw Error(params.locationOf("resolution"),
                        fmt::format("resolution: {} is not allowed with 'padding: {}'; allowed: at "
                                    "least {}",
                                    resolution, paddingVoxels, 2 * paddingVoxels + 1));
        }
        if (drawing.draw.mode == DrawMode::Mixed && voxelizer.grid.extent == Extent::Box) {
            throw Error(params.locationOf("grid"), "'draw: mixed' needs 'grid: cube'");
        }
    }

    /// Formulas know neither triangles nor the ways to them.
    void checkInput(const Params& params) const {
        if (input == InputKind::Mesh) {
            if (voxelizer.method != Method::DepthOnly) return;
            for (const char* name : {"collision", "csg", "draw", "pictures"}) {
                if (!params.isGiven(name)) continue;
                throw Error(params.locationOf(name),
                            fmt::format("'method: depth_only' makes no grid for '{}'", name));
            }
            return;
        }
        params.refuseGiven({"addressing", "collision", "compare", "csg", "fill_rule", "method",
                            "offset_b", "padding", "rule", "scene_b", "split"},
                           "'input: mesh'");
        if (drawing.draw.mode == DrawMode::Mixed) {
            throw Error(params.locationOf("draw"), "'draw: mixed' needs 'input: mesh'");
        }
    }
};

/// Formulas are read with the parameters; a mesh comes at set-up, with the scene.
std::unique_ptr<GridSource> makeFormulaSource(const VoxelizationParams& read, Params& params) {
    switch (read.input) {
        case InputKind::Implicit:
            return std::make_unique<ImplicitSource>(params, read.voxelizer.grid, read.box);
        case InputKind::Parametric:
            return std::make_unique<ParametricSource>(params, read.voxelizer.grid, read.box);
        case InputKind::Mesh:
            break;
    }
    return nullptr;
}

/// Voxels that are full in either grid of one layout.
DenseGrid together(const DenseGrid& a, const DenseGrid& b) {
    std::vector<std::uint32_t> words(a.words().begin(), a.words().end());
    for (std::size_t i = 0; i < words.size(); ++i) words[i] |= b.words()[i];
    return {a.layout(), std::move(words)};
}

/// A number that differs (but for chance, 1 in 2⁴⁸) when any word differs.
double digestOf(std::span<const std::uint32_t> words) {
    // FNV-1a over words, folded to 48 bits: exact as a double.
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (std::uint32_t word : words) hash = (hash ^ word) * 0x100000001B3ULL;
    return static_cast<double>((hash ^ (hash >> 48)) & 0xFFFFFFFFFFFFULL);
}

class Voxelization final : public technique::Technique {
  public:
    explicit Voxelization(Params& params)
        : params_(params),
          source_(makeFormulaSource(params_, params)),
          combination_(params_.combination),
          drawing_(params_.drawing) {
        params.finish();
        if (!source_) return;  // formulas have no scene
        try {
            requireView({}, params_.box.value_or(source_->grid()->box));
        } catch (const Error& error) {
            throw Error(params.locationOf("view"), error.what());
        }
    }

    void setup(technique::SetupContext& context) override {
        if (params_.input == InputKind::Mesh) {
            setupMesh(context);
            return;
        }
        source_->setup(context);
        const VoxelGrid& grid = *source_->grid();
        box_ = grid.box;
        if (params_.drawing.isOn()) drawing_.setup(context, {}, grid.layout, box_, box_, false);
    }

    technique::SceneNeed sceneNeed() const override {
        return params_.input == InputKind::Mesh ? technique::SceneNeed::Model
                                                : technique::SceneNeed::Nothing;
    }
    void requireScene(const scene::Scene& scene) const override {
        if (params_.input != InputKind::Mesh) return;
        requireVoxelizable(scene);
        // A second model may move the grid about both of them.
        const scene::Box bounds = scene.bounds();
        requireView(scene, params_.combination.needsSecond()
                               ? bounds
                               : boxAround(bounds, settingsFor(bounds).grid.layout.shape()));
    }

    void render(technique::FrameContext& context) override {
        source_->render(context.profiler);
        if (params_.combination.needsSecond()) {
            combination_.render(context.profiler, *source_->grid());
        }
        if (!grid()) return;
        if (params_.readsBack) {
            gl::CpuScope scope(context.profiler, "read_back");
            readSheets(grid()->sheets);
        }
        if (params_.drawing.isPass()) draw(context.profiler);
    }

    void record(technique::Recorder& recorder) override {
        const auto count = [&](const char* name, std::size_t value) {
            recorder.metric(name, static_cast<double>(value));
        };
        if (input_) {
            count("triangles", input_->mesh().triangles.size());
            count("vertices", input_->mesh().positions.size());
        }
        source_->record(recorder);
        combination_.record(recorder);
        if (!grid()) return;
        recordGrid(recorder, grid()->read());
    }

    std::string pictureDigest() const override {
        return grid() ? std::to_string(digestOf(grid()->read().words())) : "";
    }

    void recordOnce(technique::Recorder& recorder) override {
        if (!grid()) return;
        if (params_.comparesWithReference) recordMisses(recorder, grid()->read());
        if (!params_.drawing.isOn()) return;
        if (params_.drawing.isBeside) {
            gl::Profiler unread(false);
            draw(unread);
        }
        drawing_.record(recorder);
    }

    void requireFile(const std::filesystem::path& path) const override {
        requireVoxelFile(path, params_.voxelizer.grid.layout.shape().longest());
    }

    std::vector<std::string> writeFile(const std::filesystem::path& path) override {
        const VoxelModel model = voxelModelOf(grid()->read(), box_, *scene_);
        std::vector<std::string> lines;
        if (const std::uint32_t open = source_->openScanLines(); open > 0) {
            lines.push_back(
                fmt::format("warning    {} scan lines end inside the model, as its mesh is not "
                            "closed: solid is what two axes of three call so",
                            open));
        }
        lines.push_back(fmt::format("voxels     {} of {}, {:g} wide", model.voxels.size(),
                                    model.shape.text(), model.voxelSize));
        for (const std::filesystem::path& written : writeVoxels(path, model)) {
            lines.push_back("written    " + written.string());
        }
        return lines;
    }

  private:
    /// That there is one, outside of the grid.
    void requireView(const scene::Scene& scene, const scene::Box& grid) const {
        cameraOf(params_.drawing.view, scene, grid, grid, 1.0F);
    }

    /// Of a grid around a model.
    MeshVoxelizerSettings settingsFor(const scene::Box& bounds) const {
        MeshVoxelizerSettings settings = params_.voxelizer;
        if (!params_.box) settings.grid.fitTo(bounds, params_.paddingVoxels);
        return settings;
    }
    scene::Box boxAround(const scene::Box& bounds, const GridShape& shape) const {
        if (params_.box) return *params_.box;
        if (params_.drawing.draw.mode == DrawMode::Mixed) return headBoxAround(bounds);
        return gridBox(bounds, shape, params_.paddingVoxels);
    }

    void setupMesh(technique::SetupContext& context) {
        scene_ = context.scene;
        input_.emplace(*scene_);
        scene::Box bounds = input_->mesh().bounds();
        if (params_.combination.needsSecond()) {
            bounds.add(combination_.loadSecond(context, bounds));
        }
        const MeshVoxelizerSettings settings = settingsFor(bounds);
        const WorksheetLayout& layout = settings.grid.layout;
        checkFitsDevice(layout, context.device.limits());
        box_ = boxAround(bounds, layout.shape());
        source_ = std::make_unique<MeshVoxelizer>(settings, input_->mesh(), box_);
        source_->setup(context);
        if (params_.combination.needsSecond()) combination_.setup(context, settings, box_);
        if (params_.drawing.isOn()) {
            const bool showsBoth =
                params_.combination.findsCollision && !params_.combination.csg.has_value();
            const bool isInHead = params_.drawing.draw.mode == DrawMode::Mixed;
            const scene::Box shown = isInHead      ? headBounds(box_)
                                     : params_.box ? *params_.box
                                                   : bounds;
            drawing_.setup(context, *scene_, layout, box_, shown, showsBoth);
        }
    }

    const VoxelGrid* grid() const {
        return combination_.result() ? combination_.result() : source_->grid();
    }

    void draw(gl::Profiler& profiler) {
        const bool showsBoth = params_.combination.findsCollision && !combination_.result();
        drawing_.render(profiler, *grid(), showsBoth ? &combination_.second() : nullptr);
    }

    static void recordGrid(technique::Recorder& recorder, const DenseGrid& grid) {
        const WorksheetLayout& layout = grid.layout();
        recorder.metric("voxels", static_cast<double>(grid.countFull()));
        recorder.metric("grid_voxels", static_cast<double>(grid.shape().voxelCount()));
        recorder.metric("voxel_bits", layout.voxelBits());
        recorder.metric("worksheet_bytes", static_cast<double>(layout.sizeBytes()));
        recorder.metric("digest", digestOf(grid.words()));
    }

    /// `stray_voxels` (fill_rule: surface_voxels) neither lie inside nor touch the surface.
    void recordMisses(technique::Recorder& recorder, const DenseGrid& grid) const {
        const GridShape& shape = grid.shape();
        const LatticeMesh mesh = snapped(input_->mesh(), box_, shape);
        const auto count = [&](const char* name, const DenseGrid& a, const DenseGrid& b) {
            recorder.metric(name, static_cast<double>(reference::countMissing(a, b)));
        };
        if (params_.voxelizer.grid.fill == Fill::Solid) {
            const DenseGrid expected = reference::solid(mesh, shape).grid;
            count("missed_solid_voxels", expected, grid);
            count("added_solid_voxels", grid, expected);
            if (params_.voxelizer.fillRule == FillRule::SurfaceVoxels) {
                count("stray_voxels", grid,
                      together(expected, reference::conservative(mesh, shape)));
                recorder.metric("odd_scan_lines",
                                static_cast<double>(reference::countOddScanLines(mesh, shape)));
            }
            return;
        }
        count("missed_thin_voxels", reference::thin(mesh, shape), grid);
        count("missed_dominant_voxels", reference::thinAlongDominantAxes(mesh, shape), grid);
        const DenseGrid conservative = reference::conservative(mesh, shape);
        count("missed_conservative_voxels", conservative, grid);
        count("added_conservative_voxels", grid, conservative);
    }

    VoxelizationParams params_;
    const scene::Scene* scene_ = nullptr;  // of a mesh
    std::optional<MeshInput> input_;
    scene::Box box_;
    std::unique_ptr<GridSource> source_;
    Combination combination_;
    Drawing drawing_;
};

config::Outputs outputs() {
    using config::Better;
    const auto detail = [](const char* name, const char* unit, const char* doc,
                           Better better = Better::Neither) {
        return config::MetricInfo{name, unit, doc, better, true};
    };
    return {
        {
            {"voxels", "voxel", "full voxels of the grid"},
            {"grid_voxels", "voxel", "all voxels of the grid, full and empty"},
            {"triangles", "triangle", "triangles of the mesh"},
            {"vertices", "vertex", "vertices of the mesh"},
            {"fragments", "fragment",
             "fragments that the triangles were rasterized to, over the three axes"},
            {"memory_bytes", "byte", "memory of mesh, fragments and worksheets on the device",
             Better::Lower},
            detail("worksheet_bytes", "byte", "size of a worksheet"),
            detail("voxel_bits", "bit", "bits of a voxel"),
            detail("digest", "1", "hash of all voxels: equal for equal grids"),
            {"ambiguous_scan_lines", "scan line",
             "scan lines that end inside the model, because its mesh is not closed", Better::Lower},
            {"odd_scan_lines", "scan line",
             "scan lines that would end inside the model by exact arithmetic, too, as an odd "
             "number of their voxels is on the surface",
             Better::Lower},
            {"disagreeing_voxels", "voxel",
             "voxels that one axis finds inside the model and another outside", Better::Lower},
            {"missed_solid_voxels", "voxel", "voxels of the exact solid that the grid lacks",
             Better::Lower},
            {"added_solid_voxels", "voxel", "voxels of the grid that are not in the exact solid",
             Better::Lower},
            {"stray_voxels", "voxel",
             "voxels of the grid that are neither in the solid nor on the surface", Better::Lower},
            {"missed_thin_voxels", "voxel", "voxels of the exact thin surface that the grid lacks",
             Better::Lower},
            {"missed_dominant_voxels", "voxel",
             "of these, voxels that a line along a triangle's dominant axis crosses",
             Better::Lower},
            {"missed_conservative_voxels", "voxel",
             "voxels of the exact conservative surface that the grid lacks", Better::Lower},
            {"added_conservative_voxels", "voxel",
             "voxels of the grid that are not of the exact conservative surface", Better::Lower},
            detail("planes", "plane",
                   "planes of voxels that were blended or searched for the picture"),
            {"samples", "sample", "samples of a parametric surface"},
            {"collision_voxels", "voxel", "voxels that both solids fill"},
        },
        {
            {"preprocess", "sorting triangles by their main axis", true},
            {"voxelization", "the whole method, without drawing"},
            {"rasterization", "turning triangles into fragments"},
            {"texelization", "writing fragments into the worksheets of the three axes"},
            {"fill", "filling solids along scan lines"},
            {"synthesis", "joining the three worksheets into one"},
            {"implicit", "voxelizing an implicit surface by its formula"},
            {"parametric", "voxelizing a parametric surface by its samples"},
            {"csg", "union, intersection or difference of two grids"},
            {"collision", "finding the voxels that two grids share"},
            {"read_back", "copying the grid to the host"},
            {"draw", "drawing the grid"},
            {"draw_depth", "drawing depth images alone, the baseline"},
        }};
}

constexpr std::string_view kFileOptions[] = {"resolution", "fill"};
constexpr std::pair<std::string_view, std::string_view> kFileValues[] = {{"grid", "box"}};
constexpr technique::FileCommand kVoxelize = {
    .name = "voxelize",
    .doc = "write a model as voxels, with normals and colours",
    .files = ".npy, .vox or .binvox",
    .example = "gfxrepro voxelize models/bunny --resolution 300 --out bunny.npy",
    .options = kFileOptions,
    .fixed = kFileValues};

}  // namespace

const technique::TechniqueInfo kVoxelization = {
    .name = "voxelization",
    .summary = "real-time voxelization of triangle meshes with worksheets (zju2005, chapter 2)",
    .create = technique::make<Voxelization>,
    .outputs = outputs,
    .fileCommand = &kVoxelize};

}  // namespace gfxrepro::voxelization
