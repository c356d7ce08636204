#include "runner/regression/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/metrics/statistics.h"

namespace gfxrepro::regression {

namespace {

constexpr double kVoid = std::numeric_limits<double>::quiet_NaN();

/// Repeats by frame; a later value of a repeat replaces an earlier one.
using Frames = std::map<int, std::map<int, double>>;

double meanOfMedians(const Frames& frames) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const auto& [frame, repeats] : frames) {
        if (frame == records::kSetup && frames.size() > 1) continue;
        Series values;
        for (const auto& [repeat, value] : repeats) values.push_back(value);
        if (standing(values).size() < values.size()) return kVoid;
        sum += metrics::summarize(values, metrics::Statistic::Median);
        ++count;
    }
    return sum / static_cast<double>(count);
}

/// Memory of the process, and what rounding and the order of parallel work change. The names
/// without "work_" are those of older records.
bool isOfTheMachine(const std::string& metric) {
    static constexpr std::array kNames = {"peak_memory_bytes", "baseline_memory_bytes",
                                          "work_fragments",    "work_image_digest",
                                          "fragments",         "image_digest"};
    return std::ranges::find(kNames, metric) != kNames.end();
}

/// A time, or made from times: no two measurements give the same.
bool isMadeOfTimes(const records::Record& record) {
    static constexpr std::array kUnits = {"s", "ms", "us", "ns"};
    return std::ranges::find(kUnits, record.unit) != kUnits.end() || record.unit.ends_with("/s") ||
           record.metric.find("time") != std::string::npos;
}

using Json = nlohmann::ordered_json;

ParamNames paramNamesOf(const SeriesMap& series) {
    ParamNames names;
    for (const auto& [key, values] : series) addParamNames(key, names);
    return names;
}

/// With the parameters in `known` alone; as it is where nothing is known of the technique. Null
/// where keys fall together.
std::optional<SeriesMap> reduced(const SeriesMap& series, const ParamNames& known) {
    SeriesMap result;
    for (const auto& [key, values] : series) {
        SeriesKey own = key;
        own.params = reducedParams(key, known);
        if (!result.emplace(own, values).second) return std::nullopt;
    }
    return result;
}

}  // namespace

SeriesKey keyOf(const records::Record& record, const CaseParams& params, std::string metric) {
    const auto found = params.find(record.caseId);
    return {record.table,
            record.technique,
            record.method,
            record.scene,
            found == params.end() ? "" : found->second,
            "",
            std::move(metric),
            ""};
}

std::string SeriesKey::caseTitle() const {
    std::string text = fmt::format("{} {}", table, technique);
    for (const std::string* part : {&method, &scene}) {
        if (!part->empty()) text += fmt::format(" {}", *part);
    }
    return text;
}

std::string SeriesKey::title() const {
    std::string text = fmt::format("{} {}", caseTitle(), metric);
    if (!pass.empty()) text += fmt::format("/{}", pass);
    return text;
}

Series standing(const Series& values) {
    Series result;
    std::ranges::copy_if(values, std::back_inserter(result),
                         [](double value) { return !std::isnan(value); });
    return result;
}

SeriesMap seriesOf(const std::vector<records::Record>& records, const CaseParams& params) {
    std::map<SeriesKey, std::map<int, Frames>> gathered;
    for (const records::Record& record : records) {
        const bool isVoid = record.status == records::Status::Ambiguous;
        if (record.status != records::Status::Ok && !isVoid) continue;
        SeriesKey key = keyOf(record, params, record.metric);
        key.pass = record.pass;
        key.unit = record.unit;
        const bool isOfFrame = key.isTime() && key.pass.empty() && record.lane == "timing";
        if (isMadeOfTimes(record) && !isOfFrame) continue;
        if (isOfTheMachine(record.metric)) continue;
        gathered[key][record.process][record.frame][record.repeat] = isVoid ? kVoid : record.value;
    }
    SeriesMap series;
    for (const auto& [key, processes] : gathered) {
        for (const auto& [process, frames] : processes) {
            series[key].push_back(meanOfMedians(frames));
        }
    }
    return series;
}

CaseTexts failuresOf(const std::vector<records::Record>& records, const CaseParams& params) {
    CaseTexts failures;
    for (const records::Record& record : records) {
        if (record.status == records::Status::Ok || record.status == records::Status::Ambiguous) {
            continue;
        }
        std::string text(records::statusName(record.status));
        if (!record.message.empty()) text += ": " + record.message;
        failures.insert_or_assign(keyOf(record, params, "status"), text);
    }
    return failures;
}

CaseTexts voidTimesOf(const std::vector<records::Record>& records, const CaseParams& params) {
    CaseTexts texts;
    for (const records::Record& record : records) {
        if (record.status != records::Status::Ambiguous) continue;
        texts.try_emplace(keyOf(record, params, "status"), record.message);
    }
    return texts;
}

std::size_t untimedCases(const std::vector<records::Record>& records) {
    std::set<std::string> cases;
    for (const records::Record& record : records) {
        if (record.lane == "quality") cases.insert(record.table + ' ' + record.caseId);
    }
    return cases.size();
}

void addParamNames(const SeriesKey& key, ParamNames& names) {
    if (key.params.empty()) return;
    const Json params = Json::parse(key.params);
    for (const auto& [name, value] : params.items()) names[key.technique].insert(name);
}

std::string reducedParams(const SeriesKey& key, const ParamNames& known) {
    const auto found = known.find(key.technique);
    if (found == known.end() || key.params.empty()) return key.params;
    const Json all = Json::parse(key.params);
    Json params = Json::object();
    for (const auto& [name, value] : all.items()) {
        if (found->second.contains(name)) params[name] = value;
    }
    return params.dump();
}

void append(SeriesMap& series, const SeriesMap& more) {
    for (const auto& [key, values] : more) {
        Series& own = series[key];
        own.insert(own.end(), values.begin(), values.end());
    }
}

void matchParams(SeriesMap& before, SeriesMap& after) {
    const std::optional<SeriesMap> shortBefore = reduced(before, paramNamesOf(after));
    const std::optional<SeriesMap> shortAfter = reduced(after, paramNamesOf(before));
    if (!shortBefore || !shortAfter) return;
    before = *shortBefore;
    after = *shortAfter;
}

void chooseTimes(SeriesMap& before, SeriesMap& after, bool isSoftware) {
    const SeriesMap allBefore = before, allAfter = after;
    const auto isChosen = [&](const SeriesKey& key) {
        SeriesKey process = key;
        process.metric = "process_time_ms";
        const bool isByProcess =
            isSoftware && allBefore.contains(process) && allAfter.contains(process);
        return !key.isTime() || key.isProcessTime() == isByProcess;
    };
    for (SeriesMap* side : {&before, &after}) {
        std::erase_if(*side, [&](const auto& entry) { return !isChosen(entry.first); });
    }
}

}  // namespace gfxrepro::regression
