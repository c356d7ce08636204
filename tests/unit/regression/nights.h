// Simulated measurements: 3 % noise within a run, 15 % between nights.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "runner/core/random.h"
#include "runner/regression/series.h"

namespace gfxrepro::regression::test {

inline double normal(Random& random) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - static_cast<double>(random.uniform())));
    return radius * std::cos(2.0 * std::numbers::pi * static_cast<double>(random.uniform()));
}

inline SeriesKey timeOf(const std::string& method) {
    return {"p/1", "mock", method, "", "{}", "", "gpu_time_ms", "ms"};
}

/// `rounds` processes of each of `methods` methods; all of a night share its machine's factor.
inline SeriesMap measured(Random& random, int methods, int rounds, double nightFactor,
                          double change = 1.0) {
    SeriesMap series;
    for (int method = 0; method < methods; ++method) {
        Series& values = series[timeOf("m" + std::to_string(method))];
        for (int round = 0; round < rounds; ++round) {
            values.push_back((10.0 + method) * nightFactor * change *
                             std::exp(0.03 * normal(random)));
        }
    }
    return series;
}

inline double nightFactor(Random& random) {
    return std::exp(0.15 * normal(random));
}

}  // namespace gfxrepro::regression::test
