#include "runner/regression/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/metrics/statistics.h"
#include "runner/records/csv.h"
#include "runner/regression/rank_tests.h"

namespace gfxrepro::regression {

namespace {

constexpr std::string_view kHeader =
    "time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value\n";
constexpr std::size_t kColumns = 12;
constexpr std::size_t kFewestNights = 5;
constexpr std::size_t kMostNights = 100;

double medianOfNights(std::span<const double> values) {
    return metrics::summarize(values, metrics::Statistic::Median);
}

double numberFrom(const std::string& field, const SourceLocation& location) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) {
        throw Error(location, fmt::format("'{}' is no number", field));
    }
    return value;
}

struct Split {
    std::size_t first = 0;
    double score = 0.0;  // |rank sum − its mean| in standard deviations
};

Split clearestSplit(const std::vector<double>& ranks) {
    const auto count = static_cast<double>(ranks.size());
    Split best;
    double sum = 0.0;
    for (std::size_t first = 1; first + kFewestNights <= ranks.size(); ++first) {
        sum += ranks[first - 1];
        if (first < kFewestNights) continue;
        const auto below = static_cast<double>(first);
        const double mean = 0.5 * below * (count + 1.0);
        const double deviation = std::sqrt(below * (count - below) * (count + 1.0) / 12.0);
        const double score = std::abs(sum - mean) / deviation;
        if (score > best.score) best = {first, score};
    }
    return best;
}

}  // namespace

void appendNight(const std::filesystem::path& path, const Night& night) {
    std::string text = std::filesystem::exists(path) ? readFile(path) : std::string(kHeader);
    // A night that was torn by a crash is cut off.
    text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
    if (text.empty()) text = kHeader;
    for (const auto& [key, all] : night.series) {
        const Series values = key.isTime() ? standing(all) : all;
        if (values.empty()) continue;
        records::CsvRow row(text);
        row.text(night.time).text(night.commit).text(night.machine).text(key.table);
        row.text(key.technique).text(key.method).text(key.scene).text(key.params);
        row.text(key.pass).text(key.metric).text(key.unit).number(medianOfNights(values));
        row.end();
    }
    writeFileAtomic(path, text);
}

std::vector<HistoryRow> readHistoryRows(const std::filesystem::path& path) {
    const std::string text = readFile(path);
    records::CsvReader reader(text, path.string());
    std::vector<std::string> fields;
    std::vector<HistoryRow> rows;
    if (!text.empty() && !text.starts_with(kHeader)) {
        throw Error({path.string(), 1, 0}, fmt::format("is no history; expected the header '{}'",
                                                       kHeader.substr(0, kHeader.size() - 1)));
    }
    for (bool isHeader = true; reader.next(fields); isHeader = false) {
        if (isHeader) continue;
        if (fields.size() != kColumns) {
            throw Error(reader.location(),
                        fmt::format("{} columns; a history has {}", fields.size(), kColumns));
        }
        const double value = numberFrom(fields[11], reader.location());
        rows.push_back({fields[0], fields[1], fields[2],
                        SeriesKey{fields[3], fields[4], fields[5], fields[6], fields[7], fields[8],
                                  fields[9], fields[10]},
                        value});
    }
    return rows;
}

SeriesMap readHistory(const std::filesystem::path& path, const std::string& machine) {
    SeriesMap history;
    if (!std::filesystem::exists(path)) return history;
    for (const HistoryRow& row : readHistoryRows(path)) {
        if (row.machine == machine) history[row.key].push_back(row.value);
    }
    return history;
}

std::optional<Step> findStep(const Series& nights, double significance, double effectFloor) {
    if (nights.size() < 2 * kFewestNights) return std::nullopt;
    const std::size_t skipped = nights.size() - std::min(nights.size(), kMostNights);
    const std::span<const double> all = std::span(nights).subspan(skipped);
    const Split best = clearestSplit(ranksOf(all));
    if (best.first == 0) return std::nullopt;
    const std::span<const double> first = all.first(best.first), rest = all.subspan(best.first);
    const double before = medianOfNights(first), after = medianOfNights(rest);
    if (before <= 0.0 || after <= 0.0) return std::nullopt;
    if (std::abs(std::log(after / before)) < std::log1p(effectFloor)) return std::nullopt;
    const auto splits = static_cast<double>(all.size() - 2 * kFewestNights + 1);
    const double chance = std::min(1.0, splits * rankSumChance(first, rest));
    if (chance > significance) return std::nullopt;
    return Step{skipped + best.first, after / before, chance};
}

namespace {

/// The first nights of new levels within [first, last), appended to `steps`.
void collectSteps(const Series& nights, std::size_t first, std::size_t last, double significance,
                  double effectFloor, std::vector<Step>& steps) {
    const auto at = [&](std::size_t index) {
        return nights.begin() + static_cast<std::ptrdiff_t>(index);
    };
    std::size_t end = last;
    for (; end >= first + 2 * kFewestNights; end -= std::min(end, kMostNights / 2)) {
        if (auto step = findStep(Series(at(first), at(end)), significance, effectFloor)) {
            step->first += first;
            const std::size_t place = step->first;
            collectSteps(nights, first, place, significance, effectFloor, steps);
            steps.push_back(*step);
            collectSteps(nights, place, last, significance, effectFloor, steps);
            return;
        }
        if (end - first <= kMostNights) return;  // all were looked at
    }
}

}  // namespace

std::vector<Step> findAllSteps(const Series& nights, double significance, double effectFloor) {
    std::vector<Step> steps;
    collectSteps(nights, 0, nights.size(), significance, effectFloor, steps);
    const std::span<const double> all(nights);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::size_t begin = i == 0 ? 0 : steps[i - 1].first;
        const std::size_t end = i + 1 == steps.size() ? nights.size() : steps[i + 1].first;
        const std::size_t first = steps[i].first;
        steps[i].ratio = medianOfNights(all.subspan(first, end - first)) /
                         medianOfNights(all.subspan(begin, first - begin));
    }
    return steps;
}

double significanceOf(std::size_t timeSeries, const StepRules& rules) {
    return rules.familyError / (static_cast<double>(timeSeries) * rules.nightsAYear);
}

std::vector<std::size_t> findChanges(const Series& nights) {
    constexpr double kTolerance = 1e-4;
    std::vector<std::size_t> changes;
    for (std::size_t i = 1; i < nights.size(); ++i) {
        const double before = nights[i - 1], after = nights[i];
        const bool isWhole = before == std::round(before) && after == std::round(after);
        const double most =
            isWhole ? 0.0 : kTolerance * std::max(std::abs(before), std::abs(after));
        const bool isSame = std::isfinite(most) && std::abs(after - before) <= most;
        if (before != after && !isSame) changes.push_back(i);
    }
    return changes;
}

std::vector<SeriesStep> findSteps(const SeriesMap& history, const StepRules& rules) {
    const auto count =
        std::ranges::count_if(history, [](const auto& entry) { return entry.first.isTime(); });
    const double significance = significanceOf(static_cast<std::size_t>(count), rules);
    std::vector<SeriesStep> steps;
    for (const auto& [key, nights] : history) {
        if (!key.isTime()) continue;
        if (const auto step = findStep(nights, significance, rules.effectFloor)) {
            steps.push_back({key, nights.size(), *step});
        }
    }
    return steps;
}

}  // namespace gfxrepro::regression
