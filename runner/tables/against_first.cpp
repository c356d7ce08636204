#include "runner/tables/against_first.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/text.h"
#include "runner/tables/case_records.h"
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
};

RivalTally rivalTallyOf(const Table& table, std::size_t axis, const std::string& rival,
                        std::size_t column) {
    RivalTally tally;
    for (const TableRow& row : table.rows) {
        const Cell& cell = row.cells[column];
        if (row.labels[axis] != rival || !cell.isOk()) continue;
        const Measured& ratio = cell.values[0];
        const bool isTold = ratio.bounds == Bounds::Interval && ratio.value > 0.0 &&
                            (ratio.interval.high < 1.0 || ratio.interval.low > 1.0);
        const double noise = cell.isTime ? table.wallNoise.value_or(0.0) : 0.0;
        if (!isTold || std::abs(std::log(ratio.value)) <= noise) {
            ++tally.open;
        } else {
            (ratio.value < 1.0 ? tally.less : tally.more).add(ratio.value);
        }
    }
    return tally;
}

}  // namespace

std::vector<std::string> rivalNotes(const Rivals& rivals, const std::vector<std::string>& columns,
                                    const Table& table) {
    std::vector<std::string> notes;
    const auto axis = std::ranges::find(table.rowAxes, rivals.axis);
    for (const std::string& label : columns) {
        const auto column = table.findColumn(label);
        if (!column || axis == table.rowAxes.end()) continue;
        const bool hasIntervals = std::ranges::any_of(table.rows, [&](const TableRow& row) {
            return row.cells[*column].bounds() == Bounds::Interval;
        });
        if (!hasIntervals) continue;
        const bool isTime = std::ranges::any_of(
            table.rows, [&](const TableRow& row) { return row.cells[*column].isTime; });
        for (std::size_t i = 1; i < rivals.values.size(); ++i) {
            const RivalTally tally =
                rivalTallyOf(table, static_cast<std::size_t>(axis - table.rowAxes.begin()),
                             rivals.values[i], *column);
            std::vector<std::string> parts;
            const auto part = [&](const RivalCount& count, const char* what) {
                if (count.rows == 0) return;
                parts.push_back(fmt::format("{} in {} {} ({})", what, count.rows,
                                            count.rows == 1 ? "row" : "rows", count.times()));
            };
            part(tally.less, isTime ? "less time" : "less");
            part(tally.more, isTime ? "more time" : "more");
            if (tally.open > 0) {
                parts.push_back(fmt::format("not to be told apart in {} {}", tally.open,
                                            tally.open == 1 ? "row" : "rows"));
            }
            if (parts.empty()) continue;
            notes.push_back(fmt::format("{}, {} against {}: {}.",
                                        label.substr(0, label.find(" ÷ ")), rivals.values[i],
                                        rivals.values[0], joined(parts, "; ")));
        }
    }
    return notes;
}

}  // namespace gfxrepro::tables
