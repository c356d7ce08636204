#include "runner/config/printed_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

struct PrintedKeys {
    GivenKey hardware, remark, values, sources, compared, calibrated, unfit, at;
};
const KeyTable<PrintedKeys>& printedTable() {
    using P = PrintedKeys;
    static const KeyTable<P> table{
        {"printed", "printed.", ""},
        {{&P::hardware, "hardware", "text", "\"\"", "what the paper measured on", text()},
         {&P::remark, "remark", "text", "\"\"", "misprints and the like", text()},
         {&P::values,
          "values",
          "CSV block",
          "none",
          "a header of row axes and columns, which goes on behind a comma at the end of its line; "
          "then the rows",
          {{"type", "string"}}},
         {&P::sources, "sources", "{TEXT: {row axis: value, column: name}}", "{}",
          "where these cells are copied from, and how sure that is: shown behind the remark. Each "
          "value may be a list; what is left out is any",
          mapOf(pairs())},
         {&P::compared, "compared", "[method]", "[]",
          "methods that the paper compares with a usual one: no fit reads their cells",
          listOf(text())},
         {&P::calibrated, "calibrated", "[{row axis: value, column: name}]", "[]",
          "cells for which an input of ours was fitted, so that they come out: marked in "
          "every form of the table. Each value may be a list; what is left out is any",
          listOf(pairs())},
         {&P::unfit, "unfit", "[scene]", "[]",
          "scenes of ours that could not be fitted to what the paper prints of its own: they "
          "judge none of its claims",
          listOf(text())},
         {&P::at, "at", "{parameter: value}", "{}",
          "what the paper measured at, where the profile paper departs from it: a parameter, "
          "scene, output.width, output.height, output.frames",
          pairs()}}};
    return table;
}

struct FitKeys {
    GivenKey table, row, column;
};
const KeyTable<FitKeys>& fitTable() {
    static const KeyTable<FitKeys> table{
        {"fit", "fit.COLUMN.",
         "Only the cells that are named are read, and none of another method.", false},
        {{&FitKeys::table, "table", "file", "required", "of the table, in configs/", text()},
         {&FitKeys::row, "row", "{row axis: value}", "required", "all row axes of that table",
          pairs()},
         {&FitKeys::column, "column", "name", "required", "of that table", text()}}};
    return table;
}

/// The trimmed cells of one line.
Names cellsOf(const std::string& line) {
    Names cells = split(line, ',');
    for (std::string& cell : cells) cell = std::string(trimmed(cell));
    return cells;
}

void requireHeader(const Names& header, const TableNames* names, const SourceLocation& where) {
    std::set<std::string> seen;
    for (const std::string& name : header) {
        if (name.empty()) throw Error(where, "printed: a column has no name");
        if (!seen.insert(name).second) {
            throw Error(where, "printed: column '" + name + "' stands twice");
        }
        if (!names || !names->hasAllColumns) continue;
        Names known = names->rowAxes;
        known.insert(known.end(), names->columns.begin(), names->columns.end());
        if (contains(known, name)) continue;
        throw Error(where, "printed: '" + name + "' is neither a row axis nor a column" +
                               suggestionOrAll(name, known));
    }
    if (!names) return;
    for (const std::string& axis : names->rowAxes) {
        if (!axis.empty() && !contains(header, axis)) {
            throw Error(where, "printed: row axis '" + axis + "' has no column");
        }
    }
}

/// Whether two rows stand for the same place in the table.
std::string keyOfRow(const Names& row, const Names& header, const TableNames& names) {
    std::string key;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (contains(names.rowAxes, header[i])) key += row[i] + ",";
    }
    return key;
}

/// Labels are known by heart; values of a sweep may be printed without being measured.
void requireLabels(const Names& row, const Names& header, const Layout& layout,
                   const SourceLocation& where) {
    for (const LayoutAxis& axis : layout.rows) {
        const auto at = std::find(header.begin(), header.end(), axis.name);
        if (axis.isSweepAxis() || at == header.end()) continue;
        const std::string& value = row[static_cast<std::size_t>(at - header.begin())];
        Names labels;
        for (const auto& label : axis.labels) labels.push_back(label.first);
        if (contains(labels, value)) continue;
        throw Error(where, fmt::format("printed: {} is '{}'; allowed: {}", axis.name, value,
                                       joined(labels, " | ")));
    }
}

