#include "runner/report/gnuplot_axis.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>

namespace gfxrepro::report {

namespace {

constexpr double kRoom = 0.05;  // on each side, of the axis

/// "2·10⁶" beyond `plain`, "10⁻⁷" below a thousandth; else as it is.
std::string ticText(double value, double plain) {
    const double size = std::abs(value);
    if (size == 0.0 || (size >= 1e-3 && size < plain)) return fmt::format("{:.6g}", value);
    static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
    std::string power = exponent < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(exponent))) power += kDigits[digit - '0'];
    const double mantissa = value / std::pow(10.0, exponent);
    return std::abs(mantissa - 1.0) < 1e-9 ? power : fmt::format("{:.3g}·{}", mantissa, power);
}

}  // namespace

AxisRange rangeOf(const std::vector<double>& values, bool isLog, bool includesZero) {
    if (values.empty()) return isLog ? AxisRange{1.0, 10.0} : AxisRange{};
    auto [low, high] = std::minmax_element(values.begin(), values.end());
    AxisRange range{*low, *high};
    if (isLog) {
        const double room = std::max(std::pow(range.high / range.low, kRoom), 1.1);
        return {range.low / room, range.high * room};
    }
    const bool isFromZero = includesZero && range.low >= 0.0 && range.low < 0.6 * range.high;
    double room = kRoom * (range.high - range.low);
    if (room == 0.0) room = range.high == 0.0 ? 1.0 : kRoom * std::abs(range.high);
    return {isFromZero ? 0.0 : range.low - room, range.high + room};
}

Tics logarithmicTics(const AxisRange& range) {
    const double decades = std::log10(range.high / range.low);
    Tics tics;
    if (decades < 0.25) {
        const double step = linearStep(range, 4);
        const double last = std::floor(range.high / step);
        for (double n = std::ceil(range.low / step); n <= last; ++n) {
            tics.emplace_back(n * step, ticText(n * step, 1e6));
        }
        return tics;
    }
    const std::set<int> labelled = decades < 0.8   ? std::set<int>{1, 2, 3, 4, 5, 6, 8}
                                   : decades < 2.2 ? std::set<int>{1, 2, 5}
                                                   : std::set<int>{1};
    const int step = decades > 8.0 ? 2 : 1;
    const int first = static_cast<int>(std::floor(std::log10(range.low)));
    const int last = static_cast<int>(std::ceil(std::log10(range.high)));
    for (int exponent = first; exponent <= last; ++exponent) {
        for (int mantissa = 1; mantissa <= 9; ++mantissa) {
            // Division is exact where a product with 0.1 is not.
            const double power = std::pow(10.0, std::abs(exponent));
            const double value = exponent < 0 ? mantissa / power : mantissa * power;
            if (value < range.low || value > range.high) continue;
            const bool isLabelled = labelled.contains(mantissa) && exponent % step == 0;
            if (isLabelled || decades < 4.5)
                tics.emplace_back(value, isLabelled ? ticText(value, 1e4) : "");
        }
    }
    return tics;
}

double linearStep(const AxisRange& range, int count) {
    const double least = (range.high - range.low) / count;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10.0 * power;
}

Tics ticsAt(const std::vector<double>& values, const AxisRange& range, bool isLog) {
    constexpr std::size_t kMost = 10;
    const std::set<double> distinct(values.begin(), values.end());
    if (distinct.empty() || distinct.size() > kMost) return {};
    const auto place = [&](double value) {
        return isLog ? std::log(value / range.low) / std::log(range.high / range.low)
                     : (value - range.low) / (range.high - range.low);
    };
    Tics tics;
    double end = -1.0;  // of the text before, on an axis of length 1
    for (const double value : distinct) {
        const std::string text = ticText(value, 1e6);
        constexpr double kLetter = 0.032;  // of half a page's width
        const double half = 0.5 * kLetter * static_cast<double>(text.size());
        if (place(value) - half < end) return {};
        end = place(value) + half + kLetter * 0.5;
        tics.emplace_back(value, text);
    }
    return tics;
}

}  // namespace gfxrepro::report
