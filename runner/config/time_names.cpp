#include "runner/config/time_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace gfxrepro::config {

std::string whyNoTimeName(std::string_view name, std::string_view unit) {
    static constexpr std::string_view kUnits[] = {
        "ns",      "nanosecond", "nanoseconds", "us",           "µs", "microsecond", "microseconds",
        "ms",      "msec",       "millisecond", "milliseconds", "s",  "sec",         "second",
        "seconds", "min",        "minute",      "minutes",      "h",  "hour",        "hours"};
    static constexpr std::string_view kRates[] = {"fps", "FPS", "Hz", "kHz", "MHz"};
    static constexpr std::string_view kPerTime[] = {"/s", "/sec", "/second", "/ms", "/min"};
    const bool isInMs = name.ends_with("_ms");
    const bool isShareOfTime = name.find("_us_per_") != std::string_view::npos && unit == "us";
    const bool isTime = std::ranges::find(kUnits, unit) != std::end(kUnits);
    if (isTime ? !isShareOfTime && !(isInMs && unit == "ms") : isInMs) {
        return fmt::format(
            "'{}' has the unit '{}'; a time has a name that ends in _ms and the unit ms, by which "
            "claims know it, and nothing else has",
            name, unit);
    }
    const bool isRate = name.ends_with("frame_rate") || name.ends_with("_per_second");
    const bool isPerTime =
        std::ranges::find(kRates, unit) != std::end(kRates) ||
        std::ranges::any_of(kPerTime, [&](std::string_view end) { return unit.ends_with(end); });
    if (!isPerTime || isRate) return "";
    return fmt::format(
        "'{}' has the unit '{}'; what is per second has a name that ends in _per_second, by which "
        "claims know that it varies",
        name, unit);
}

}  // namespace gfxrepro::config
