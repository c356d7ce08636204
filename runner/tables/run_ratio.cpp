#include "runner/tables/run_ratio.h"

#include <cmath>

namespace gfxrepro::tables {

std::optional<RunRatio> ratioOfRuns(const Cell& later, const Cell& earlier) {
    if (!later.isOk() || !earlier.isOk()) return std::nullopt;
    const Measured &b = later.values[0], &a = earlier.values[0];
    const auto isPositive = [](double value) { return value > 0.0 && std::isfinite(value); };
    if (!isPositive(a.value) || !isPositive(b.value)) return std::nullopt;
    RunRatio result{b.value / a.value, {}};
    for (const Measured* one : {&a, &b}) {
        if (one->bounds != Bounds::Interval) return result;
        if (!isPositive(one->interval.low) || !isPositive(one->interval.high)) return result;
    }
    const auto apart = [](double x, double y) { return std::log(x / y); };
    const double below =
        std::hypot(apart(b.value, b.interval.low), apart(a.interval.high, a.value));
    const double above =
        std::hypot(apart(b.interval.high, b.value), apart(a.value, a.interval.low));
    result.interval = {result.ratio * std::exp(-below), result.ratio * std::exp(above)};
    return result;
}

}  // namespace gfxrepro::tables