/// Parameters of the technique are known to the plan alone, which checks their names and values.
Node::Map readAt(const GivenKey& key) {
    const Node& at = *key;
    const std::string what = "printed." + key.name();
    if (!at.isMap()) throwNotAllowed(at, what, "a map {parameter: printed value}");
    constexpr const char* kSizes[] = {"output.width", "output.height", "output.frames"};
    Node::Map values;
    for (const auto& [name, value] : at.entries()) {
        const bool isSize = contains(kSizes, name);
        if (!isSize && contains(name, '.')) {
            throw Error(at.keyLocation(name),
                        fmt::format("{}: '{}'; allowed: a parameter, scene, {}", what, name,
                                    fmt::join(kSizes, ", ")));
        }
        const NumberRange& range = name == "output.frames" ? kFrameCounts : kOutputSizesPx;
        if (isSize) (void)numberIn(value, range, what + ": " + name);
        values.emplace_back(name, value);
    }
    return values;
}

Names namesIn(const GivenKey& list, std::string_view allowed) {
    if (!list) return {};
    const std::string what = list.in("printed");
    if (!list->isSequence()) throwNotAllowed(*list, what, allowed);
    Names names;
    for (const Node& name : list->items()) names.push_back(lineOf(name, what));
    return names;
}

/// Cells go by row axes and, as a claim across rows calls it, `column`.
TableNames cellNames(const TableNames& names) {
    TableNames all = names;
    all.rowAxes.emplace_back(kColumnAxis);
    if (names.hasAllColumns) {
        for (const std::string& column : names.columns) {
            all.rowValues[kColumnAxis].push_back(Node::scalar(column, {}, true));
        }
    }
    return all;
}

Node::Sequence cellsIn(const GivenKey& calibrated, const TableNames& names) {
    const std::string what = "printed." + calibrated.name();
    if (!calibrated->isSequence())
        throwNotAllowed(*calibrated, what, "[{row axis: value, column: name}]");
    for (const Node& cells : calibrated->items()) readRowFilter(cells, what, cellNames(names));
    return calibrated->items();
}

/// "at bits 32, 48: a figure, read off".
Names sourcesIn(const GivenKey& sources, const TableNames& names) {
    const std::string what = "printed." + sources.name();
    if (!sources->isMap()) throwNotAllowed(*sources, what, "{TEXT: {row axis: value}}");
    Names texts;
    for (const auto& [text, cells] : sources->entries()) {
        Names places;
        for (const auto& [axis, values] : readRowFilter(cells, what, cellNames(names))) {
            Names labels;
            for (const Node& value : values) labels.push_back(value.text());
            places.push_back(axis + ' ' + joined(labels));
        }
        if (places.empty()) {
            throwNotAllowed(cells, what, "{row axis: value}; of the whole table 'remark' says it");
        }
        texts.push_back(fmt::format("at {}: {}", joined(places, " and "), text));
    }
    return texts;
}

}  // namespace

std::vector<NoEffect> printedInVain(const Experiment& experiment) {
    const GivenKey printed = contentOf(experiment.document).printed;
    if (!printed || !printed->isMap()) return {};
    const PrintedKeys given = printedTable().find(*printed);
    std::vector<NoEffect> found;
    const auto require = [&](const GivenKey& key, bool hasEffect, const std::string& why) {
        if (!key || hasEffect) return;
        found.push_back(
            {printed->keyLocation(key.name()), fmt::format("'{}': {}", key.name(), why)});
    };
    const std::string with = "; allowed: with '" + given.values.name() + "'";
    require(given.at, experiment.isPublished(),
            "nothing is printed that could have been measured there" + with);
    require(given.compared, !experiment.printed.rows.empty(),
            "no fit reads a table without printed cells" + with);
    const auto& claims = experiment.claims;
    require(given.unfit,
            experiment.kind == ExperimentKind::Sweep
                ? std::ranges::any_of(claims, &ClaimSpec::isReadOffDocument)
                : !claims.empty(),
            "it takes scenes from the claims of a document, and there are none");
    return found;
}

