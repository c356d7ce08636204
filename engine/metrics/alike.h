// Which values are one number: those that differ by rounding alone.
#pragma once

#include <span>
#include <vector>

namespace gfxrepro::metrics {

/// Whether two values differ by no more than a sum of doubles in another order: they are equal.
/// Whole numbers as far as doubles count them are counts, and exact.
bool areAlike(double a, double b);

/// Each value, or the first of them that it is alike.
std::vector<double> withoutRounding(std::span<const double> values);

/// The value with another rounding, which is alike; a large count as it is.
double roundedOtherwise(double value);

}  // namespace gfxrepro::metrics
