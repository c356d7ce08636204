// How near what was measured comes to what a document printed: the cells at the printed parameters.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// A printed number beside one that was measured at the parameters that the document gives.
struct NearCell {
    std::size_t row = 0, column = 0;  // of its table
    double printed = 0.0, measured = 0.0;
    bool isTime = false;  // or a rate of one: of another machine

    double ratio() const { return measured / printed; }
    bool isWithin(double low, double high) const { return ratio() >= low && ratio() <= high; }
};

/// What is told of a ratio.
inline constexpr double kTenthLow = 0.9, kTenthHigh = 1.1, kTwiceLow = 0.5, kTwiceHigh = 2.0;

/// Those of one table, and how many have no place among them.
struct Nearness {
    std::vector<NearCell> cells;
    std::size_t calibrated = 0;  // an input was fitted to what is printed
    std::size_t zeros = 0;       // printed as 0, of which nothing is a multiple
};

/// Of a published table whose config says what is printed. A cell with several statistics counts
/// with the first of them that is printed.
Nearness nearnessOf(const config::Experiment& experiment, const Table& table);

/// "How near: of 40 numbers, no times, that were measured at the parameters that the document
/// gives, 10 lie within 10 % of the printed ones and 30 within a factor of 2. Of 12 times …"; empty
/// without any.
std::string nearnessLine(std::span<const Nearness> tables);

}  // namespace gfxrepro::tables