Printed readPrinted(const Node& node, const Layout* layout, const TableNames* names) {
    const PrintedKeys given = printedTable().read(node, "printed");
    const auto refuse = [&](const GivenKey& key, const char* without) {
        throw Error(node.keyLocation(key.name()),
                    fmt::format("printed: '{}' without '{}'", key.name(), without));
    };
    if (given.values && layout && !names) refuse(given.values, "layout");
    for (const GivenKey& key : {given.calibrated, given.sources}) {
        if (key && !names) refuse(key, layout ? "layout" : "technique");
    }
    if (given.at && !layout) refuse(given.at, "technique");
    if (given.sources && !given.values) refuse(given.sources, "values");
    Printed printed;
    printed.location = node.location();
    if (given.hardware) printed.hardware = given.hardware->text();
    if (given.remark) printed.remark = trimmed(given.remark->text());
    printed.compared = namesIn(given.compared, "[methods]");
    printed.unfit = namesIn(given.unfit, "[scenes]");
    if (given.calibrated) printed.calibrated = cellsIn(given.calibrated, *names);
    if (given.sources) {
        for (const std::string& text : sourcesIn(given.sources, *names)) {
            printed.remark += (printed.remark.empty() ? "" : "; ") + text;
        }
    }
    if (given.at) printed.at = readAt(given.at);
    const GivenKey& values = given.values;
    if (!values) return printed;
    printed.location = values->location();
    const Names lines = split(values->text(), '\n');
    std::set<std::string> keys;
    bool isHeader = true;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string_view line = trimmed(lines[i]);
        if (line.empty() || line.front() == '#') continue;
        const SourceLocation where = values->lineLocation(i);
        if (isHeader) {  // one that ends in a comma goes on in the next line
            isHeader = line.back() == ',';
            const std::string part(isHeader ? line.substr(0, line.size() - 1) : line);
            std::ranges::move(cellsOf(part), std::back_inserter(printed.header));
            if (!isHeader) requireHeader(printed.header, names, where);
            continue;
        }
        Names row = cellsOf(lines[i]);
        if (row.size() != printed.header.size()) {
            throw Error(where, fmt::format("printed: {} cells in a row; the header has {}",
                                           row.size(), printed.header.size()));
        }
        if (layout) requireLabels(row, printed.header, *layout, where);
        if (names && !keys.insert(keyOfRow(row, printed.header, *names)).second) {
            throw Error(where, "printed: the row '" + std::string(line) + "' stands twice");
        }
        printed.rows.push_back(std::move(row));
    }
    if (printed.rows.empty())
        throw Error(values->location(), values.in("printed") + " has no rows");
    return printed;
}

