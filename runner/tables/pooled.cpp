// That cells take several cases together: along which axes, and what is said of it below their
// table; and of which statistics they are.
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

/// "a, b", or how many values there are.
std::string listed(const std::vector<std::string>& values, const Words& words) {
    if (values.size() > kMostSaid) return fmt::format("{} values", values.size());
    std::vector<std::string> said;
    for (const std::string& value : values) said.push_back(valueInWords(value, words));
    return joined(said);
}

/// "column a", "columns a, b", or "7 columns".
std::string named(const char* what, const std::vector<std::string>& names) {
    if (names.size() > kMostSaid) return fmt::format("{} {}s", names.size(), what);
    return fmt::format("{}{} {}", what, names.size() > 1 ? "s" : "", joined(names));
}

std::string columnsNamed(const std::set<std::size_t>& columns, const Table& table) {
    std::vector<std::string> names;
    for (const std::size_t i : columns) {
        names.push_back(quantityOf(table.columns[i], table.words).text());
    }
    return named("column", names);
}

std::string rowsNamed(const std::set<std::size_t>& rows, const Table& table) {
    std::vector<std::string> names;
    for (const std::size_t row : rows) {
        std::vector<std::string> labels;
        for (const std::string& label : table.rows[row].labels) {
            labels.push_back(valueInWords(label, table.words));
        }
        names.push_back(joined(labels));
    }
    return named("row", names);
}

/// Cells that take their cases together along the same axes: the same values of them, or, where
/// there would be too much to say, each some of these.
struct Pool {
    std::vector<Pooled> axes;
    std::set<std::size_t> rows, columns;
    std::size_t count = 0;
    bool isOfSome = false;

    void add(const Pool& other) {
        if (axes.empty()) axes = other.axes;
        isOfSome |= axes != other.axes;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            for (const std::string& value : other.axes[i].values) {
                const bool isNew = std::ranges::find(axes[i].values, value) == axes[i].values.end();
                if (isNew) axes[i].values.push_back(value);
            }
        }
        rows.insert(other.rows.begin(), other.rows.end());
        columns.insert(other.columns.begin(), other.columns.end());
        count += other.count;
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
    if (pool.count == plannedCount(table, inRows, any)) {
        return fmt::format("Each number of {} is", rowsNamed(pool.rows, table));
    }
    if (pool.count == plannedCount(table, any, inColumns)) {
        return fmt::format("Each number of {} is", columnsNamed(pool.columns, table));
    }
    if (pool.count == plannedCount(table, inRows, inColumns)) {
        return fmt::format("Each number of {} in {} is", columnsNamed(pool.columns, table),
                           rowsNamed(pool.rows, table));
    }
    return fmt::format("{} number{}", pool.count, pool.count == 1 ? " is" : "s are");
}

/// Those of other values of their axes apart, unless there are too many.
std::vector<Pool> poolsOf(const Table& table) {
    std::map<std::string, std::vector<Pool>> byAxes;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const Cell& cell = table.rows[row].cells[i];
            if (!cell.isPlanned || cell.pooled.empty()) continue;
            std::vector<std::string> axes;
            for (const Pooled& pooled : cell.pooled) axes.push_back(pooled.axis);
            std::vector<Pool>& pools = byAxes[joined(axes)];
            auto same = std::ranges::find(pools, cell.pooled, &Pool::axes);
            if (same == pools.end()) same = pools.insert(pools.end(), Pool{});
            same->add({cell.pooled, {row}, {i}, 1});
        }
    }
    std::vector<Pool> all;
    for (const auto& [axes, pools] : byAxes) {
        if (pools.size() <= kMostSaid) {
            all.insert(all.end(), pools.begin(), pools.end());
            continue;
        }
        Pool& whole = all.emplace_back();
        for (const Pool& pool : pools) whole.add(pool);
    }
    return all;
}

