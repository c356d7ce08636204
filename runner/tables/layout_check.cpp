// What `check` refuses of a layout, before anything is measured.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

namespace {

/// The parts of the layout that choose cases.
std::vector<const config::Selection*> choosing(const config::Layout& layout) {
    std::vector<const config::Selection*> all = {&layout.cell};
    for (const auto* axes : {&layout.rows, &layout.columns}) {
        for (const config::LayoutAxis& axis : *axes) {
            for (const auto& [label, selection] : axis.labels) all.push_back(&selection);
        }
    }
    std::erase_if(all, [](const config::Selection* one) { return one->where.empty(); });
    return all;
}

/// Of the axis the values that some case has; of `frame` those of the longest path.
std::vector<std::string> valuesOn(const std::string& axis, std::span<const LayoutCases> profiles) {
    std::vector<std::string> values;
    std::set<std::string> seen;
    const auto add = [&](const std::string& value) {
        if (seen.insert(value).second) values.push_back(value);
    };
    for (const LayoutCases& cases : profiles) {
        if (axis == "frame") {
            if (cases.isOfElsewhere && cases.recorded.empty()) continue;  // its file knows
            for (const int frame : cases.frames) add(std::to_string(frame));
            continue;
        }
        const std::size_t place = cases.indexOf(axis);
        for (const CaseRecords& item : cases.cases) {
            if (item.axes[place]) add(*item.axes[place]);
        }
    }
    return values;
}

void requireValues(const config::Selection& selection, std::span<const LayoutCases> profiles) {
    for (const auto& [axis, wanted] : selection.where) {
        std::vector<std::string> values = valuesOn(axis, profiles);
        const auto isThere = [&](const Node& value) {
            return std::ranges::find(values, canonicalText(value)) != values.end();
        };
        if (isThere(wanted)) continue;
        for (const Node& one : wanted.isSequence() ? wanted.items() : Node::Sequence{wanted}) {
            if (isThere(one)) continue;
            const bool isPath = axis == "frame" && !profiles.front().isOfElsewhere;
            const char* more = isPath ? "; 'output: {frames: N}' draws N of them" : "";
            throwNotAllowed(one, "layout: where." + axis, shortened(values, " | ") + more);
        }
    }
}

std::string whereText(const Where& where) {
    std::vector<std::string> parts;
    for (const auto& [axis, values] : where) {
        // Of a list the first is its text as a whole.
        const std::vector<std::string> each(values.begin() + (values.size() > 1 ? 1 : 0),
                                            values.end());
        parts.push_back(axis + "=" + joined(each, "|"));
    }
    return joined(parts);
}

/// Each row and each column has a case somewhere; but not where several axes of labels make them,
/// of which some do not go together.
void requireEachPlanned(const config::Layout& layout, std::span<const LayoutCases> profiles,
                        const SourceLocation& where) {
    std::map<Key, Where> rows, columns;  // what is asked for; empty once a case is found
    for (const LayoutCases& cases : profiles) {
        const std::vector<Key> across = collectKeys(layout.columns, cases);
        for (const Key& row : collectKeys(layout.rows, cases)) {
            for (const Key& column : across) {
                if (column.size() == 1 && layout.computed(column[0])) continue;
                const Where asked = whereOf(layout, row, column);
                const bool isPlanned = !casesAt(asked, cases).empty();
                for (Where* of : {&rows.try_emplace(row, asked).first->second,
                                  &columns.try_emplace(column, asked).first->second}) {
                    if (isPlanned) of->clear();
                }
            }
        }
    }
    const auto require = [&](const std::map<Key, Where>& keys, const char* what) {
        for (const auto& [key, asked] : keys) {
            if (key.size() != 1 || asked.empty()) continue;
            throw Error(where, fmt::format("layout: {} '{}' is of no case: none has {}", what,
                                           key.front(), whereText(asked)));
        }
    };
    require(columns, "column");
    require(rows, "row");
}

/// What a column may be called of which no config knows.
constexpr const char* kRepetitions =
    "; what repeats a case has its number in the column 'process', or in 'seed' where each has "
    "random numbers of its own";

bool isNamed(const std::string& axis, const Node& sweep) {
    return std::ranges::any_of(config::expandSweep(sweep), [&](const config::AxisPoint& point) {
        return std::ranges::any_of(point, [&](const auto& one) { return one.key() == axis; });
    });
}

std::string columnOfFile(const std::string& name, const std::vector<std::string>& values) {
    return fmt::format("'{}' ({}), a column of the file; allowed: in 'sweep', as a parameter{}",
                       name, shortened(values, ", "), kRepetitions);
}

/// Throws Error where two such rows have a number of one column each.
void requireOtherNumbers(const config::Experiment& experiment, const Table& table,
                         const TableRow& a, const TableRow& b) {
    const auto isOfBoth = [](const Cell& one, const Cell& other) {
        return !one.values.empty() && !other.values.empty();
    };
    if (!std::ranges::equal(a.cells, b.cells, std::not_fn(isOfBoth))) {
        const auto apart = std::ranges::mismatch(a.labels, b.labels).in1 - a.labels.begin();
        const auto axis = static_cast<std::size_t>(apart);
        throw Error(experiment.document.keyLocation("claims"),
                    "claims: rows that are alike in 'sweep' differ by " +
                        columnOfFile(table.rowAxes[axis], {a.labels[axis], b.labels[axis]}));
    }
}

/// Rows of imported numbers that nobody laid out, and that claims read, are told apart by what the
/// sweep names: two that differ by another column alone may be one number twice.
void requireNamedRows(const config::Experiment& experiment, const Table& table) {
    if (config::isMeasuredHere(experiment) || experiment.claims.empty()) return;
    if (!experiment.sweep.isMap()) return;
    std::map<Key, std::vector<const TableRow*>> alike;  // by the labels on the axes that are named
    for (const TableRow& row : table.rows) {
        Key labels;
        for (std::size_t axis = 0; axis < row.labels.size(); ++axis) {
            if (isNamed(table.rowAxes[axis], experiment.sweep)) labels.push_back(row.labels[axis]);
        }
        std::vector<const TableRow*>& others = alike[labels];
        for (const TableRow* other : others) requireOtherNumbers(experiment, table, *other, row);
        others.push_back(&row);
    }
}

}  // namespace