namespace {

/// What a cell selects: `cell`, then the labels of its row, then those of its column.
Selection laidOver(const Selection& under, const Selection& over) {
    Selection result = under;
    if (over.metric) result.metric = over.metric;
    if (over.pass) result.pass = over.pass;
    result.where.insert(result.where.end(), over.where.begin(), over.where.end());
    return result;
}

Selection selectionOf(const LayoutAxis& axis, const std::string& value) {
    Selection selection;
    if (axis.isSweepAxis()) selection.where.emplace_back(axis.name, Node::scalar(value));
    for (const auto& [label, chosen] : axis.labels) {
        if (label == value) selection = chosen;
    }
    return selection;
}

/// The labels of an axis: its own, or the values that a sweep gives it.
Names axisLabels(const LayoutAxis& axis, const std::vector<AxisPoint>& sweep) {
    Names labels;
    for (const auto& [label, selection] : axis.labels) labels.push_back(label);
    if (!axis.isSweepAxis()) return labels;
    for (const AxisPoint& point : sweep) {
        for (const auto& [name, value] : point) {
            const bool isValue = name == axis.name && value.isScalar();
            if (isValue && std::ranges::count(labels, value.text()) == 0) {
                labels.push_back(value.text());
            }
        }
    }
    return labels;
}

/// The cell at `row` (beside the row axes) and a column, which the labels of the column axes name.
Selection cellSelection(const Experiment& experiment, const Names& row, const std::string& column) {
    const Layout& layout = experiment.layout;
    Selection cell = layout.cell;
    for (std::size_t i = 0; i < layout.rows.size(); ++i) {
        cell = laidOver(cell, selectionOf(layout.rows[i], row[i]));
    }
    const std::vector<AxisPoint> sweep = expandSweep(experiment.sweep);
    std::map<std::string, Selection> columns{{"", cell}};
    for (const LayoutAxis& axis : layout.columns) {
        std::map<std::string, Selection> finer;
        for (const auto& [name, above] : columns) {
            for (const std::string& label : axisLabels(axis, sweep)) {
                const std::string own = name.empty() ? label : name + "_" + label;
                finer.emplace(own, laidOver(above, selectionOf(axis, label)));
            }
        }
        columns = std::move(finer);
    }
    const auto found = columns.find(column);
    return found == columns.end() ? cell : found->second;
}

/// The one method of a cell's cases; empty where it is not one or not said.
std::string methodOf(const Experiment& experiment, const Selection& cell) {
    std::string method;
    for (const auto& [axis, value] : cell.where) {
        if (axis == "method") method = value.isScalar() ? value.text() : "";
    }
    if (!method.empty()) return method;
    for (const AxisPoint& point : expandSweep(experiment.sweep)) {
        for (const auto& [axis, value] : point) {
            if (axis == "method") return "";
        }
    }
    const Node* fixed = experiment.params.find("method");
    return fixed && fixed->isScalar() ? fixed->text() : "";
}

/// Whether a value of a filter is the label of a row or column.
bool isLabel(const Node& value, const std::string& label) {
    const std::string text = value.isScalar() ? value.text() : value.toFlowText();
    const auto number = parseDouble(text), other = parseDouble(label);
    return text == label || (number && other && *number == *other);
}

/// The labels of `row` beside the table's row axes.
Names rowLabels(const GivenKey& row, const Layout& layout, const std::string& what) {
    Names axes, labels;
    for (const LayoutAxis& axis : layout.rows) axes.push_back(axis.name);
    requireKeys(*row, row.in(what), axes);
    for (const std::string& axis : axes) labels.push_back(requiredAt(*row, axis, what).text());
    return labels;
}

double printedValue(const Printed& printed, const Layout& layout, const Names& row,
                    const Node& column, const std::string& what) {
    const auto at = std::ranges::find(printed.header, column.text());
    if (at == printed.header.end()) {
        throw Error(column.location(),
                    fmt::format("{}: no column '{}' is printed{}", what, column.text(),
                                suggestion(column.text(), printed.header)));
    }
    for (const Names& cells : printed.rows) {
        bool isRow = true;
        for (std::size_t i = 0; i < layout.rows.size(); ++i) {
            const auto axis = std::ranges::find(printed.header, layout.rows[i].name);
            isRow =
                isRow && cells[static_cast<std::size_t>(axis - printed.header.begin())] == row[i];
        }
        if (!isRow) continue;
        const std::string& text = cells[static_cast<std::size_t>(at - printed.header.begin())];
        if (const auto value = parseDouble(text)) return *value;
        throw Error(column.location(),
                    fmt::format("{}: what is printed there is no number: '{}'", what, text));
    }
    throw Error(column.location(), fmt::format("{}: no row {} is printed", what, joined(row)));
}

void requireSameMeasure(const Selection& ours, const Selection& theirs, const std::string& what,
                        const SourceLocation& where) {
    if (ours.metric == theirs.metric && ours.pass == theirs.pass) return;
    const auto name = [](const Selection& cell) {
        return cell.metric.value_or("nothing") + (cell.pass ? " of " + *cell.pass : "");
    };
    throw Error(where, fmt::format("{}: the column is {}, the printed cell {}", what, name(ours),
                                   name(theirs)));
}

}  // namespace

