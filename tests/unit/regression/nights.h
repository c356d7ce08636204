// Simulated measurements: noise between processes, and 15 % between nights.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "engine/core/random.h"
#include "runner/regression/series.h"

namespace gfxrepro::regression::test {

inline double normal(Random& random) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - static_cast<double>(random.uniform())));
    return radius * std::cos(2.0 * std::numbers::pi * static_cast<double>(random.uniform()));
}

inline SeriesKey timeOf(const std::string& method) {
    return {"p/1", "mock", method, "", "{}", "", "wall_time_ms", "ms"};
}

/// Standard deviation of CPU time between processes, as of the quietest series of the watch
/// (recorded_watch.h).
inline constexpr double kCpuNoise = 0.08;

/// `rounds` processes of each of `methods` methods; all of a night share its machine's factor. One
/// process of twenty is disturbed, and takes up to half as long again. The methods are of nine
/// tables. The first method alone takes
/// `firstChange` times as long.
inline SeriesMap measured(Random& random, int methods, int rounds, double nightFactor,
                          double change = 1.0, double noise = 0.03, double firstChange = 1.0) {
    SeriesMap series;
    for (int method = 0; method < methods; ++method) {
        SeriesKey key = timeOf("m" + std::to_string(method));
        key.table = "p/" + std::to_string(1 + method % 9);
        Series& values = series[key];
        const double level =
            (10.0 + method) * nightFactor * change * (method == 0 ? firstChange : 1.0);
        for (int round = 0; round < rounds; ++round) {
            const bool isDisturbed = random.uniform() < 0.05F;
            const double disturbed =
                isDisturbed ? 1.0 + 0.5 * static_cast<double>(random.uniform()) : 1.0;
            values.push_back(level * disturbed * std::exp(noise * normal(random)));
        }
    }
    return series;
}

inline double nightFactor(Random& random) {
    return std::exp(0.15 * normal(random));
}

}  // namespace gfxrepro::regression::test
