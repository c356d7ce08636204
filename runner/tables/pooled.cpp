// Cells that take several cases together: what is said of them.
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>

#include "engine/core/text.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

namespace {

constexpr std::size_t kMostSaid = 4;  // values of an axis, rows, columns

/// "a, b", or how many there are.
std::string listed(const std::vector<std::string>& names, const char* what, const Words& words) {
    if (names.size() > kMostSaid) return fmt::format("{} {}", names.size(), what);
    std::vector<std::string> said;
    for (const std::string& name : names) said.push_back(valueInWords(name, words));
    return joined(said);
}

/// Cells that take their cases together along the same axes.
struct Pool {
    std::vector<Pooled> axes;
    std::set<std::size_t> rows, columns;
    std::size_t count = 0;

    void add(const std::vector<Pooled>& pooled) {
        axes.resize(pooled.size());
        for (std::size_t i = 0; i < pooled.size(); ++i) {
            axes[i].axis = pooled[i].axis;
            for (const std::string& value : pooled[i].values) {
                const bool isNew = std::ranges::find(axes[i].values, value) == axes[i].values.end();
                if (isNew) axes[i].values.push_back(value);
            }
        }
        ++count;
    }
};

/// How many planned cells lie in these rows and columns.
template <class Rows, class Columns>
std::size_t plannedCount(const Table& table, const Rows& hasRow, const Columns& hasColumn) {
    std::size_t count = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            count += table.rows[row].cells[i].isPlanned && hasRow(row) && hasColumn(i);
        }
    }
    return count;
}

/// "Each number", "Each number of row average", "Each number of column rmse", "3 numbers".
std::string subjectOf(const Pool& pool, const Table& table) {
    const auto any = [](std::size_t) { return true; };
    const auto inRows = [&](std::size_t row) { return pool.rows.contains(row); };
    const auto inColumns = [&](std::size_t column) { return pool.columns.contains(column); };
    if (pool.count == plannedCount(table, any, any)) return "Each number is";
    std::vector<std::string> names;
    if (pool.count == plannedCount(table, inRows, any)) {
        for (const std::size_t row : pool.rows) names.push_back(joined(table.rows[row].labels));
        return fmt::format("Each number of row{} {} is", names.size() > 1 ? "s" : "",
                           listed(names, "of the table", table.words));
    }
    if (pool.count == plannedCount(table, any, inColumns)) {
        for (const std::size_t i : pool.columns) names.push_back(table.columns[i].label);
        return fmt::format("Each number of column{} {} is", names.size() > 1 ? "s" : "",
                           listed(names, "of the table", table.words));
    }
    return fmt::format("{} number{}", pool.count, pool.count == 1 ? " is" : "s are");
}

}  // namespace

std::vector<std::string> pooledNotes(const Table& table) {
    std::map<std::string, Pool> pools;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const Cell& cell = table.rows[row].cells[i];
            if (!cell.isPlanned || cell.pooled.empty()) continue;
            std::vector<std::string> axes;
            for (const Pooled& pooled : cell.pooled) axes.push_back(pooled.axis);
            Pool& pool = pools[joined(axes)];
            pool.add(cell.pooled);
            pool.rows.insert(row);
            pool.columns.insert(i);
        }
    }
    std::vector<std::string> notes;
    for (const auto& [axes, pool] : pools) {
        std::vector<std::string> over;
        for (const Pooled& pooled : pool.axes) {
            over.push_back(fmt::format("{} ({})", quantityOf(pooled.axis, table.words).words,
                                       listed(pooled.values, "values", table.words)));
        }
        notes.push_back(
            fmt::format("{} taken over {}.", subjectOf(pool, table), joined(over, " and ")));
    }
    return notes;
}

std::string pooledText(const Cell& cell) {
    std::vector<std::string> parts;
    for (const Pooled& pooled : cell.pooled) {
        parts.push_back(pooled.axis + "=" + joined(pooled.values, "|"));
    }
    return joined(parts, "; ");
}

void requireToldApart(const config::Experiment& experiment, const Table& table) {
    if (!experiment.layout.isGiven) return;
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
            throw Error(experiment.document.keyLocation("layout"),
                        fmt::format("layout: each number would be taken over {0} ({1}), which is "
                                    "swept; allowed: as an axis of rows or columns, or in a "
                                    "'where': {{{0}: [{1}]}} takes its values together",
                                    silent->axis, joined(silent->values)));
        }
    }
}

}  // namespace gfxrepro::tables