void requireCases(const config::Experiment& experiment, std::span<const LayoutCases> profiles) {
    const std::vector<const config::Selection*> selections = choosing(experiment.layout);
    if (selections.empty()) return;
    for (const config::Selection* selection : selections) requireValues(*selection, profiles);
    requireEachPlanned(experiment.layout, profiles, experiment.document.keyLocation("layout"));
}

std::string unnamedColumn(const config::Experiment& experiment, const Table& table) {
    if (config::isMeasuredHere(experiment) || !experiment.sweep.isMap()) return "";
    for (std::size_t axis = 0; axis < table.rowAxes.size(); ++axis) {
        std::vector<std::string> values;
        for (const TableRow& row : table.rows) {
            const std::string& label = row.labels[axis];
            if (std::ranges::find(values, label) == values.end()) values.push_back(label);
        }
        if (values.size() > 1 && !isNamed(table.rowAxes[axis], experiment.sweep)) {
            return columnOfFile(table.rowAxes[axis], values);
        }
    }
    return "";
}

void requireToldApart(const config::Experiment& experiment, const Table& table) {
    if (!experiment.layout.isGiven) {
        requireNamedRows(experiment, table);
        return;
    }
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const auto isSuch = [&](bool lacksCurve) {
            return std::ranges::any_of(table.rows, [&](const TableRow& row) {
                return row.cells[i].isPlanned && row.cells[i].lacksCurve == lacksCurve;
            });
        };
        if (!isSuch(true) || isSuch(false)) continue;
        throw Error(experiment.document.keyLocation("layout"),
                    fmt::format("layout: column '{}' has 'equal', and its cells have no curve: "
                                "each needs the values of an axis of numbers that is swept and "
                                "that names neither rows nor columns",
                                table.columns[i].label));
    }
    for (const TableRow& row : table.rows) {
        for (const Cell& cell : row.cells) {
            const auto silent = std::ranges::find(cell.pooled, false, &Pooled::isAsked);
            if (silent == cell.pooled.end()) continue;
            const bool isImported = !config::isMeasuredHere(experiment);
            const bool isSwept = !isImported || isNamed(silent->axis, experiment.sweep);
            throw Error(experiment.document.keyLocation("layout"),
                        fmt::format("layout: each number would be taken over {0} ({1}), which is "
                                    "{2}as an axis of rows or columns, or in a 'where': {{{0}: "
                                    "[{1}]}} takes its values together{3}",
                                    silent->axis, shortened(silent->values, ", "),
                                    isSwept ? "swept; allowed: "
                                            : "a column of the file; allowed: in 'sweep', and ",
                                    isImported ? kRepetitions : ""));
        }
    }
}

void requireStatistics(const config::Experiment& experiment, std::span<const config::Case> planned,
                       const Table& table) {
    const bool hasSeveral = std::ranges::any_of(planned, [](const config::Case& item) {
        return item.measure.frames > 1 || item.measure.repeats > 1;
    });
    if (!experiment.layout.isGiven || hasSeveral || planned.empty()) return;
    const bool isOnce = std::ranges::all_of(
        planned, [](const config::Case& item) { return item.measure.processes == 1; });
    for (const TableRow& row : table.rows) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const TableColumn& column = table.columns[i];
            const bool isOfOne = row.cells[i].isPlanned && row.cells[i].pooled.empty();
            if (!isOfOne || experiment.layout.computed(column.label)) continue;
            const CellQuery query = makeQuery(experiment.layout, row.labels, column.parts);
            for (const CellFormat::Placeholder& shown : query.format.placeholders()) {
                using metrics::Statistic;
                const bool isOfSeveral = shown.statistic == Statistic::Sum ||
                                         shown.statistic == Statistic::Count ||
                                         (isOnce && shown.statistic == Statistic::StdDev);
                if (!isOfSeveral) continue;
                throw Error(query.location,
                            fmt::format("layout: column '{}' shows the {} of one value in each "
                                        "process; allowed: median, or 'output: {{frames}}'",
                                        column.label, shown.name));
            }
        }
    }
}

}  // namespace gfxrepro::tables
