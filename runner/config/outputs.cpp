#include "runner/config/outputs.h"

#include <fmt/format.h>
#include <algorithm>

#include "engine/core/text.h"
#include "engine/metrics/mean_test.h"

namespace gfxrepro::config {

namespace {

bool stands(const std::string& declared, std::string_view name) {
    if (!declared.ends_with('*')) return declared == name;
    const std::string_view stem = std::string_view(declared).substr(0, declared.size() - 1);
    return name.size() > stem.size() && name.starts_with(stem);
}

template <class Infos>
std::vector<std::string> namesOf(const Infos& infos) {
    std::vector<std::string> names;
    for (const auto& info : infos) names.push_back(info.name);
    return names;
}

[[noreturn]] void throwUnknown(const std::string& owner, const char* what, std::string_view name,
                               const std::vector<std::string>& known, const SourceLocation& where) {
    std::string near = suggestion(std::string(name), known);
    if (near.empty()) near = "; it has " + (known.empty() ? "none" : joined(known));
    if (name == kFrameTime) near = "; the time of a frame is the metric wall_time_ms";
    throw Error(where, owner + " has no " + what + " '" + std::string(name) + "'" + near);
}

}  // namespace

const MetricInfo* Outputs::find(std::string_view metric) const {
    const auto found = std::ranges::find(metrics, metric, &MetricInfo::name);
    if (found != metrics.end()) return &*found;
    if (!metric.ends_with(kShareOf)) return nullptr;
    const auto share = std::ranges::find(metrics, metric.substr(0, metric.size() - kShareOf.size()),
                                         &MetricInfo::name);
    return share != metrics.end() && share->unit == "%" ? &*share : nullptr;
}

bool Outputs::hasPass(std::string_view pass) const {
    return std::ranges::any_of(passes,
                               [&](const PassInfo& info) { return stands(info.name, pass); });
}

void Outputs::requireMetric(std::string_view metric, const std::string& owner,
                            const SourceLocation& where) const {
    if (!find(metric)) throwUnknown(owner, "metric", metric, namesOf(metrics), where);
}

void Outputs::requirePass(std::string_view pass, const std::string& owner,
                          const SourceLocation& where) const {
    if (!hasPass(pass)) throwUnknown(owner, "pass", pass, namesOf(passes), where);
}

std::span<const MetricInfo> pictureErrors() {
    using Of = MetricInfo::Of;
    constexpr bool kIsDetail = true;
    static const std::vector<MetricInfo> errors = {
        {"mse", "1", "mean squared error of all values, linear or sRGB as in the file",
         Better::Lower, false, Of::Pass},
        {"rmse", "1", "its square root", Better::Lower, false, Of::Pass},
        {"rel_mse", "1", "mean of squared errors ÷ (squared truth + 0.01)", Better::Lower, false,
         Of::Pass},
        {"psnr_db", "dB", "10 · log10(1 ÷ mse)", Better::Higher, false, Of::Pass},
        {"ssim", "1", "structural similarity of luminance", Better::Higher, false, Of::Pass},
        {"flip", "1", "mean FLIP; HDR-FLIP of pictures with values beyond 1", Better::Lower, false,
         Of::Pass},
        {"error_p95", "1", "the largest difference of a pixel's values that 95 % of pixels keep to",
         Better::Lower, kIsDetail, Of::Pass},
        {"error_p99", "1", "likewise 99 %", Better::Lower, kIsDetail, Of::Pass}};
    return errors;
}

bool isPictureError(std::string_view metric) {
    const auto errors = pictureErrors();
    return std::ranges::find(errors, metric, &MetricInfo::name) != errors.end();
}

bool isTestOfMeans(std::string_view metric) {
    return metric == metrics::kSameMeanP || metric == metrics::kBiasSeen;
}

std::string_view betterText(Better better) {
    switch (better) {
        case Better::Lower:
            return "lower is better";
        case Better::Higher:
            return "higher is better";
        case Better::Neither:
            break;
    }
    return "";
}

int timePower(std::string_view metric) {
    if (metric.ends_with("frame_rate") || metric.ends_with("_per_second")) return -1;
    const bool isTime =
        metric.ends_with("_ms") || metric.find("_us_per_") != std::string_view::npos;
    return isTime ? 1 : 0;
}

bool isOfDevice(std::string_view metric) {
    static constexpr std::string_view kNames[] = {"work_primitives", "work_fragments",
                                                  "work_compute_invocations", "work_image_digest"};
    return std::ranges::find(kNames, metric) != std::end(kNames);
}

bool isTimeMetric(std::string_view metric) {
    return timePower(metric) != 0;
}

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
