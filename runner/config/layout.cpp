#include <algorithm>

#include <fmt/format.h>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/metrics/statistics.h"
#include "runner/claims/kinds/operands.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

/// Case axes, and `frame`: the frames of a path.
Names referableAxes(const Vocabulary& vocabulary) {
    Names names = vocabulary.axisNames();
    names.emplace_back("frame");
    return names;
}

/// The text of a cell, or what it shows.
Json selectionType() {
    return anyOf({text(), refTo("selection")});
}

struct LayoutKeys {
    GivenKey axes, rows, columns, cell;
};
const KeyTable<LayoutKeys>& layoutTable() {
    static const Json axesType = anyOf({text(), listOf(text()), mapOf(selectionType())});
    static const KeyTable<LayoutKeys> table{
        {"layout", "layout.", ""},
        {{&LayoutKeys::axes, "axes", "{axis: {label: selection}}", "{}",
          "axes of labels, for rows and columns", mapOf(mapOf(selectionType()))},
         {&LayoutKeys::rows, "rows", "axis | [axes] | {label: selection}", "one row",
          "what the rows stand for", axesType},
         {&LayoutKeys::columns, "columns", "axis | [axes] | {label: selection}", "one column",
          "axes: declared above, or swept, a parameter, scene, frame", axesType},
         {&LayoutKeys::cell, "cell", "format | selection", kDefaultCellFormat,
          "what every cell shows", selectionType()}}};
    return table;
}

struct SelectionKeys {
    GivenKey metric, pass, format, scale, of, equal, where;
};
const KeyTable<SelectionKeys>& selectionTable() {
    using S = SelectionKeys;
    static const KeyTable<S> table{
        {"selection", "selection.",
         "A selection is a metric, or a map of these; the column's part wins over the row's, the "
         "row's over the cell's."},
        {{&S::metric, "metric", "name", "none", "of the technique's metrics", text()},
         {&S::pass, "pass", "name", "whole case", "step of the algorithm", text()},
         {&S::format, "format", "text", "none",
          fmt::format("{} in braces: {{mean:.2f}}", fmt::join(metrics::kStatistics, " ")), text()},
         {&S::scale, numberKey("scale", kScales, "1", "multiplies every value")},
         {&S::of, "of", "expression", "none",
          "of a column: computed, in each process, of columns before it; time[threads=1] / time "
          "reads the first of the row with that value",
          text()},
         {&S::equal, "equal", "equal", "none", "at equal time, or at equal error", refTo("equal")},
         {&S::where, "where", "{axis: value}", "{}", "only these cases", pairs()}}};
    return table;
}

struct EqualKeys {
    GivenKey metric, is;
};
const KeyTable<EqualKeys>& equalTable() {
    static const KeyTable<EqualKeys> table{
        {"equal", "equal.",
         "The cell takes the cases of a swept axis, and shows its metric where another one has a "
         "value: interpolated between the two nearest cases, on logarithmic scales.",
         false},
        {{&EqualKeys::metric, "metric", "name", "required", "the other metric", text()},
         {&EqualKeys::is, numberKey("is", {}, "required", "its value")}}};
    return table;
}

Selection readSelection(const Node& node, const Vocabulary& vocabulary) {
    Selection selection;
    selection.location = node.location();
    if (node.isScalar()) {
        selection.metric = lineOf(node, selectionTable().nameOf(&SelectionKeys::metric));
        return selection;
    }
    const SelectionKeys given = selectionTable().read(node, "a cell's selection");
    if (given.metric) selection.metric = lineOf(*given.metric, given.metric.name());
    if (given.pass) selection.pass = lineOf(*given.pass, given.pass.name());
    if (given.format) {
        requireCellFormat(*given.format);
        selection.format = given.format->text();
    }
    if (given.scale) selection.scale = given.scale.number();
    if (given.equal) {
        const std::string& what = given.equal.name();
        const EqualKeys equal = equalTable().read(*given.equal, what);
        selection.equal = Equal{lineOf(*equal.metric, equal.metric.name()), equal.is.number(what)};
    }
    if (given.of) {
        selection.of = lineOf(*given.of, given.of.name());
        requireKeys(node, "a computed column", Names{given.of.name(), given.format.name()});
    }
    if (given.where) {
        requireKeys(*given.where, given.where.name(), referableAxes(vocabulary));
        selection.where.assign(given.where->entries().begin(), given.where->entries().end());
    }
    return selection;
}

/// The cell's text is its format; elsewhere text is a metric.
Selection readCell(const Node& node, const Vocabulary& vocabulary) {
    if (!node.isScalar()) return readSelection(node, vocabulary);
    requireCellFormat(node);
    Selection cell;
    cell.location = node.location();
    cell.format = node.text();
    return cell;
}

