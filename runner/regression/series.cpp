#include "runner/regression/series.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"
#include "engine/metrics/mean_test.h"
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
        sum += metrics::median(values);
        ++count;
    }
    return sum / static_cast<double>(count);
}

/// Memory of the process, and what rounding and the order of parallel work change.
bool isOfTheMachine(const std::string& metric) {
    static constexpr std::array kNames = {"peak_memory_bytes", "baseline_memory_bytes",
                                          "work_fragments", "work_image_digest"};
    return std::ranges::find(kNames, metric) != kNames.end();
}

/// A time, or made from times: no two measurements give the same.
bool isMadeOfTimes(const records::Record& record) {
    static constexpr std::array kUnits = {"s", "ms", "us", "ns"};
    const std::string &unit = record.unit, &metric = record.metric;
    return std::ranges::find(kUnits, unit) != kUnits.end() || unit.ends_with("/s") ||
           metric.find("time") != std::string::npos;
}

/// Of times: the frame's, and a program's own.
bool isWatched(const records::Record& record, const Tables& byClock) {
    if (record.lane != "timing") return false;
    const std::string& metric = record.metric;
    if (metric == "wall_time_ms" || metric == "process_time_ms") return record.pass.empty();
    return byClock.contains(record.table) && record.frame != records::kSetup &&
           metric.ends_with("_ms");
}

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

Json paramsOf(const SeriesKey& key) {
    if (key.params.empty()) return Json::object();
    return parseJsonObject(key.params, {key.caseTitle(), 0, 0});
}

