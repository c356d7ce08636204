#include "runner/tables/against_first.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "engine/core/text.h"
#include "engine/metrics/statistics.h"
#include "runner/tables/case_records.h"
#include "runner/tables/frame_times.h"
#include "runner/tables/labels.h"

namespace gfxrepro::tables {

Rivals rivalsOf(const std::vector<const config::Case*>& cases) {
    std::vector<Rivals> axes;
    for (const config::Case* item : cases) {
        for (const auto& [name, value] : item->axes.entries()) {
            const auto found = std::ranges::find(axes, name, &Rivals::axis);
            Rivals& axis = found != axes.end() ? *found : axes.emplace_back(Rivals{name, {}});
            const std::string text = canonicalText(value);
            if (std::ranges::find(axis.values, text) == axis.values.end()) {
                axis.values.push_back(text);
            }
        }
    }
    const auto isWord = [](const std::string& value) {
        return !value.empty() && !parseDouble(value) && value != "true" && value != "false" &&
               value != kLeftOut && value.find_first_of("[],='\"") == value.npos;
    };
    for (Rivals& axis : axes) {
        const bool isSuch = axis.axis != "scene" && axis.values.size() > 1 &&
                            std::ranges::all_of(axis.values, isWord);
        if (isSuch) return axis;
    }
    return {};
}

std::pair<std::string, config::Selection> columnAgainst(const Rivals& rivals,
                                                        const std::string& column,
                                                        const config::Experiment& experiment) {
    config::Selection selection;
    selection.of = fmt::format("{0} / {0}[{1}={2}]", column, rivals.axis, rivals.values[0]);
    selection.format = "{median:.3g}";
    return {fmt::format("{} ÷ {}", quantityOf(column, experiment.labels).words, rivals.values[0]),
            std::move(selection)};
}

namespace {

/// The rows in which a rival is less, or more, than the first, and by how much.
struct RivalCount {
    std::size_t rows = 0;
    double least = std::numeric_limits<double>::infinity(), most = 0.0;

    void add(double ratio) {
        ++rows;
        least = std::min(least, ratio);
        most = std::max(most, ratio);
    }
    /// "0.85 times", "0.85 to 0.91 times".
    std::string times() const {
        const std::string from = fmt::format("{:.3g}", least), to = fmt::format("{:.3g}", most);
        return from == to ? from + " times" : from + " to " + to + " times";
    }
};

struct RivalTally {
    RivalCount less, more;
    std::size_t open = 0;

    std::size_t rows() const { return less.rows + more.rows + open; }
};

/// The cells of a column that divides by the first rival, and how they are told from 1.
struct RivalCells {
    std::size_t axis, column;
    Clock clock;
    double noise;  // of the times that are divided; 0 of what are none
    /// Of each row the chance that one of all came out as far from 1; 0 of what does not scatter.
    std::map<std::size_t, double> chances = {};

    const Measured* ratioOf(const Cell& cell) const {
        const Measured* ratio = cell.isOk() ? cell.find("", clock) : nullptr;
        return ratio && ratio->value > 0.0 ? ratio : nullptr;
    }
    bool isTold(std::size_t row, const Measured& ratio) const {
        constexpr double kBothEnds = 0.05;
        const bool isSure = ratio.bounds == Bounds::Interval &&
                            (ratio.interval.high < 1.0 || ratio.interval.low > 1.0);
        const auto chance = chances.find(row);
        return isSure && std::abs(std::log(ratio.value)) > noise &&
               (chance == chances.end() || chance->second <= kBothEnds);
    }
};

/// Looks at all rows and rivals together: of many some are apart by chance.
void findChances(const Table& table, const std::string& first, RivalCells& cells) {
    std::vector<std::size_t> rows;
    std::vector<std::map<int, double>> series;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const Measured* ratio = cells.ratioOf(table.rows[row].cells[cells.column]);
        const bool isOther = table.rows[row].labels[cells.axis] != first;
        if (!isOther || !ratio || ratio->areDraws || ratio->bounds != Bounds::Interval) continue;
        std::map<int, double> logs;
        bool isCertain = true, isPositive = true;
        for (const auto& [round, value] : ratio->rounds) {
            isCertain &= value == ratio->value;
            isPositive &= value > 0.0;
            logs[round] = std::log(value);
        }
        if (isCertain || !isPositive) continue;
        rows.push_back(row);
        series.push_back(std::move(logs));
    }
    if (series.size() < 2) return;
    const std::vector<double> chances = metrics::jointChances(series, true);
    for (std::size_t i = 0; i < rows.size(); ++i) cells.chances[rows[i]] = chances[i];
}

/// Marks the cells that are not apart.
RivalTally rivalTallyOf(Table& table, const RivalCells& cells, const std::string& rival) {
    RivalTally tally;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        TableRow& row = table.rows[i];
        const Measured* ratio = cells.ratioOf(row.cells[cells.column]);
        if (row.labels[cells.axis] != rival || !ratio) continue;
        const bool isTold = cells.isTold(i, *ratio);
        row.cells[cells.column].isWithinNoise = !isTold;
        if (!isTold) {
            ++tally.open;
        } else {
            (ratio->value < 1.0 ? tally.less : tally.more).add(ratio->value);
        }
    }
    return tally;
}