LayoutAxis readLabels(const std::string& name, const Node& node, const Vocabulary& vocabulary) {
    if (!node.isMap() || node.entries().empty()) {
        throwNotAllowed(node, "labels", "a map {label: selection}");
    }
    LayoutAxis axis{name, {}};
    for (const auto& [label, selection] : node.entries()) {
        axis.labels.emplace_back(label, readSelection(selection, vocabulary));
    }
    return axis;
}

/// Reads `rows` and `columns`, which draw on the same declared axes.
class AxisReader {
  public:
    AxisReader(const Node* axes, const Vocabulary& vocabulary) : vocabulary_(vocabulary) {
        if (!axes) return;
        for (const auto& [name, labels] : axes->entries()) {
            if (vocabulary.axes.contains(name)) {
                throw Error(axes->keyLocation(name),
                            "layout: axis '" + name + "' is an axis of the cases already");
            }
            declared_.push_back(readLabels(name, labels, vocabulary));
            places_.push_back(axes->keyLocation(name));
        }
    }

    std::vector<LayoutAxis> read(const Node& node) {
        if (node.isMap()) return {readLabels("", node, vocabulary_)};
        if (node.isScalar()) return {named(node)};
        std::vector<LayoutAxis> axes;
        for (const Node& name : node.items()) axes.push_back(named(name));
        return axes;
    }

    void requireAllUsed() const {
        for (std::size_t i = 0; i < declared_.size(); ++i) {
            if (isUsed(declared_[i].name)) continue;
            throw Error(places_[i], "layout: axis '" + declared_[i].name +
                                        "' is neither in rows nor in columns");
        }
    }

  private:
    bool isUsed(const std::string& name) const { return contains(used_, name); }

    LayoutAxis named(const Node& node) {
        const std::string& name = lineOf(node, "axis");
        if (isUsed(name)) {
            throw Error(node.location(), "layout: axis '" + name + "' is used twice");
        }
        used_.push_back(name);
        Names known = referableAxes(vocabulary_);
        for (const LayoutAxis& axis : declared_) {
            if (axis.name == name) return axis;
            known.push_back(axis.name);
        }
        if (!contains(known, name)) {
            throw Error(node.location(),
                        "layout: unknown axis '" + name + "'" + suggestionOrAll(name, known));
        }
        return {name, {}};
    }

    const Vocabulary& vocabulary_;
    std::vector<LayoutAxis> declared_;
    std::vector<SourceLocation> places_;
    Names used_;
};

bool hasMetricEverywhere(const Layout& layout) {
    if (layout.cell.metric) return true;
    for (const auto* axes : {&layout.rows, &layout.columns}) {
        for (const LayoutAxis& axis : *axes) {
            const bool isComplete =
                !axis.isSweepAxis() &&
                std::all_of(axis.labels.begin(), axis.labels.end(), [](const auto& label) {
                    return label.second.metric || label.second.of;
                });
            if (isComplete) return true;
        }
    }
    return false;
}

/// All combinations of the columns' axes, joined by "_".
Names combine(const Names& heads, const Names& tails) {
    Names names;
    for (const std::string& head : heads) {
        for (const std::string& tail : tails) {
            names.push_back(head.empty() ? tail : head + "_" + tail);
        }
    }
    return names;
}

/// The statistics in a format that is sound.
Names statisticsOf(const std::string& format) {
    Names names;
    for (std::size_t at = 0; (at = format.find('{', at)) != format.npos; ++at) {
        if (format[at + 1] == '{') {
            ++at;
            continue;
        }
        const std::size_t end = format.find_first_of(":}", at);
        names.push_back(format.substr(at + 1, end - at - 1));
    }
    return names;
}

/// In each process a column is computed of the same statistic of those that it reads. What a row
/// says of its format is known cell by cell.
void requireSameStatistics(const Layout& layout, const Selection& selection,
                           const Names& columnsRead) {
    const auto hasFormat = [](const LayoutAxis& axis) {
        return std::ranges::any_of(
            axis.labels, [](const auto& label) { return label.second.format.has_value(); });
    };
    if (std::ranges::any_of(layout.rows, hasFormat)) return;
    const auto formatOf = [&](const Selection& one) {
        return one.format.value_or(*layout.cell.format);
    };
    for (const auto& [label, read] : layout.columns[0].labels) {
        if (!contains(columnsRead, label)) continue;
        const Names there = statisticsOf(formatOf(read));
        for (const std::string& statistic : statisticsOf(formatOf(selection))) {
            if (contains(there, statistic)) continue;
            throw Error(selection.location,
                        fmt::format("layout: of: '{}' shows {}, and this column {}; allowed: of "
                                    "both the same, as format: \"{{{}:.4g}}\"",
                                    label, joined(there), statistic, there.front()));
        }
    }
}

