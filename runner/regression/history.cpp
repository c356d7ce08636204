#include "runner/regression/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <span>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/metrics/statistics.h"
#include "runner/regression/rank_tests.h"
#include "runner/report/csv.h"

namespace gfxrepro::regression {

namespace {

constexpr std::string_view kHeader =
    "time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value\n";
constexpr std::size_t kColumns = 12;
constexpr std::size_t kFewestNights = 5;
constexpr std::size_t kMostNights = 100;

double medianOf(std::span<const double> values) {
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
    for (const auto& [key, all] : night.series) {
        const Series values = key.isTime() ? standing(all) : all;
        if (values.empty()) continue;
        report::CsvRow row(text);
        row.text(night.time).text(night.commit).text(night.machine).text(key.table);
        row.text(key.technique).text(key.method).text(key.scene).text(key.params);
        row.text(key.pass).text(key.metric).text(key.unit).number(medianOf(values));
        row.end();
    }
    writeFileAtomic(path, text);
}

SeriesMap readHistory(const std::filesystem::path& path, const std::string& machine) {
    SeriesMap history;
    if (!std::filesystem::exists(path)) return history;
    const std::string text = readFile(path);
    report::CsvReader reader(text, path.string());
    std::vector<std::string> fields;
    bool isHeader = true;
    while (reader.next(fields)) {
        if (fields.size() != kColumns) {
            throw Error(reader.location(),
                        fmt::format("{} columns; a history has {}", fields.size(), kColumns));
        }
        if (!isHeader && fields[2] == machine) {
            const SeriesKey key{fields[3], fields[4], fields[5], fields[6],
                                fields[7], fields[8], fields[9], fields[10]};
            history[key].push_back(numberFrom(fields[11], reader.location()));
        }
        isHeader = false;
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
    const double before = medianOf(first), after = medianOf(rest);
    if (before <= 0.0 || after <= 0.0) return std::nullopt;
    if (std::abs(std::log(after / before)) < std::log1p(effectFloor)) return std::nullopt;
    const auto splits = static_cast<double>(all.size() - 2 * kFewestNights + 1);
    const double chance = std::min(1.0, splits * rankSumChance(first, rest));
    if (chance > significance) return std::nullopt;
    return Step{skipped + best.first, after / before, chance};
}

std::vector<SeriesStep> findSteps(const SeriesMap& history, const StepRules& rules) {
    const auto count =
        std::ranges::count_if(history, [](const auto& entry) { return entry.first.isTime(); });
    const double significance =
        rules.familyError / (static_cast<double>(count) * rules.nightsAYear);
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
