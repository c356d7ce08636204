#include "techniques/external/metric_lines.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"

namespace gfxrepro::external {

namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20;
constexpr std::size_t kLongestShown = 80;
constexpr std::size_t kLongestMatched = 4096;  // std::regex takes stack with every letter

std::string shown(std::string_view line) {
    return line.size() <= kLongestShown ? std::string(line)
                                        : std::string(line.substr(0, kLongestShown)) + "…";
}

std::string textOf(const Json& line, const char* key, bool isRequired, const std::string& what) {
    const auto found = line.find(key);
    if (found == line.end() && !isRequired) return "";
    if (found != line.end() && found->is_string()) return found->get<std::string>();
    throw Error(fmt::format("{}: {}; allowed: text", what,
                            found == line.end() ? fmt::format("no \"{}\"", key)
                                                : fmt::format("\"{}\" is {}", key, found->dump())));
}

/// One of `count` from `first` on.
int frameOf(const Json& line, int first, int count, const std::string& what) {
    const auto given = line.find("frame");
    if (given == line.end() || given->is_null()) {
        if (count == 1) return first;
        throw Error(fmt::format("{}: no \"frame\"; allowed: 0 … {}", what, first + count - 1));
    }
    const double frame = given->is_number() ? given->get<double>() : -1.0;
    if (frame >= first && frame < first + count && frame == std::floor(frame)) {
        return static_cast<int>(frame);
    }
    throw Error(fmt::format("{}: \"frame\" is {}; {}", what, given->dump(),
                            count == 1 ? fmt::format("it was asked for frame {}", first)
                                       : fmt::format("allowed: 0 … {}", first + count - 1)));
}

GivenMetric metricOf(std::string_view text, int number, int frame, int count) {
    const std::string what = fmt::format("line {} of its metrics", number);
    if (isTooDeepJson(text)) {
        throw Error(fmt::format("{} has more than {} brackets in each other: {}", what,
                                kMostJsonLevels, shown(text)));
    }
    const Json line = Json::parse(text, nullptr, false);
    if (!line.is_object()) {
        const bool isNan = text.find("NaN") != text.npos || text.find("Infinity") != text.npos;
        throw Error(fmt::format("{} is no JSON object{}: {}", what,
                                isNan ? ", which has no NaN and no Infinity" : "", shown(text)));
    }
    static constexpr std::string_view kKeys[] = {"metric", "pass", "frame", "value", "unit"};
    for (const auto& [key, value] : line.items()) {
        if (std::ranges::find(kKeys, key) != std::end(kKeys)) continue;
        throw Error(fmt::format("{}: unknown key \"{}\"; allowed: metric, pass, frame, value, unit",
                                what, key));
    }
    GivenMetric given{textOf(line, "metric", true, what), textOf(line, "unit", true, what),
                      textOf(line, "pass", false, what)};
    const auto value = line.find("value");
    if (value == line.end() || !value->is_number()) {
        throw Error(fmt::format(
            "{}: {}; allowed: a number", what,
            value == line.end() ? "no \"value\"" : fmt::format("\"value\" is {}", value->dump())));
    }
    given.value = value->get<double>();
    given.frame = frameOf(line, frame, count, what);
    return given;
}

}  // namespace

std::vector<GivenMetric> metricsIn(const std::filesystem::path& file, int frame, int count) {
    std::error_code isAbsent;
    if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, isAbsent))) {
        throw Error(fmt::format("its file of metrics, {}, {}", file.filename().string(),
                                std::filesystem::exists(file, isAbsent)
                                    ? "is no plain file any more; it is there to be added to"
                                    : "is gone; it is there to be added to"));
    }
    if (std::filesystem::file_size(file) > kMostBytes) {
        throw Error(fmt::format("its metrics have more than {} MiB", kMostBytes >> 20));
    }
    std::vector<GivenMetric> metrics;
    int number = 0;
    for (const std::string& line : split(readFile(file), '\n')) {
        ++number;
        if (!trimmed(line).empty()) metrics.push_back(metricOf(line, number, frame, count));
    }
    return metrics;
}

std::optional<double> numberIn(std::string_view output, const config::ProgramPattern& pattern) {
    const std::regex regex(pattern.regex);
    std::optional<std::string> last;
    while (!output.empty()) {
        const std::string_view line = output.substr(0, output.find_first_of("\r\n"));
        output.remove_prefix(std::min(line.size() + 1, output.size()));
        std::match_results<std::string_view::const_iterator> match;
        if (line.size() <= kLongestMatched &&
            std::regex_search(line.begin(), line.end(), match, regex)) {
            last = match[1].str();
        }
    }
    if (!last) return std::nullopt;
    const std::optional<double> number = parseDouble(*last);
    if (!number) {
        throw Error(fmt::format("metric '{}': its pattern finds '{}'; allowed: a number",
                                pattern.metric, shown(*last)));
    }
    return number;
}

}  // namespace gfxrepro::external
