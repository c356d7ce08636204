#include "runner/tables/printed_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/core/text.h"
#include "runner/tables/case_records.h"

namespace gfxrepro::tables {

namespace {

using Cells = std::vector<std::string>;

/// Where the printed rows stand, in their order.
std::vector<SourceLocation> linesOf(const Node& values) {
    std::vector<SourceLocation> lines;
    const std::vector<std::string> texts = split(values.text(), '\n');
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string_view line = trimmed(texts[i]);
        if (!line.empty() && line.front() != '#') lines.push_back(values.lineLocation(i));
    }
    lines.erase(lines.begin());  // the header
    return lines;
}

/// The printed cell of that name; null where there is no such column.
const std::string* findColumn(const std::string& name, const Cells& header, const Cells& printed) {
    const auto found = std::ranges::find(header, name);
    return found == header.end() ? nullptr
                                 : &printed[static_cast<std::size_t>(found - header.begin())];
}

bool isOf(const Cells& printed, const Cells& header, const Table& table, const TableRow& row) {
    for (std::size_t i = 0; i < table.rowAxes.size(); ++i) {
        const std::string* label = findColumn(table.rowAxes[i], header, printed);
        if (label && canonicalText(Node::scalar(*label)) != row.labels[i]) return false;
    }
    return true;
}

/// What the tables have on their row axes: "scene a | b; step 1 | 2".
std::string allowedRows(std::span<const Table> tables) {
    std::vector<std::string> axes;
    for (std::size_t axis = 0; axis < tables.front().rowAxes.size(); ++axis) {
        Cells labels;
        for (const Table& table : tables) {
            for (const TableRow& row : table.rows) {
                if (axis >= row.labels.size()) continue;  // a profile's layout
                const bool isNew = std::ranges::find(labels, row.labels[axis]) == labels.end();
                if (isNew) labels.push_back(row.labels[axis]);
            }
        }
        axes.push_back(tables.front().rowAxes[axis] + " " + joined(labels, " | "));
    }
    return joined(axes, "; ");
}

void requireNumbers(const Table& table, const TableRow& row, const SourceLocation& where) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const Cell& cell = row.cells[i];
        const bool isWhole = std::ranges::all_of(
            cell.printedValues, [](const auto& value) { return value.has_value(); });
        if (!cell.printed || isWhole) continue;
        throw Error(where, fmt::format("printed: {} is '{}'; allowed: as the cell's format writes "
                                       "numbers, or empty where it is lost",
                                       table.columns[i].label, *cell.printed));
    }
}

}  // namespace

void requirePrintedValues(const config::Experiment& experiment, std::span<const Table> tables) {
    const config::Printed& printed = experiment.printed;
    if (printed.rows.empty()) return;
    const std::vector<SourceLocation> lines =
        linesOf(*experiment.document.find("printed")->find("values"));
    for (std::size_t i = 0; i < printed.rows.size(); ++i) {
        bool isMeasured = false;
        for (const Table& table : tables) {
            for (const auto* rows : {&table.rows, &table.printedRows}) {
                for (const TableRow& row : *rows) {
                    if (!isOf(printed.rows[i], printed.header, table, row)) continue;
                    isMeasured |= rows == &table.rows;
                    requireNumbers(table, row, lines[i]);
                }
            }
        }
        if (isMeasured) continue;
        throw Error(lines[i], fmt::format("printed: no profile measures the row '{}'; allowed: {}",
                                          joined(printed.rows[i], ","), allowedRows(tables)));
    }
}

}  // namespace gfxrepro::tables
