// Which values are one number: those that differ by rounding alone.
#pragma once

namespace gfxrepro::metrics {

/// Whether two values differ by no more than a sum of doubles in another order: they are equal.
/// Whole numbers as far as doubles count them are counts, and exact.
bool areAlike(double a, double b);

}  // namespace gfxrepro::metrics