const Node& printedValuesOf(const Node& document) {
    return *printedTable().find(*contentOf(document).printed).values;
}

bool isCalibrated(const Experiment& table, const Names& row, const std::string& column) {
    const auto labelOf = [&](const std::string& axis) -> const std::string* {
        for (std::size_t i = 0; i < table.layout.rows.size(); ++i) {
            if (table.layout.rows[i].name == axis) return &row[i];
        }
        return axis == kColumnAxis ? &column : nullptr;
    };
    return std::ranges::any_of(table.printed.calibrated, [&](const Node& cells) {
        return std::ranges::all_of(cells.entries(), [&](const auto& entry) {
            const std::string* label = labelOf(entry.key());
            if (!label) return false;
            const Node& values = entry.value;
            if (!values.isSequence()) return isLabel(values, *label);
            return std::ranges::any_of(values.items(),
                                       [&](const Node& one) { return isLabel(one, *label); });
        });
    });
}

const Node& tableOfFit(const Node& entry, const SourceLocation& where, const std::string& column) {
    return *fitTable().read(entry, "fit: '" + column + "'", &where).table;
}

Node withPrintedCell(const Node& entry, const std::string& column, const Experiment& fit,
                     const Experiment& table) {
    const std::string what = "fit: '" + column + "'";
    const FitKeys given = fitTable().find(entry);
    const Node &place = *given.table, &theirs = *given.column;
    if (table.technique != fit.technique || !table.layout.isGiven) {
        throw Error(place.location(), fmt::format("{}: {} is not measured by technique '{}'", what,
                                                  table.id, fit.technique));
    }
    const Names row = rowLabels(given.row, table.layout, what);
    const Selection cell = cellSelection(table, row, lineOf(theirs, given.column.in(what)));
    const Selection own = cellSelection(fit, Names(fit.layout.rows.size()), column);
    // What a fit may read compares no methods: that is how the other rows stay blind.
    const std::string method = methodOf(fit, own), printedMethod = methodOf(table, cell);
    if (method.empty()) {
        throw Error(entry.location(), what + ": the cases are not all of one method in 'params'");
    }
    if (method != printedMethod) {
        throw Error(theirs.location(),
                    fmt::format("{}: the printed cell is of method '{}', the cases of '{}'; a fit "
                                "sees what compares no methods",
                                what, printedMethod, method));
    }
    if (contains(table.printed.compared, method)) {
        throw Error(theirs.location(),
                    fmt::format("{}: {} compares method '{}' with a usual one ('compared'); a fit "
                                "sees what compares no methods",
                                what, table.id, method));
    }
    requireSameMeasure(own, cell, what, theirs.location());
    if (!isCalibrated(table, row, theirs.text())) {
        throw Error(theirs.location(),
                    fmt::format("{}: {} does not mark the cell as one that was fitted "
                                "('printed.calibrated')",
                                what, table.id));
    }
    Node result = entry;
    result.set("printed", Node::number(printedValue(table.printed, table.layout, row, theirs, what),
                                       theirs.location()));
    result.set("id", Node::scalar(table.id, place.location(), true));
    return result;
}

std::vector<FitTarget> fitTargets(const Experiment& experiment) {
    const GivenKey fit = contentOf(experiment.document).fit;
    if (!fit || fit->isNull()) return {};
    std::vector<FitTarget> targets;
    for (const auto& [column, entry] : fit->entries()) {
        targets.push_back({column, requiredAt(entry, "id", "fit").text(),
                           requiredAt(entry, "printed", "fit").asDouble()});
    }
    return targets;
}

std::vector<SchemaSection> printedKeys() {
    return {printedTable().section(), fitTable().section()};
}

}  // namespace gfxrepro::config
