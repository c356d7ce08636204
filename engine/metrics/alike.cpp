#include "engine/metrics/alike.h"

#include <algorithm>
#include <cmath>

namespace gfxrepro::metrics {

bool areAlike(double a, double b) {
    constexpr double kRounding = 1e-12;
    if (a == b) return true;
    const double largest = std::max(std::abs(a), std::abs(b));
    const bool areCounts = a == std::floor(a) && b == std::floor(b) && largest < 0x1p53;
    return !areCounts && !std::isinf(largest) && std::abs(a - b) <= kRounding * largest;
}

}  // namespace gfxrepro::metrics
