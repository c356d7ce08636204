// A config file: one published table (or figure, or section), what is measured for it, and what
// must follow.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/key_info.h"
#include "engine/core/node.h"
#include "runner/claims/kinds/claim.h"
#include "runner/config/case.h"
#include "runner/config/outputs.h"

namespace gfxrepro::config {

/// What a config has beside its name.
struct ContentKeys {
    GivenKey title, technique, program, scene, sceneSeeds, sceneParams, sceneInstead, params,
        paramsByScene, paramsInstead, output, sweep, measure, shows, labels, layout, printed,
        claims, plots, fit, assumptions;
};
ContentKeys contentOf(const Node& document);
/// What its `measure` has.
struct MeasureKeys {
    GivenKey lane, repeats, processes, timeBudgetS, timeLimitS;
};
MeasureKeys measureOf(const Node& document);
/// What its `output` has.
struct OutputKeys {
    GivenKey width, height, frames;
};
OutputKeys outputOf(const Node& document);

/// One point of a sweep: axis name → value, in the order of the axes.
using AxisPoint = Node::Map;

/// The `sweep:` map. Each key is an axis: `scene`, `output.width`, or a technique's parameter.
///
///     sweep:
///       scene: [models/duck, models/bunny]   # a list; axes multiply in the order of the file
///       delta_s: {range: [1, 10]}            # 1, 2, …, 10; a third number is the step
///       resolution: {log2: [64, 512]}        # 64, 128, 256, 512
///       zip:                                 # each block: axes that go together
///         - {tile: [64, 128], voxel_bits: [8, 16]}
///       list:                                # each block: points spelt out; keys may differ
///         - [{method: slices}, {method: worksheet, packed: true}]
///       exclude: [{scene: models/duck, resolution: 512}]  # points that match all pairs
///       when: {slices: {method: slices}}     # elsewhere axis `slices` is left out of the point
///
/// A pair's value may be a list: any of these. Points made equal by `when` are one. Throws Error at
/// the place of what is wrong, and for more than 1,000,000 points.
std::vector<AxisPoint> expandSweep(const Node& sweep);

/// Axes that go together with this one: of the same block of `zip`, or of points spelt out.
std::set<std::string> axesBeside(const Node& sweep, std::string_view axis);

/// Its `when`; null where it has none.
const Node* whenOf(const Node& sweep);
/// Leaves out the axes whose condition in `when` is false. That may make further conditions false.
void applyWhen(const Node& when, AxisPoint& point);

/// Where another metric, a time or an error, has this value between the cases that a cell takes.
struct Equal {
    std::string metric;  // of the whole case
    double is = 0.0;
};

/// How a cell is written where no part of its layout says.
inline constexpr const char* kDefaultCellFormat = "{median:.4g}";

/// What a cell shows: chosen records and their summary. Row axes, column axes and `cell` each give
/// a part; the column's part wins over the row's, the row's over `cell`.
struct Selection {
    std::optional<std::string> metric;
    std::optional<std::string> pass;
    std::optional<std::string>
        format;                     // "{median:.2f}", "{mean:.2f}/{max:.0f}": statistics in braces
    std::optional<double> scale;    // multiplies every value
    std::optional<std::string> of;  // of a column: an expression over the columns before it
    std::optional<Equal> equal;
    Node::Map where;  // axis = value
    SourceLocation location;
};

/// An axis of the layout: a sweep axis by its values, or labels with selections (`axes:`, `columns:
/// {…}`).
struct LayoutAxis {
    std::string name;
    std::vector<std::pair<std::string, Selection>> labels;  // empty: a sweep axis
    bool isSweepAxis() const { return labels.empty(); }
};

/// `layout:` — rows, columns and what a cell shows.
struct Layout {
    std::vector<LayoutAxis> rows;
    std::vector<LayoutAxis> columns;
    Selection cell;
    bool isGiven = false;

