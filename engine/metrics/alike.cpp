#include "engine/metrics/alike.h"

#include <algorithm>
#include <cmath>

namespace gfxrepro::metrics {

namespace {

constexpr double kAlike = 1e-12;

bool isCount(double value) {
    return value == std::floor(value) && std::abs(value) < 0x1p53;
}

}  // namespace

bool areAlike(double a, double b) {
    if (a == b) return true;
    const double largest = std::max(std::abs(a), std::abs(b));
    const bool areCounts = isCount(a) && isCount(b);
    return !areCounts && !std::isinf(largest) && std::abs(a - b) <= kAlike * largest;
}

std::vector<double> withoutRounding(std::span<const double> values) {
    std::vector<double> result;
    for (const double value : values) {
        const auto same =
            std::ranges::find_if(result, [&](double other) { return areAlike(value, other); });
        result.push_back(same == result.end() ? value : *same);
    }
    return result;
}

double roundedOtherwise(double value) {
    constexpr double kLargest = 1e9;
    const bool isLarge = isCount(value) && std::abs(value) > kLargest;
    return isLarge ? value : value * (1.0 + kAlike);
}

}  // namespace gfxrepro::metrics
