#include "runner/regression/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <span>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/random.h"
#include "runner/metrics/statistics.h"
#include "runner/report/csv.h"

namespace gfxrepro::regression {

namespace {

constexpr std::string_view kHeader =
    "time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value\n";
constexpr std::size_t kColumns = 12;
constexpr std::size_t kFewestNights = 5;
constexpr int kPermutations = 2000;

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

/// 1 … n, the mean of their places where values are equal.
std::vector<double> ranksOf(const Series& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> ranks(values.size());
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
    for (const auto& [key, values] : night.series) {
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
    std::vector<double> ranks = ranksOf(nights);
    const Split best = clearestSplit(ranks);
    if (best.first == 0) return std::nullopt;
    const std::span<const double> all(nights);
    const double before = medianOf(all.first(best.first));
    const double after = medianOf(all.subspan(best.first));
    if (before <= 0.0 || after <= 0.0) return std::nullopt;
    if (std::abs(std::log(after / before)) < std::log1p(effectFloor)) return std::nullopt;
    Random random(1);
    int asClear = 0;
    for (int i = 0; i < kPermutations; ++i) {
        for (std::size_t j = ranks.size() - 1; j > 0; --j) {
            std::swap(ranks[j], ranks[random.index(static_cast<std::uint32_t>(j + 1))]);
        }
        if (clearestSplit(ranks).score >= best.score) ++asClear;
    }
    const double chance = (asClear + 1.0) / (kPermutations + 1.0);
    if (chance > significance) return std::nullopt;
    return Step{best.first, after / before, chance};
}

}  // namespace gfxrepro::regression
