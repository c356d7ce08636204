// What is written of the values of a cell.
#include <fmt/format.h>

#include "runner/tables/cell.h"

namespace gfxrepro::tables {

namespace {

/// The texts of these numbers, and of them together.
void writeTexts(const CellFormat& format, std::vector<Measured>& numbers, std::string& whole,
                std::string& low, std::string& high) {
    if (numbers.empty()) return;
    std::vector<double> values, lows, highs;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        Measured& measured = numbers[i];
        measured.text = format.formatOne(i, measured.value);
        if (measured.bounds != Bounds::None) {
            measured.low = format.formatOne(i, measured.interval.low);
            measured.high = format.formatOne(i, measured.interval.high);
        }
        values.push_back(measured.value);
        lows.push_back(measured.interval.low);
        highs.push_back(measured.interval.high);
    }
    whole = format.format(values);
    if (numbers.front().bounds == Bounds::None) return;
    low = format.format(lows);
    high = format.format(highs);
}

}  // namespace

void writeValues(const CellFormat& format, Cell& cell) {
    writeTexts(format, cell.values, cell.measured, cell.low, cell.high);
    writeTexts(format, cell.byProcess, cell.measuredByProcess, cell.lowByProcess,
               cell.highByProcess);
}

void writeStatus(std::string_view word, Cell& cell) {
    if (cell.values.empty()) {
        cell.measured = cell.isPlanned ? word : "";
    } else if (cell.status == records::Status::Flaky) {
        cell.measured += " (flaky)";
    } else if (cell.status != records::Status::Ok) {
        cell.isPartial = true;
        cell.measured += fmt::format(" (partial: {})", word);
    }
}

}  // namespace gfxrepro::tables
