// The sections of a config, one reader each; private to this module.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/checks.h"
#include "engine/core/key_schema.h"
#include "engine/core/node.h"
#include "runner/config/experiment.h"

namespace gfxrepro::config {

using Names = std::vector<std::string>;

/// What a value may be multiplied by.
inline constexpr NumberRange kScales{.least = 0, .isLeastExcluded = true};

template <class Range, class Value>
bool contains(const Range& range, const Value& value) {
    return std::ranges::find(range, value) != std::ranges::end(range);
}

/// What the other sections may refer to.
struct Vocabulary {
    /// Every axis that a case has: swept ones, fixed parameters, `scene`; with its values in order.
    std::map<std::string, Node::Sequence> axes;
    /// The file as it stands: values and columns that it does not have are mistakes. Not so under
    /// a profile or overrides, which make the sweep smaller.
    bool isComplete = true;

    Names axisNames() const;
};

Layout readLayout(const Node& node, const Vocabulary& vocabulary);
/// Whether some cell shows a time, or what is at one.
bool showsTimes(const Layout& layout);

/// The names of the row axes and of the columns (several column axes are joined by "_"), against
/// which printed values and claims are checked.
struct TableNames {
    Names rowAxes;
    std::map<std::string, std::vector<Node>> rowValues;  // of those row axes whose values are known
    Names columns;
    bool hasAllColumns = true;  // false: further columns may exist
};
TableNames tableNames(const Layout& layout, const Vocabulary& vocabulary);

/// `layout` and `names` are null for a table that is only printed: then any header will do.
Printed readPrinted(const Node& node, const Layout* layout, const TableNames* names);

/// `isOfDocument`: of a document's table, whose claims are its own and bounds ours, unless they say
/// otherwise.
std::vector<ClaimSpec> readClaims(const Node& node, const TableNames& names, bool hasPrinted,
                                  bool isOfDocument);

std::vector<PlotSpec> readPlots(const Node& node, const TableNames& names);

/// One or several of the values that the axis is known to have.
Node::Sequence readFilterValues(const Node& value, const std::string& what, const std::string& axis,
                                const TableNames& names);
/// `at` of a claim or a plot, or the like; `what` begins the messages.
RowFilter readRowFilter(const Node& at, const std::string& what, const TableNames& names);

/// Throws Error unless `format` is text with at least one statistic in braces, as "{mean:.2f}".
void requireCellFormat(const Node& format);
/// lineOf() it; "" where it is not there.
std::string optionalLine(const GivenKey& key, const std::string& owner);
/// Throws Error "WHAT needs 'KEY'" where it is not there.
const Node& requiredAt(const Node& map, std::string_view key, std::string_view what);

const KeyTable<ContentKeys>& contentTable();
const KeyTable<MeasureKeys>& measureTable();
/// The keys of a config that a profile may change.
const Names& sectionKeys();
/// table, figure, section, sweep_of.
const Names& identityKeys();

/// `profiles:` — of a file, parts laid over it; of a document that is read, their names.
inline constexpr const char* kProfilesKey = "profiles";

/// Of `program`, of a parameter and of a picture there.
struct ProgramKeys {
    GivenKey command, params, metrics, passes, images, env, version, starts, files, frames, gpu,
        here;
};
struct ParamKeys {
    GivenKey fallback, unit, min, max, choices, doc;
};
struct ImageKeys {
    GivenKey file, truth;
};
const KeyTable<ProgramKeys>& programTable();
const KeyTable<ParamKeys>& paramTable();
const KeyTable<ImageKeys>& imageTable();

/// Throws Error for a value (but of params_by_scene) of which no case would know, as its axis is
/// swept in every one: it stands in the file of the sweep, in the experiment's own or on the
/// command line. One of a file that is extended may be swept.
void requireNotFixed(const Experiment& experiment);

/// A key, or a value, of which nothing follows.
struct NoEffect {
    SourceLocation where;
    std::string why;
};
/// The values of which no case would know, of whichever file.
std::vector<NoEffect> valuesInVain(const Experiment& experiment);
/// Each `exclude` that no point of the sweep matches.
std::vector<NoEffect> excludedInVain(const Experiment& experiment);
/// Each condition in `when` of values of which the sweep has none.
std::vector<NoEffect> whenInVain(const Experiment& experiment);
/// Keys of `printed` that judge or mark nothing here.
std::vector<NoEffect> printedInVain(const Experiment& experiment);
/// These, and every key of which nothing follows. `experiment` is the file as it stands, with what
/// profile `paper` makes of it.
std::vector<NoEffect> keysInVain(const Experiment& experiment);
/// Throws Error for such keys, and values, of the experiment's own file.
void requireEffect(const Experiment& experiment);
/// Throws Error for a key of a section that stands beside the `allowed` ones.
void requireInSections(const Node& document, const Names& allowed);
/// Throws Error for times that are shown or claimed, where the lane takes none.
void requireTimed(const Experiment& experiment);

/// `isComplete` as in Vocabulary.
Experiment readExperiment(const Node& document, const std::filesystem::path& file, bool isComplete);

/// The scene at a point of the experiment's sweep.
const Node& sceneAt(const AxisPoint& point, const Experiment& experiment);
/// Throws Error unless `value` is a side of the image; `axis` begins the message.
int outputSize(const Node& value, std::string_view axis);

// The keys of the sections, each declared where it is read.
std::vector<SchemaSection> programKeys();
SchemaSection compositionKeys();
SchemaSection profileKeys();
SchemaSection outputKeys();
std::vector<SchemaSection> sweepKeys();
SchemaSection measureKeys();
std::vector<SchemaSection> layoutKeys();
std::vector<SchemaSection> printedKeys();
SchemaSection plotKeys();
std::vector<SchemaSection> claimSections();
/// All of them, with those of no section of their own.
SchemaFile experimentSchema();
SchemaFile documentsSchema();

/// The `measure` and `output` sections, which are maps. `measure` is where the section says
/// nothing.
Measure readMeasure(const Node& map, Measure measure);
/// Width and height in pixels, and how many frames.
std::tuple<int, int, int> readOutput(const Node& map);

/// A reference with a file extension is a file beside the one that names it, or in `folder`.
Node withSceneFile(const Node& reference, const std::optional<std::filesystem::path>& folder = {});
/// Scene files, patterns of them and `all` of a sweep, each replaced by what it stands for. Throws
/// Error for a pattern without a file.
void resolveNames(Node& document);
/// Of it, the scenes that are keys: of each file before another one is laid on it.
void resolveSceneKeys(Node& document);

}  // namespace gfxrepro::config
