// The plots of a table that nobody laid out: the error of a picture, that over time, the times;
// without such an error what else is better one way.
#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "engine/core/text.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

namespace {

struct Axis {
    std::size_t index;
    std::vector<double> numbers;  // those of its labels; empty where one is none
    std::size_t count = 0;        // of its labels
};

Axis axisOf(const Table& table, std::size_t index) {
    std::set<std::string> labels;
    std::set<double> numbers;
    for (const TableRow& row : table.rows) {
        labels.insert(row.labels[index]);
        if (const auto number = parseDouble(row.labels[index])) numbers.insert(*number);
    }
    const bool isOfNumbers = numbers.size() == labels.size();
    return {
        index,
        isOfNumbers ? std::vector<double>(numbers.begin(), numbers.end()) : std::vector<double>(),
        labels.size()};
}

/// Values over several powers of two are told apart on a logarithmic axis alone.
bool isWide(double least, double most, double factor) {
    return least > 0.0 && most / least >= factor;
}

bool isWide(const Table& table, const std::vector<std::string>& columns) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (std::ranges::find(columns, table.columns[i].label) == columns.end()) continue;
        for (const TableRow& row : table.rows) {
            if (row.cells[i].values.empty()) continue;
            least = std::min(least, row.cells[i].values[0].value);
            most = std::max(most, row.cells[i].values[0].value);
        }
    }
    return isWide(least, most, 20.0);
}

std::size_t measuredCount(const Table& table, std::size_t column) {
    return static_cast<std::size_t>(std::ranges::count_if(
        table.rows, [&](const TableRow& row) { return row.cells[column].isOk(); }));
}

/// The largest of what was measured.
double mostOf(const Table& table, std::size_t column) {
    double most = 0.0;
    for (const TableRow& row : table.rows) {
        const Cell& cell = row.cells[column];
        if (!cell.values.empty()) most = std::max(most, cell.values[0].value);
    }
    return most;
}

/// What the plots of a table show, by their columns' labels.
struct PlotColumns {
    std::vector<std::string> times;   // the one that leads, and those beside it that one can see
    std::vector<std::string> errors;  // the first of a picture
    std::vector<std::string> others;  // the first that is better one way; memory behind others
};

PlotColumns plotColumns(const Table& table, std::size_t mostTimes) {
    constexpr double kSeen = 0.01;
    PlotColumns plots;
    std::vector<std::string> memory;
    double leading = 0.0;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const TableColumn& column = table.columns[i];
        if (measuredCount(table, i) < 2) continue;
        const Cell& cell = table.rows.front().cells[i];
        if (cell.isTime && column.label.ends_with("_ms") && plots.times.size() < mostTimes) {
            const double most = mostOf(table, i);
            if (plots.times.empty()) leading = most;
            if (most >= kSeen * leading) plots.times.push_back(column.label);
        }
        if (config::isPictureError(cell.metric) && plots.errors.empty()) {
            plots.errors.push_back(column.label);
        }
        if (cell.isTime || column.better == config::Better::Neither) continue;
        const bool isMemory = cell.unit == "byte" || column.label.ends_with("_mib");
        std::vector<std::string>& others = isMemory ? memory : plots.others;
        if (others.empty()) others.push_back(column.label);
    }
    if (plots.others.empty()) plots.others = std::move(memory);
    return plots;
}

}  // namespace

std::vector<config::PlotSpec> defaultPlots(const Table& table) {
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < table.rowAxes.size(); ++i) axes.push_back(axisOf(table, i));
    const auto x =
        std::ranges::max_element(axes, {}, [](const Axis& axis) { return axis.numbers.size(); });
    if (x == axes.end() || x->numbers.size() < 2) return {};
    config::PlotSpec plot;
    for (const Axis& axis : axes) {
        if (axis.index == x->index) continue;
        if (!plot.by && axis.count > 1) {
            plot.by = table.rowAxes[axis.index];
        } else {
            plot.panels.push_back(table.rowAxes[axis.index]);
        }
    }
    constexpr std::size_t kMostCurves = 6;
    const PlotColumns columns = plotColumns(table, plot.by ? 1 : kMostCurves);
    std::vector<config::PlotSpec> plots;
    const auto add = [&](const std::string& over, bool isLogX, const std::vector<std::string>& y) {
        if (y.empty()) return;
        const auto first = std::ranges::find(table.columns, y[0], &TableColumn::label);
        plot.x = over;
        plot.y = y;
        plot.isLogX = isLogX;
        plot.isLogY = isWide(table, y);
        plot.title =
            fmt::format("{} over {}",
                        y.size() > 1 ? "Times" : quantityOf(y[0], table.words, first->unit).text(),
                        quantityOf(over, table.words).words);
        if (const auto better = config::betterText(first->better); !better.empty()) {
            plot.title += fmt::format(" ({})", better);
        }
        plots.push_back(plot);
    };
    const std::string& axis = table.rowAxes[x->index];
    const bool isLogAxis = isWide(x->numbers.front(), x->numbers.back(), 4.0);
    add(axis, isLogAxis, columns.errors);
    if (!columns.times.empty()) {
        add(columns.times[0], isWide(table, {columns.times[0]}), columns.errors);
    }
    add(axis, isLogAxis, columns.times);
    if (columns.errors.empty()) add(axis, isLogAxis, columns.others);
    return plots;
}

}  // namespace gfxrepro::tables