/// Of which statistics the numbers are, where they are not medians of processes.
std::vector<std::string> statisticNotes(const Table& table) {
    std::map<std::string, std::set<std::size_t>> inProcesses, overProcesses;  // columns
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        for (const TableRow& row : table.rows) {
            for (const Measured& one : row.cells[i].values) {
                const bool isOfRounds =
                    one.statistic != "median" && !one.areDraws && one.rounds.size() > 1;
                if (one.isOverProcesses) overProcesses[one.statistic].insert(i);
                if (isOfRounds && one.interval.low != one.interval.high) {
                    inProcesses[one.statistic].insert(i);
                }
            }
        }
    }
    std::vector<std::string> notes;
    for (const auto& [statistic, columns] : inProcesses) {
        notes.push_back(
            fmt::format("In {} the {} is taken in each process; a number and its bounds are of the "
                        "median process.",
                        columnsNamed(columns, table), statistic));
    }
    for (const auto& [statistic, columns] : overProcesses) {
        notes.push_back(
            fmt::format("In {} the {} is over processes, and has no interval: what is rare moves "
                        "it by any amount. No claim is decided by it.",
                        columnsNamed(columns, table), statistic));
    }
    return notes;
}

}  // namespace

std::vector<Pooled> pooledAt(const CellQuery& query, const LayoutCases& cases) {
    std::vector<const CaseRecords*> found = casesAt(query.where, cases);
    // A file may tell one metric of some cases, and another of others.
    if (cases.isOfElsewhere && !query.equal) {
        std::erase_if(found, [&](const CaseRecords* one) {
            return one->isWithout(query.metric, query.pass);
        });
    }
    std::vector<Pooled> all;
    for (std::size_t axis = 0; axis < cases.axes.size() && found.size() > 1; ++axis) {
        Pooled pooled{cases.axes[axis], {}, axis < cases.namedAxes};
        std::set<std::string> seen;
        for (const CaseRecords* item : found) {
            const std::string value = item->axes[axis].value_or(std::string(kLeftOut));
            if (seen.insert(value).second) pooled.values.push_back(value);
        }
        if (pooled.values.size() > 1) all.push_back(std::move(pooled));
    }
    return all;
}

std::string onceAlong(const CellQuery& query, const LayoutCases& cases,
                      std::span<const Pooled> pooled) {
    // Other scenes, sizes of a picture and frames that are asked for here are no repetitions.
    const auto isOther = [&](const Pooled& one) {
        const bool isSwept = std::ranges::find(cases.axes, one.axis) != cases.axes.end();
        const bool isSampled =
            (one.axis == "frame" && !cases.isOfElsewhere) || (one.axis == "scene_seed" && !isSwept);
        return isSampled || one.axis == kSeedAxis || one.axis == "scene" ||
               one.axis.starts_with("output.") || one.axis.starts_with(config::kSceneAxisPrefix);
    };
    const auto axis = std::ranges::find_if_not(pooled, isOther);
    if (!cases.isOfProgram || axis == pooled.end()) return "";
    const auto isOnce = [&](const CaseRecords* one) {
        const bool hasSeeds = one->seeds != config::Measure::Seeds::None || one->sweptSeed;
        const bool isSeeded = hasSeeds && !one->isWithoutFrame(query.metric, query.pass);
        return !isSeeded && !one->isWithout(query.metric, query.pass) &&
               one->isOfItsSeed(query.metric) && !one->isTakenAgain(query.metric, query.pass);
    };
    return std::ranges::any_of(casesAt(query.where, cases), isOnce) ? axis->axis : "";
}

std::vector<std::string> cellNotes(const Table& table) {
    std::vector<std::string> notes = statisticNotes(table);
    for (const Pool& pool : poolsOf(table)) {
        std::vector<std::string> over;
        for (const Pooled& pooled : pool.axes) {
            over.push_back(fmt::format("{} ({}{})", quantityOf(pooled.axis, table.words).words,
                                       pool.isOfSome ? "some of " : "",
                                       listed(pooled.values, table.words)));
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

}  // namespace gfxrepro::tables
