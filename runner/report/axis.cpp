#include "runner/report/axis.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace gfxrepro::report {

namespace {

constexpr double kRoom = 0.05;  // on each side, of the axis

using Ticks = std::vector<Tick>;

double scaled(double mantissa, int exponent) {
    // Division is exact where a product with 0.1 is not.
    const double power = std::pow(10.0, std::abs(exponent));
    return exponent < 0 ? mantissa / power : mantissa * power;
}

std::string withMinus(std::string text) {
    return text.starts_with('-') ? "−" + text.substr(1) : text;
}

/// "2·10⁶", "10⁻⁷".
std::string powerText(double value) {
    if (value == 0.0) return "0";
    static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
    std::string power = exponent < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(exponent))) power += kDigits[digit - '0'];
    const double mantissa = scaled(value, -exponent);
    return std::abs(mantissa - 1.0) < 1e-9 ? power
                                           : withMinus(fmt::format("{:.10g}·{}", mantissa, power));
}

/// As it is from a thousandth up to `plain`.
std::string tickText(double value, double plain) {
    const double size = std::abs(value);
    const bool isPlain = size == 0.0 || (size >= 1e-3 && size < plain);
    return isPlain ? withMinus(fmt::format("{:.6g}", value)) : powerText(value);
}

/// Whether no text comes near the next, and no tick with one nearer than `least`.
bool haveRoom(const Ticks& ticks, const Axis& axis, double length, Along along, double gap,
              double least = 0.0) {
    double before = -1e9, end = -1e9;
    for (const Tick& tick : ticks) {
        if (tick.text.empty()) continue;
        const double half = 0.5 * (along == Along::X ? textWidth(tick.text) : kFontPx);
        const double place = length * axis.at(tick.value);
        if (place - half < end || place - before < least) return false;
        before = place;
        end = place + half + gap;
    }
    return true;
}

/// At multiples of a factor times a power of ten.
Ticks multiples(const Axis& axis, int factor, int exponent) {
    const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
    const bool isPlain = largest >= 1e-3 && largest < 1e6;
    const double step = scaled(factor, exponent);
    Ticks ticks;
    for (double n = std::ceil(axis.low / step - 1e-9); n <= axis.high / step + 1e-9; ++n) {
        const double value = scaled(n * factor, exponent);
        const std::string plain = fmt::format("{:.{}f}", value, std::max(0, -exponent));
        ticks.push_back({value, value == 0.0 ? "0"
                                : isPlain    ? withMinus(plain)
                                             : powerText(value)});
    }
    return ticks;
}

/// The finest that have room; two of them may lie nearer together than more would.
Ticks linearTicks(const Axis& axis, double length, Along along) {
    constexpr double kGap = 10.0, kLeastX = 64.0, kLeastY = 30.0;
    Ticks best;
    for (int exponent = static_cast<int>(std::floor(std::log10(axis.high - axis.low))) + 1;;
         --exponent) {
        for (const int factor : {5, 2, 1}) {
            Ticks ticks = multiples(axis, factor, exponent);
            const double least = best.size() < 2 ? 0.0 : along == Along::X ? kLeastX : kLeastY;
            if (!haveRoom(ticks, axis, length, along, kGap, least)) {
                return best.empty() ? Ticks{ticks[0]} : best;
            }
            best = std::move(ticks);
        }
    }
}

/// At powers of ten, with a text at each `every`-th of them and at these multiples.
Ticks powerTicks(const Axis& axis, const std::set<int>& labelled, int every) {
    const bool hasSmall = std::log10(axis.high / axis.low) < 4.5;
    const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(axis.high)));
    Ticks ticks;
    for (int exponent = first - 1; exponent <= last; ++exponent) {
        for (int mantissa = 1; mantissa <= 9; ++mantissa) {
            const double value = scaled(mantissa, exponent);
            if (value < axis.low || value > axis.high) continue;
            const bool hasText = labelled.contains(mantissa) && (exponent - first) % every == 0;
            if (hasText || hasSmall) ticks.push_back({value, hasText ? tickText(value, 1e4) : ""});
        }
    }
    return ticks;
}

}  // namespace

bool Axis::shows(double value) const {
    // Ratios and differences of these are numbers, too.
    const double size = std::abs(value);
    return (size == 0.0 || size > 1e-120) && size < 1e120 && (!isLog || value > 0.0);
}

double Axis::at(double value) const {
    return isLog ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

Axis axisOf(const std::vector<double>& values, bool isLog, bool fromZero) {
    Axis axis{isLog ? 1.0 : 0.0, isLog ? 10.0 : 1.0, isLog};
    std::vector<double> shown;
    std::ranges::copy_if(values, std::back_inserter(shown),
                         [&](double v) { return axis.shows(v); });
    if (shown.empty()) return axis;
    const auto [low, high] = std::ranges::minmax(shown);
    if (isLog) {
        const double room = std::max(std::pow(high / low, kRoom), 1.1);
        return {low / room, high * room, true};
    }
    const double largest = std::max(std::abs(low), std::abs(high));
    double room = kRoom * (high - low);
    if (high - low <= 1e-9 * largest) room = largest == 0.0 ? 1.0 : kRoom * largest;
    return {fromZero && low >= 0.0 && low < 0.6 * high ? 0.0 : low - room, high + room, false};
}

std::vector<Tick> ticksOf(const Axis& axis, double length, Along along) {
    if (!axis.isLog) return linearTicks(axis, length, along);
    const double gap = along == Along::X ? 28.0 : 9.0;
    const int least = axis.high < 10.0 * axis.low ? 2 : 1;  // texts
    using Candidate = std::pair<std::set<int>, int>;
    std::vector<Candidate> candidates = {{{1, 2, 3, 4, 5, 6, 8}, 1}, {{1, 2, 5}, 1}};
    for (const int every : {1, 2, 5, 10, 50, 100, 1000}) candidates.push_back({{1}, every});
    for (const auto& [labelled, every] : candidates) {
        Ticks ticks = powerTicks(axis, labelled, every);
        const auto hasText = [](const Tick& tick) { return !tick.text.empty(); };
        if (std::ranges::count_if(ticks, hasText) >= least &&
            haveRoom(ticks, axis, length, along, gap)) {
            return ticks;
        }
    }
    return linearTicks(axis, length, along);
}

std::vector<Tick> ticksAt(const std::vector<double>& values, const Axis& axis, double length) {
    constexpr std::size_t kMost = 10;
    constexpr double kLetters = 6.0;
    std::set<double> distinct;
    for (const double value : values) {
        if (axis.shows(value)) distinct.insert(value);
    }
    Ticks ticks;
    for (const double value : distinct) ticks.push_back({value, tickText(value, 1e6)});
    const bool areShort = std::ranges::all_of(
        ticks, [](const Tick& tick) { return textWidth(tick.text) <= kLetters * textWidth("0"); });
    return !ticks.empty() && ticks.size() <= kMost && areShort &&
                   haveRoom(ticks, axis, length, Along::X, 10.0)
               ? ticks
               : ticksOf(axis, length, Along::X);
}

double textWidth(std::string_view text) {
    constexpr double kLetter = 0.56 * kFontPx;
    return kLetter * static_cast<double>(std::ranges::count_if(text, [](char c) {
               return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // begins a letter
           }));
}

}  // namespace gfxrepro::report