/// Expressions stand in the columns, and read columns before them, in rows that there are.
void requireComputed(const Layout& layout, const Vocabulary& vocabulary) {
    const auto refuse = [](const Selection& selection, const std::string& text) {
        throw Error(selection.location, "layout: of: " + text);
    };
    const auto refuseAny = [&](const LayoutAxis& axis, const std::string& text) {
        for (const auto& [label, selection] : axis.labels) {
            if (selection.of) refuse(selection, text);
        }
    };
    if (layout.cell.of) refuse(layout.cell, "it stands in a column");
    for (const LayoutAxis& axis : layout.rows) refuseAny(axis, "it stands in a column, not a row");
    if (layout.columns.size() > 1) {
        for (const LayoutAxis& axis : layout.columns) {
            refuseAny(axis, "columns have one axis where one of them is computed");
        }
    }
    if (layout.columns.size() != 1) return;
    const TableNames names = tableNames(layout, vocabulary);
    Names before;
    for (const auto& [label, selection] : layout.columns[0].labels) {
        Names known = before;
        before.push_back(label);
        if (!selection.of) continue;
        Names columnsRead;
        for (const claims::RowReference& reference : claims::rowReferences(*selection.of, known)) {
            const std::string text(reference.text);
            columnsRead.push_back(known[reference.column]);
            if (reference.at.empty()) refuse(selection, text + "; allowed: column[axis=value, …]");
            for (const auto& [axis, value] : reference.at) {
                if (!contains(names.rowAxes, axis)) {
                    refuse(selection, fmt::format("{}: '{}' is no row axis{}", text, axis,
                                                  suggestionOrAll(axis, names.rowAxes)));
                }
                const auto values = names.rowValues.find(axis);
                const Node wanted = Node::scalar(value, selection.location, false);
                if (values == names.rowValues.end() ||
                    matchesAny(wanted, Node::sequence(values->second))) {
                    continue;
                }
                Names texts;
                for (const Node& one : values->second) texts.push_back(one.toFlowText());
                refuse(selection, fmt::format("{}: {} is {}; allowed: {}", text, axis, value,
                                              joined(texts, " | ")));
            }
            known.push_back(text);
        }
        for (const claims::OperandPiece& piece : claims::operandPieces(*selection.of, known)) {
            if (!piece.problem.empty()) refuse(selection, piece.problem);
            if (piece.column) columnsRead.push_back(known[*piece.column]);
        }
        requireSameStatistics(layout, selection, columnsRead);
        const std::string& format = selection.format ? *selection.format : *layout.cell.format;
        for (const char* spread : {"{stddev", "{p95", "{p99"}) {
            if (format.find(spread) == format.npos) continue;
            refuse(selection, fmt::format("of cells no {} can be computed; allowed in its format: "
                                          "median, mean, min, max, sum, count, rate",
                                          spread + 1));
        }
    }
}

}  // namespace

const Selection* Layout::computed(std::string_view column) const {
    if (columns.size() != 1) return nullptr;
    for (const auto& [label, selection] : columns[0].labels) {
        if (label == column && selection.of) return &selection;
    }
    return nullptr;
}

Names Vocabulary::axisNames() const {
    Names names;
    for (const auto& axis : axes) names.push_back(axis.first);
    return names;
}

Layout readLayout(const Node& node, const Vocabulary& vocabulary) {
    const LayoutKeys given = layoutTable().read(node, "layout");
    Layout layout;
    layout.isGiven = true;
    layout.cell.location = node.location();
    AxisReader reader(given.axes, vocabulary);
    if (given.rows) layout.rows = reader.read(*given.rows);
    if (given.columns) layout.columns = reader.read(*given.columns);
    reader.requireAllUsed();
    if (layout.rows.empty() && layout.columns.empty()) {
        throw Error(node.location(), "layout has neither rows nor columns");
    }
    if (given.cell) layout.cell = readCell(*given.cell, vocabulary);
    if (!layout.cell.format) layout.cell.format = kDefaultCellFormat;
    if (!hasMetricEverywhere(layout)) {
        throw Error(layout.cell.location,
                    "layout: some cell has no metric; allowed: a metric in `cell`, or in every "
                    "label of one axis");
    }
    requireComputed(layout, vocabulary);
    return layout;
}