    /// The selection of a column that is computed of others; null of one that is measured.
    const Selection* computed(std::string_view column) const;
};

/// `printed:` — what the paper printed. Never reaches a worker.
struct Printed {
    std::string hardware;
    std::string remark;
    /// A header of row-axis and column names, then a line a row; a cell is written as the cell's
    /// format writes it; empty where lost.
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
    /// What the paper measured at where the profile `paper` departs from it: a parameter,
    /// `output.width`, `output.height`, `output.frames` or `scene`, with the printed value.
    Node::Map at;
    /// Scenes of ours that could not be fitted to what is printed: they judge nothing of the paper.
    std::vector<std::string> unfit;
    /// Methods that the paper compares with a usual one.
    std::vector<std::string> compared;
    /// Cells for which an input was fitted: {row axis or `column`: value or values}, all of these.
    std::vector<Node> calibrated;
    SourceLocation location;
};

/// Of row axes, these values: which rows are read.
using RowFilter = std::vector<std::pair<std::string, std::vector<Node>>>;

using claims::ClaimSpec;
using claims::kColumnAxis;
/// "document", "derived", …: the names in configs.
std::string_view originName(ClaimSpec::Origin origin);
std::string_view boundSourceName(ClaimSpec::BoundSource source);
std::string_view timeKindName(ClaimSpec::TimeKind kind);

/// An entry of `plots:` — curves of the table's numbers. Every row axis has its place: it is `x`,
/// `by`, in `panels`, at one value by `at`, or, where `x` is a column, along the curve.
struct PlotSpec {
    std::string title;                // empty: the experiment's
    std::string x;                    // a row axis of numbers, or a column
    std::vector<std::string> y;       // columns: a curve each
    std::optional<std::string> by;    // a row axis: of each y a curve a value
    std::vector<std::string> panels;  // row axes: a panel for each combination of values
    RowFilter at;
    bool isLogX = false;
    bool isLogY = false;
    std::optional<double> slope = {};  // exponent of x that is expected: both axes are logarithmic
    SourceLocation location;
};

/// The assumptions that are bound to what a case has beside its parameters.
inline constexpr const char* kOutputAssumption = "output";
inline constexpr const char* kSceneAssumption = "scene";
inline constexpr const char* kSceneSeedAssumption = "scene_seed";
inline constexpr const char* kFramesAssumption = "output.frames";

/// Keys of an experiment that overrides set, and scenes stand in.
inline constexpr const char* kParamsByScene = "params_by_scene";
inline constexpr const char* kParamsInstead = "params_instead";
inline constexpr const char* kSceneInstead = "scene_instead";

/// `assumptions:` — what the paper left open. One that names a parameter of the technique,
/// `output`, `scene`, `scene_seed` or `output.frames` is bound to it: value and unit are those of
/// the cases.
struct Assumption {
    std::string name;
    Node value;  // bound: filled in when the cases are resolved
    Node range;
    std::string unit;
    std::string why;
    bool isBound = false;
    SourceLocation location = {};  // of the name
};

enum class ExperimentKind { Table, Figure, Section, Sweep };

struct Experiment {
    ExperimentKind kind = ExperimentKind::Table;
    std::string id;  // "zju2005/2.1": paper and number; "zju2005/figure-2.6"; "sweep/bias"
    std::string title;
    std::filesystem::path file;
    std::string technique;
    Node params;         // a map, before the sweep is laid over it
    Node paramsInstead;  // a map: in cases that take them, instead of values and defaults
    Node paramsByScene =
        Node::map({});  // a map: scene → a map, laid over `params` in the cases of that scene
    Node scene;         // null, or a reference
    Node sceneParams = Node::map({});   // a map: of the generated scenes, laid over the catalogue's
    Node sceneInstead = Node::map({});  // a map: catalogued scene → the one that takes its place
    int outputWidthPx = kDefaultOutputPx;
    int outputHeightPx = kDefaultOutputPx;
    Node sweep;
    Measure measure;
    std::map<std::string, std::string> labels;  // what people read for a name
    std::vector<std::string> shows;  // names of the pictures that the document shows; or empty
    Layout layout;
    Printed printed;
    std::vector<ClaimSpec> claims;
    std::vector<PlotSpec> plots;
    std::vector<Assumption> assumptions;
    std::vector<std::string> profiles;  // those that the file declares
    Node document;                      // merged and profile applied, as it stands before expansion
    /// Likewise with the profile `paper` and without overrides. Null where there is nothing to
    /// compare with print: in a sweep that prints nothing, and without a technique.
    Node paperDocument;
    std::vector<Case> paperCases;  // its cases, every parameter resolved; a plan fills them in
    Outputs outputs;  // what its cases record, where it has no layout; a plan fills it in

    /// Whether its table is made of what was recorded: an experiment of one's own without a layout.
    bool hasDefaultLayout() const;
    /// Whether what is measured stands for something published: all but sweeps without `printed`.
    bool isPublished() const;

    /// "zju2005-2.1": for file names.
    std::string slug() const;
    /// "Table 2.1", "Figure 2.6", "Section 2.5.3".
    std::string label() const;
};

/// What an experiment whose numbers were measured elsewhere has in place of a technique.
inline constexpr const char* kImported = "imported";

/// Whether this program measures it: it is neither only printed nor imported.
inline bool isMeasuredHere(const Experiment& experiment) {
    return !experiment.technique.empty() && experiment.technique != kImported;
}

/// Whether a program of its own measures it, or it was measured elsewhere. Such times are those of
/// the clock: CPU time tells nothing of what waits.
bool goesByClock(const Experiment& experiment);

/// Throws the Error of a claim that reads times where the lane takes none.
[[noreturn]] void refuseTimes(const Experiment& experiment, const ClaimSpec& claim);
/// Whether its lane is not of its own file, but of what it extends or of --set: its claims on times
/// are not meant then.
bool isLaneGivenBeside(const Experiment& experiment);

/// Begins the place of what was given there.
inline constexpr const char* kCommandLine = "command line, ";

/// `key=value` from the command line; the value is YAML. Keys without a section (`resolution=64`)
/// mean params.
struct Override {
    std::string key;
    Node value;
};
Override parseOverride(const std::string& text);

struct ExperimentOptions {
    std::string profile = "full";  // quick | full | paper; `full` is the file as it stands
    std::vector<Override> sets;    // --set
    std::vector<Override>
        sweeps;  // --sweep: replaces or adds an axis; the value is a comma list or axis
};

/// Reads, merges `extends` (relative to configs/, then to the file; in order, later wins; cycles
/// are an Error), applies the profile and the overrides, and checks every key. Throws Error with
/// file:line:column.
Experiment loadExperiment(const std::filesystem::path& file, const ExperimentOptions& options,
                          const std::filesystem::path& configsFolder);

/// The file with all that it extends, as one document of the same plans, what it is called first;
/// files that it names have absolute paths.
Node wholeDocument(const std::filesystem::path& file, const std::filesystem::path& configsFolder);

/// The experiment of a `document` that loadExperiment made (perhaps stored in a plan as JSON in
/// between); `file` is where it came from. Names that the profile took out of the sweep may still
/// be printed and claimed.
Experiment experimentFromDocument(const Node& document, const std::filesystem::path& file);

/// The cases of an experiment, in the order of the sweep, before a technique's defaults are filled
/// in: `params` has what the config says of the generated scene alone, and ids are empty.
std::vector<Case> expandCases(const Experiment& experiment);

}  // namespace gfxrepro::config
