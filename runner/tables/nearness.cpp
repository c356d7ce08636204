#include "runner/tables/nearness.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "engine/core/text.h"

namespace gfxrepro::tables {

Nearness nearnessOf(const config::Experiment& experiment, const Table& table) {
    Nearness near;
    const bool isKnown = table.knowsPrintedParameters && !table.isPrintUnsaid;
    if (experiment.kind != config::ExperimentKind::Table || !isKnown) return near;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            const Cell& cell = table.rows[row].cells[column];
            if (!cell.isAtPrintedParameters || !cell.isOk()) continue;
            const auto isThere = [](const auto& value) { return value.has_value(); };
            const auto first = std::ranges::find_if(cell.printedValues, isThere);
            if (first == cell.printedValues.end()) continue;
            const auto which = static_cast<std::size_t>(first - cell.printedValues.begin());
            if (which >= cell.values.size() || !std::isfinite(cell.values[which].value)) continue;
            if (cell.isCalibrated) {
                ++near.calibrated;
            } else if (**first == 0.0) {
                ++near.zeros;
            } else {
                near.cells.push_back({row, column, **first, cell.values[which].value, cell.isTime});
            }
        }
    }
    return near;
}

namespace {

struct NearCount {
    std::size_t all = 0, tenth = 0, twice = 0;

    std::string text() const {
        const auto said = [](std::size_t count) {
            return count == 0 ? "none" : std::to_string(count);
        };
        return fmt::format("{} lie{} within 10 % of the printed one{}, {} within a factor of 2",
                           said(tenth), tenth < 2 ? "s" : "", all == 1 ? "" : "s", said(twice));
    }
};

}  // namespace

std::string nearnessLine(std::span<const Nearness> tables) {
    NearCount numbers, times;
    std::size_t calibrated = 0, zeros = 0;
    for (const Nearness& table : tables) {
        calibrated += table.calibrated;
        zeros += table.zeros;
        for (const NearCell& cell : table.cells) {
            NearCount& count = cell.isTime ? times : numbers;
            ++count.all;
            count.tenth += cell.isWithin(kTenthLow, kTenthHigh) ? 1 : 0;
            count.twice += cell.isWithin(kTwiceLow, kTwiceHigh) ? 1 : 0;
        }
    }
    std::string line;
    if (numbers.all > 0) {
        line += fmt::format(
            " {} printed number{} that {} no time{} {} measured at the parameters "
            "that the document gives: {}.",
            numbers.all, numbers.all == 1 ? "" : "s", numbers.all == 1 ? "is" : "are",
            numbers.all == 1 ? "" : "s", numbers.all == 1 ? "was" : "were", numbers.text());
    }
    if (times.all > 0) {
        line += fmt::format(" Of {} time{} or rate{}, printed on another machine, {}.", times.all,
                            times.all == 1 ? "" : "s", times.all == 1 ? "" : "s", times.text());
    }
    if (line.empty()) return "";
    std::vector<std::string> left;
    if (calibrated > 0) {
        left.push_back(fmt::format("{} to which an input of ours was fitted", calibrated));
    }
    if (zeros > 0) left.push_back(fmt::format("{} printed as 0", zeros));
    if (!left.empty()) line += fmt::format(" Left out: {}.", joined(left, "; "));
    return "How near:" + line;
}

}  // namespace gfxrepro::tables