/// The parameters of each key that are not the same in all, "a=1 b=2".
std::vector<std::string> differingParams(const std::vector<const SeriesKey*>& keys) {
    std::vector<Json> params;
    std::map<std::string, std::set<std::string>> values;
    for (const SeriesKey* key : keys) {
        Json own = paramsOf(*key);
        for (const auto& [name, value] : own.items()) values[name].insert(value.dump());
        params.push_back(std::move(own));
    }
    std::vector<std::string> texts;
    for (const Json& own : params) {
        std::vector<std::string> parts;
        for (const auto& [name, value] : own.items()) {
            if (values[name].size() < 2) continue;
            const bool isText = value.is_string();
            parts.push_back(name + "=" + (isText ? value.get<std::string>() : value.dump()));
        }
        texts.push_back(joined(parts, " "));
    }
    return texts;
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

MetricsOfTables setupMetricsOf(const std::vector<records::Record>& records) {
    MetricsOfTables metrics, ofFrames;
    for (const records::Record& record : records) {
        (record.frame == records::kSetup ? metrics : ofFrames).emplace(record.table, record.metric);
    }
    std::erase_if(metrics, [&](const auto& one) { return ofFrames.contains(one); });
    return metrics;
}

SeriesMap seriesOf(const std::vector<records::Record>& records, const CaseParams& params,
                   const Tables& byClock) {
    std::map<SeriesKey, std::map<int, Frames>> gathered;
    for (const records::Record& record : records) {
        const bool isVoid = record.status == records::Status::Ambiguous;
        if (record.status != records::Status::Ok && !isVoid) continue;
        SeriesKey key = keyOf(record, params, record.metric);
        key.pass = record.pass;
        key.unit = record.unit;
        if (isMadeOfTimes(record) && !isWatched(record, byClock)) continue;
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

CaseTexts onceOf(const std::vector<records::Record>& records, const CaseParams& params,
                 const std::set<std::string>& cases) {
    CaseTexts once, again;
    for (const records::Record& record : records) {
        if (!cases.contains(record.caseId)) continue;
        (record.process > 0 ? again : once).try_emplace(keyOf(record, params, "status"), "");
    }
    std::erase_if(once, [&](const auto& one) { return again.contains(one.first); });
    return once;
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
        if (record.lane == "quality") cases.insert(record.table + " " + record.caseId);
    }
    return cases.size();
}

void addParamNames(const SeriesKey& key, ParamNames& names) {
    const Json params = paramsOf(key);
    for (const auto& [name, value] : params.items()) names[key.technique].insert(name);
}

std::string reducedParams(const SeriesKey& key, const ParamNames& known) {
    const auto found = known.find(key.technique);
    if (found == known.end() || key.params.empty()) return key.params;
    const Json all = paramsOf(key);
    Json params = Json::object();
    for (const auto& [name, value] : all.items()) {
        if (found->second.contains(name)) params[name] = value;
    }
    return params.dump();
}

std::vector<std::string> titlesOf(const std::vector<const SeriesKey*>& keys) {
    std::map<std::string, std::vector<std::size_t>> places;
    for (std::size_t i = 0; i < keys.size(); ++i) places[keys[i]->title()].push_back(i);
    std::vector<std::string> titles(keys.size());
    for (const auto& [title, own] : places) {
        std::vector<const SeriesKey*> alike;
        for (const std::size_t i : own) alike.push_back(keys[i]);
        const std::vector<std::string> params = differingParams(alike);
        for (std::size_t i = 0; i < own.size(); ++i) {
            titles[own[i]] = params[i].empty() ? title : title + ", " + params[i];
        }
    }
    return titles;
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

void chooseTimes(SeriesMap& before, SeriesMap& after, const Tables& byProcess) {
    const SeriesMap allBefore = before, allAfter = after;
    const auto isChosen = [&](const SeriesKey& key) {
        if (!key.isTime() || !byProcess.contains(key.table)) return true;
        SeriesKey process = key;
        process.metric = "process_time_ms";
        const bool haveBoth = allBefore.contains(process) && allAfter.contains(process);
        return key.isProcessTime() == haveBoth;
    };
    for (SeriesMap* side : {&before, &after}) {
        std::erase_if(*side, [&](const auto& entry) { return !isChosen(entry.first); });
    }
}

// Exact tests.

namespace {

constexpr double kTail = 0.025;  // of a 95 % interval; twice that of a bound
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr metrics::Interval kUnbounded{-kInfinity, kInfinity};

/// Ranks times two: whole numbers where values are equal, too.
std::vector<std::size_t> doubledRanks(std::span<const double> values) {
    std::vector<std::size_t> doubled;
    for (const double rank : ranksOf(values)) {
        doubled.push_back(static_cast<std::size_t>(std::lround(2.0 * rank)));
    }
    return doubled;
}

std::vector<std::size_t> doubledPlaces(std::size_t count) {
    std::vector<std::size_t> places(count);
    for (std::size_t i = 0; i < count; ++i) places[i] = 2 * (i + 1);
    return places;
}

/// The chance of each sum of `count` of the scores, each choice as likely as another.
Series choiceSums(const std::vector<std::size_t>& scores, std::size_t count) {
    const std::size_t size = std::accumulate(scores.begin(), scores.end(), std::size_t{0}) + 1;
    // Of the first i scores, a share of j / i in the choices of j is with the i-th: no large
    // binomial coefficient is ever formed.
    std::vector<Series> chances(count + 1, Series(size, 0.0));
    chances[0][0] = 1.0;
    for (std::size_t i = 1; i <= scores.size(); ++i) {
        const std::size_t score = scores[i - 1];
        for (std::size_t j = std::min(i, count); j >= 1; --j) {
            const double with = static_cast<double>(j) / static_cast<double>(i);
            for (std::size_t sum = size; sum-- > 0;) {
                const double before = sum >= score ? chances[j - 1][sum - score] : 0.0;
                chances[j][sum] = (1.0 - with) * chances[j][sum] + with * before;
            }
        }
    }
    return chances[count];
}

/// The chance of a sum as far from the mean as `sum` or farther.
double twoSided(const Series& chances, double mean, double sum) {
    const double distance = std::abs(sum - mean) - 0.25;
    double chance = 0.0;
    for (std::size_t i = 0; i < chances.size(); ++i) {
        if (std::abs(static_cast<double>(i) - mean) >= distance) chance += chances[i];
    }
    return std::min(chance, 1.0);
}

/// How many steps of two from `begin` on lie within a tail of at most `most`.
std::size_t stepsInTail(const Series& chances, std::size_t begin, double most) {
    double tail = 0.0;
    std::size_t steps = 0;
    for (std::size_t sum = begin; sum < chances.size(); sum += 2, ++steps) {
        tail += chances[sum];
        if (tail > most) break;
    }
    return steps;
}

}  // namespace

Series ranksOf(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    Series ranks(values.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin + 1;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (std::size_t i = begin; i < end; ++i) {
            ranks[order[i]] = 0.5 * static_cast<double>(begin + 1 + end);
        }
        begin = end;
    }
    return ranks;
}

RankTest signedRank(std::span<const double> differences) {
    const std::size_t count = differences.size();
    GFXREPRO_ASSERT(count > 0);
    RankTest test;
    test.attainable = std::min(1.0, std::exp2(1.0 - static_cast<double>(count)));
    test.shift = metrics::centre(differences);
    test.interval = metrics::centreInterval(differences).value_or(kUnbounded);
    Series sizes;
    for (const double difference : differences) {
        if (difference != 0.0) sizes.push_back(std::abs(difference));
    }
    const std::vector<std::size_t> ranks = doubledRanks(sizes);
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0, ranked = 0; i < count; ++i) {
        if (differences[i] == 0.0) continue;
        const auto rank = static_cast<double>(ranks[ranked++]);
        all += rank;
        if (differences[i] > 0.0) sum += rank;
    }
    test.chance = twoSided(metrics::coinSums(ranks), 0.5 * all, sum);
    return test;
}

double rankSumChance(std::span<const double> first, std::span<const double> rest) {
    Series all(first.begin(), first.end());
    all.insert(all.end(), rest.begin(), rest.end());
    const std::vector<std::size_t> ranks = doubledRanks(all);
    // The side with fewer values: far fewer sums.
    const bool isFirstSmaller = first.size() <= rest.size();
    const std::size_t count = std::min(first.size(), rest.size());
    const auto begin =
        isFirstSmaller ? ranks.begin() : ranks.begin() + static_cast<std::ptrdiff_t>(first.size());
    const auto sum =
        std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), std::size_t{0});
    const double mean = static_cast<double>(count * (all.size() + 1));
    return twoSided(choiceSums(ranks, count), mean, static_cast<double>(sum));
}

