#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

/// The trimmed cells of one line.
std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells = split(line, ',');
    for (std::string& cell : cells) cell = std::string(trimmed(cell));
    return cells;
}

template <class Range, class Value>
bool rangeContains(const Range& range, const Value& value) {
    return std::find(range.begin(), range.end(), value) != range.end();
}

void requireHeader(const std::vector<std::string>& header, const TableNames* names,
                   const SourceLocation& where) {
    std::set<std::string> seen;
    for (const std::string& name : header) {
        if (name.empty()) throw Error(where, "printed: a column has no name");
        if (!seen.insert(name).second) {
            throw Error(where, "printed: column '" + name + "' stands twice");
        }
        if (!names || !names->hasAllColumns) continue;
        std::vector<std::string> known = names->rowAxes;
        known.insert(known.end(), names->columns.begin(), names->columns.end());
        if (rangeContains(known, name)) continue;
        const std::string near = suggestion(name, known);
        throw Error(where, "printed: '" + name + "' is neither a row axis nor a column" +
                               (near.empty() ? "; allowed: " + joined(known) : near));
    }
    if (!names) return;
    for (const std::string& axis : names->rowAxes) {
        if (!axis.empty() && !rangeContains(header, axis)) {
            throw Error(where, "printed: row axis '" + axis + "' has no column");
        }
    }
}

/// Whether two rows stand for the same place in the table.
std::string keyOfRow(const std::vector<std::string>& row, const std::vector<std::string>& header,
                     const TableNames& names) {
    std::string key;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (rangeContains(names.rowAxes, header[i])) key += row[i] + ",";
    }
    return key;
}

/// Labels are known by heart; values of a sweep may be printed without being measured.
void requireLabels(const std::vector<std::string>& row, const std::vector<std::string>& header,
                   const Layout& layout, const SourceLocation& where) {
    for (const LayoutAxis& axis : layout.rows) {
        const auto at = std::find(header.begin(), header.end(), axis.name);
        if (axis.isSweepAxis() || at == header.end()) continue;
        const std::string& value = row[static_cast<std::size_t>(at - header.begin())];
        std::vector<std::string> labels;
        for (const auto& label : axis.labels) labels.push_back(label.first);
        if (rangeContains(labels, value)) continue;
        throw Error(where, fmt::format("printed: {} is '{}'; allowed: {}", axis.name, value,
                                       joined(labels, " | ")));
    }
}

constexpr int kMostFrames = 1'000'000;  // as of measure.frames

/// Parameters of the technique are known to the plan alone, which checks their names and values.
Node::Map readAt(const Node& at) {
    if (!at.isMap()) throwNotAllowed(at, "printed.at", "a map {parameter: printed value}");
    constexpr const char* kSizes[] = {"output.width", "output.height", "measure.frames"};
    Node::Map values;
    for (const auto& [name, value] : at.entries()) {
        const bool isSize =
            std::find(std::begin(kSizes), std::end(kSizes), name) != std::end(kSizes);
        if (!isSize && rangeContains(name, '.')) {
            throw Error(at.keyLocation(name), "printed.at: '" + name +
                                                  "'; allowed: a parameter, scene, output.width, "
                                                  "output.height, measure.frames");
        }
        const int most = name == "measure.frames" ? kMostFrames : kMaxOutputPx;
        const long long size = value.tryInteger().value_or(0);
        if (isSize && (size < 1 || size > most)) {
            throwNotAllowed(value, "printed.at: " + name,
                            fmt::format("a whole number, 1 … {}", most));
        }
        values.emplace_back(name, value);
    }
    return values;
}

/// Cells go by row axes and, as a claim across rows calls it, `column`.
void requireCells(const Node& calibrated, const TableNames& names) {
    const std::string what = "printed.calibrated";
    if (!calibrated.isSequence())
        throwNotAllowed(calibrated, what, "[{row axis: value, column: name}]");
    TableNames all = names;
    all.rowAxes.emplace_back(kColumnAxis);
    if (names.hasAllColumns) {
        for (const std::string& column : names.columns) {
            all.rowValues[kColumnAxis].push_back(Node::scalar(column, {}, true));
        }
    }
    for (const Node& cells : calibrated.items()) readRowFilter(cells, what, all);
}

}  // namespace

Printed readPrinted(const Node& node, const Layout* layout, const TableNames* names) {
    requireKeys(node, "printed", keysOf("printed"));
    Printed printed;
    printed.location = node.location();
    if (const Node* hardware = node.find("hardware")) printed.hardware = hardware->text();
    if (const Node* remark = node.find("remark")) printed.remark = trimmed(remark->text());
    if (const Node* compared = node.find("compared")) {
        if (!compared->isSequence()) throwNotAllowed(*compared, "printed: compared", "[methods]");
        for (const Node& method : compared->items()) lineOf(method, "printed: compared");
    }
    if (const Node* calibrated = node.find("calibrated")) {
        if (!names) {
            throw Error(node.keyLocation("calibrated"),
                        "printed: 'calibrated' without 'technique'");
        }
        requireCells(*calibrated, *names);
    }
    if (const Node* at = node.find("at")) {
        if (!layout) throw Error(node.keyLocation("at"), "printed: 'at' without 'technique'");
        printed.at = readAt(*at);
    }
    const Node* values = node.find("values");
    if (!values) return printed;
    printed.location = values->location();
    const std::vector<std::string> lines = split(values->text(), '\n');
    std::set<std::string> keys;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string_view line = trimmed(lines[i]);
        if (line.empty() || line.front() == '#') continue;
        const SourceLocation where = values->lineLocation(i);
        std::vector<std::string> row = cellsOf(lines[i]);
        if (printed.header.empty()) {
            requireHeader(row, names, where);
            printed.header = std::move(row);
            continue;
        }
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
    if (printed.rows.empty()) throw Error(values->location(), "printed: values has no rows");
    return printed;
}

}  // namespace gfxrepro::config