/// What less and more of the metric is called, and what of a rival is divided.
struct RivalWords {
    const char *less, *more, *what;

    static RivalWords of(const std::string& metric, Clock clock) {
        if (config::isTimeMetric(metric)) {
            return {"faster", "slower", clock == Clock::Process ? "CPU time" : "time"};
        }
        if (config::isPictureError(metric)) {
            return {"nearer to its truth", "farther from its truth", "error"};
        }
        return {"lower", "higher", "value"};
    }
};

/// "fast is faster than plain in 2 of 3 rows (0.85 to 0.91 times its time)".
std::string rivalSentence(const RivalTally& tally, const std::string& rival,
                          const std::string& first, const RivalWords& words) {
    std::vector<std::string> parts;
    const auto part = [&](std::size_t rows, const std::string& what, const std::string& times) {
        if (rows == 0) return;
        const std::string where = tally.rows() == 1 ? "the one row"
                                  : rows == tally.rows()
                                      ? fmt::format("all {} rows", rows)
                                      : fmt::format("{} of {} rows", rows, tally.rows());
        parts.push_back(fmt::format("{} in {}{}", what, where, times));
    };
    const auto compared = [&](const RivalCount& count, const char* what) {
        part(count.rows, fmt::format("{} is {} than {}", rival, what, first),
             fmt::format(" ({} its {})", count.times(), words.what));
    };
    compared(tally.less, words.less);
    compared(tally.more, words.more);
    if (tally.open > 1 && tally.open == tally.rows()) {
        return fmt::format("{} and {} cannot be told apart in any of {} rows", rival, first,
                           tally.open);
    }
    part(tally.open, fmt::format("{} and {} cannot be told apart", rival, first), "");
    return joined(parts, "; ");
}

}  // namespace

void compareRivals(const Rivals& rivals, const std::vector<std::string>& columns, Table& table) {
    std::vector<std::string> told, open;
    const auto axis = std::ranges::find(table.rowAxes, rivals.axis);
    for (const std::string& label : columns) {
        const auto column = table.findColumn(label);
        if (!column || axis == table.rowAxes.end()) continue;
        std::string metric;
        bool hasIntervals = false, hasProcessTimes = !table.goesByClock;
        for (const TableRow& row : table.rows) {
            const Cell& cell = row.cells[*column];
            hasProcessTimes &= cell.values.empty() || !cell.byProcess.empty();
            if (cell.bounds() != Bounds::Interval) continue;
            hasIntervals = true;
            metric = row.cells[*column - 1].metric;  // of the column beside which it stands
        }
        if (!hasIntervals) continue;
        const std::string& divided = table.columns[*column - 1].label;
        const Clock clock = hasProcessTimes ? Clock::Process : Clock::Wall;
        const bool isTime = config::isTimeMetric(metric);
        RivalCells cells{static_cast<std::size_t>(axis - table.rowAxes.begin()), *column, clock,
                         isTime ? columnNoise(table, {divided}, clock).value_or(0.0) : 0.0};
        findChances(table, rivals.values[0], cells);
        if (hasProcessTimes)
            table.judgedByProcess.insert(table.judgedByProcess.end(), {divided, label});
        for (std::size_t i = 1; i < rivals.values.size(); ++i) {
            const RivalTally tally = rivalTallyOf(table, cells, rivals.values[i]);
            if (tally.rows() == 0) continue;
            (tally.open == tally.rows() ? open : told)
                .push_back(fmt::format("{}: {}.", label.substr(0, label.find(" ÷ ")),
                                       rivalSentence(tally, rivals.values[i], rivals.values[0],
                                                     RivalWords::of(metric, clock))));
        }
    }
    table.toldNotes = told.size();
    table.notes.insert(table.notes.begin(), open.begin(), open.end());
    table.notes.insert(table.notes.begin(), told.begin(), told.end());
}

}  // namespace gfxrepro::tables