RankTest rankSum(std::span<const double> before, std::span<const double> after) {
    GFXREPRO_ASSERT(!before.empty() && !after.empty());
    RankTest test;
    test.chance = rankSumChance(before, after);
    const std::size_t count = std::min(before.size(), after.size());
    const Series untied = choiceSums(doubledPlaces(before.size() + after.size()), count);
    const std::size_t least = count * (count + 1);  // the doubled sum of the lowest places
    test.attainable = std::min(1.0, 2.0 * untied[least]);
    Series steps;
    for (const double a : after) {
        for (const double b : before) steps.push_back(a - b);
    }
    std::ranges::sort(steps);
    test.shift = metrics::median(steps);
    const auto within = [&](double tail) {
        const std::size_t out = stepsInTail(untied, least, tail);
        return out > 0 ? metrics::Interval{steps[out - 1], steps[steps.size() - out]} : kUnbounded;
    };
    test.interval = within(kTail);
    test.bounds = within(2.0 * kTail);
    return test;
}

WelchTest welch(std::span<const double> before, std::span<const double> after) {
    GFXREPRO_ASSERT(before.size() > 1 && after.size() > 1);
    double means[2], errors[2], freedoms = 0.0;  // errors: squared, of the means
    for (const std::size_t side : {0U, 1U}) {
        const std::span<const double> values = side == 0 ? before : after;
        const auto count = static_cast<double>(values.size());
        means[side] = std::accumulate(values.begin(), values.end(), 0.0) / count;
        double squares = 0.0;
        for (const double value : values) squares += (value - means[side]) * (value - means[side]);
        errors[side] = squares / (count - 1.0) / count;
        freedoms += errors[side] * errors[side] / (count - 1.0);
    }
    const double difference = means[1] - means[0], error = errors[0] + errors[1];
    if (difference == 0.0) return {};
    if (error == 0.0) return {std::copysign(kInfinity, difference), 1, 0.0};
    WelchTest test{difference / std::sqrt(error)};
    test.freedom = static_cast<int>(error * error / freedoms);
    test.chance = metrics::studentP(test.t, test.freedom);
    return test;
}

}  // namespace gfxrepro::regression