TableNames tableNames(const Layout& layout, const Vocabulary& vocabulary) {
    TableNames names;
    const auto valuesOf = [&](const LayoutAxis& axis) {
        Node::Sequence values;
        for (const auto& label : axis.labels) values.push_back(Node::scalar(label.first, {}, true));
        const auto known = vocabulary.axes.find(axis.name);
        return axis.isSweepAxis() && known != vocabulary.axes.end() ? known->second : values;
    };
    for (const LayoutAxis& axis : layout.rows) {
        names.rowAxes.push_back(axis.name);
        const bool isKnown = !axis.isSweepAxis() || (vocabulary.isComplete && axis.name != "frame");
        if (isKnown) names.rowValues[axis.name] = valuesOf(axis);
    }
    Names columns = {""};
    for (const LayoutAxis& axis : layout.columns) {
        if (axis.isSweepAxis() && (!vocabulary.isComplete || axis.name == "frame")) {
            names.hasAllColumns = false;
        }
        Names values;
        for (const Node& value : valuesOf(axis)) {
            values.push_back(value.isScalar() ? value.text() : value.toFlowText());
        }
        columns = combine(columns, values);
    }
    if (!layout.columns.empty()) names.columns = std::move(columns);
    return names;
}

Node::Sequence readFilterValues(const Node& value, const std::string& what, const std::string& axis,
                                const TableNames& names) {
    const Node::Sequence wanted = value.isSequence() ? value.items() : Node::Sequence{value};
    const auto known = names.rowValues.find(axis);
    if (known == names.rowValues.end()) return wanted;
    for (const Node& item : wanted) {
        if (matchesAny(item, Node::sequence(known->second))) continue;
        Names texts;
        for (const Node& one : known->second) texts.push_back(one.toFlowText());
        throwNotAllowed(item, what, joined(texts, " | "));
    }
    return wanted;
}

RowFilter readRowFilter(const Node& at, const std::string& what, const TableNames& names) {
    requireKeys(at, what, names.rowAxes);
    RowFilter filter;
    for (const auto& [axis, value] : at.entries()) {
        filter.emplace_back(axis,
                            readFilterValues(value, fmt::format("{}.{}", what, axis), axis, names));
    }
    return filter;
}

namespace {

/// Throws Error unless it is one of metrics::kStatistics.
void requireStatistic(const Node& name) {
    if (!contains(metrics::kStatistics, lineOf(name, "statistic"))) {
        throwNotAllowed(name, "statistic",
                        fmt::format("{}", fmt::join(metrics::kStatistics, ", ")));
    }
}

}  // namespace

void requireCellFormat(const Node& format) {
    const std::string& text = lineOf(format, "format");
    int count = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isDoubled = i + 1 < text.size() && text[i + 1] == text[i];
        if (text[i] == '}' && !isDoubled)
            throwNotAllowed(format, "format", "} only after {, or }}");
        if ((text[i] == '{' || text[i] == '}') && isDoubled) {
            ++i;
            continue;
        }
        if (text[i] != '{') continue;
        const std::size_t end = text.find('}', i);
        if (end == std::string::npos) throwNotAllowed(format, "format", "a } for every {");
        const std::string inside = text.substr(i + 1, end - i - 1);
        const std::size_t colon = std::min(inside.find(':'), inside.size());
        requireStatistic(Node::scalar(inside.substr(0, colon), format.location(), true));
        // Short, so that a width cannot be absurd.
        constexpr std::size_t kMaxSpecLength = 6;
        const std::string spec = inside.substr(colon);
        try {
            if (spec.size() > kMaxSpecLength) throw fmt::format_error("too long");
            (void)fmt::format(fmt::runtime("{" + spec + "}"), 1.0);
        } catch (const fmt::format_error& error) {
            throwNotAllowed(
                format, "format",
                "number formats such as {mean:.2f} (" + std::string(error.what()) + ")");
        }
        ++count;
        i = end;
    }
    if (count == 0) throwNotAllowed(format, "format", "a statistic in braces, as {median:.4g}");
}

std::string optionalLine(const GivenKey& key, const std::string& owner) {
    return key ? lineOf(*key, key.in(owner)) : "";
}

const Node& requiredAt(const Node& map, std::string_view key, std::string_view what) {
    const Node* value = map.find(key);
    if (!value) throw Error(map.location(), fmt::format("{} needs '{}'", what, key));
    return *value;
}

std::vector<SchemaSection> layoutKeys() {
    return {layoutTable().section(), selectionTable().section(), equalTable().section()};
}

}  // namespace gfxrepro::config
