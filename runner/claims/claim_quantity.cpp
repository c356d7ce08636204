#include "runner/claims/claim_quantity.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runner/tables/cell.h"

namespace gfxrepro::claims {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double relativeDifference(double left, double right) {
    if (left == right) return 0.0;
    if (std::isinf(left) || std::isinf(right)) return left < right ? 1.0 : -1.0;
    return (right - left) / std::max(std::abs(left), std::abs(right));
}

/// The smaller one; not-a-number when either is.
double lesser(double a, double b) {
    return std::isnan(a) || b > a ? a : b;
}

/// The larger one; not-a-number when either is.
double greater(double a, double b) {
    return std::isnan(a) || b < a ? a : b;
}

GroupPoint pointOf(const Group& group, const std::function<double(const Sampled&)>& pick) {
    GroupPoint point;
    for (const auto& operand : group.operands) {
        std::vector<double>& values = point.operands.emplace_back();
        for (const Sampled& sampled : operand) values.push_back(pick(sampled));
    }
    for (const Sampled& sampled : group.x) point.x.push_back(pick(sampled));
    return point;
}

}  // namespace

std::vector<std::size_t> rowsByX(const GroupPoint& group) {
    std::vector<std::size_t> order(group.x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return group.x[a] < group.x[b]; });
    return order;
}

bool arePositive(const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
}

GroupPoint pointOf(const Group& group, int round) {
    return pointOf(group, [round](const Sampled& sampled) { return sampled.at(round); });
}

GroupPoint pointOf(const Group& group) {
    return pointOf(group, [](const Sampled& sampled) { return sampled.point; });
}

std::vector<int> roundsOf(const Group& group) {
    std::vector<Sampled> all = group.x;
    for (const auto& operand : group.operands)
        all.insert(all.end(), operand.begin(), operand.end());
    return commonRounds(all);
}

Verdict verdictOf(const metrics::Interval& interval, const Requirement& requirement) {
    const bool isAboveLow = requirement.isLowExcluded ? interval.low > requirement.low
                                                      : interval.low >= requirement.low;
    const bool isBelowLow = requirement.isLowExcluded ? interval.high <= requirement.low
                                                      : interval.high < requirement.low;
    const bool isBelowHigh = requirement.isHighExcluded ? interval.high < requirement.high
                                                        : interval.high <= requirement.high;
    const bool isAboveHigh = requirement.isHighExcluded ? interval.low >= requirement.high
                                                        : interval.low > requirement.high;
    // A crossing that is not there lies outside of any range, an open one too.
    const bool isAbsent =
        requirement.isInfinityAbsence && std::isinf(interval.low) && interval.low == interval.high;
    const bool isPartlyAbsent =
        requirement.isInfinityAbsence && (std::isinf(interval.low) || std::isinf(interval.high));
    if (isBelowLow || isAboveHigh || isAbsent) return Verdict::Fails;
    if (isAboveLow && isBelowHigh && !isPartlyAbsent) return Verdict::Holds;
    return Verdict::Ambiguous;
}

double smallestGap(const GroupPoint& group) {
    double smallest = kInfinity;
    for (std::size_t i = 1; i < group.operands.size(); ++i) {
        for (std::size_t row = 0; row < group.operands[i].size(); ++row) {
            smallest = lesser(
                smallest, relativeDifference(group.operands[i - 1][row], group.operands[i][row]));
        }
    }
    return smallest;
}

double firstRatio(const GroupPoint& group) {
    return group.operands[0][0] / group.operands[1][0];
}

double exponent(const GroupPoint& group) {
    const std::vector<double>& y = group.operands[0];
    if (!arePositive(group.x) || !arePositive(y)) return kNan;
    const auto count = static_cast<double>(y.size());
    double meanX = 0.0, meanY = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        meanX += std::log(group.x[i]) / count;
        meanY += std::log(y[i]) / count;
    }
    double covariance = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        const double dx = std::log(group.x[i]) - meanX;
        covariance += dx * (std::log(y[i]) - meanY);
        variance += dx * dx;
    }
    return variance > 0.0 ? covariance / variance : kNan;
}

double smallestStep(const GroupPoint& group, int direction) {
    const std::vector<std::size_t> rows = rowsByX(group);
    double smallest = kInfinity;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const double step =
            relativeDifference(group.operands[0][rows[i - 1]], group.operands[0][rows[i]]);
        smallest = lesser(smallest, direction * step);
    }
    return smallest;
}

double spread(const GroupPoint& group) {
    const std::vector<double>& values = group.operands[0];
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low == *high) return 0.0;
    return (*high - *low) / std::abs(metrics::summarize(values, metrics::Statistic::Median));
}

double crossing(const GroupPoint& group) {
    const std::vector<double>& a = group.operands[0];
    const std::vector<double>& b = group.operands[1];
    if (!arePositive(group.x) || !arePositive(a) || !arePositive(b)) return kNan;
    const std::vector<std::size_t> rows = rowsByX(group);
    const auto difference = [&](std::size_t i) { return std::log(a[rows[i]] / b[rows[i]]); };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (std::isnan(difference(i))) return kNan;
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const double before = difference(i - 1);
        const double after = difference(i);
        if (before == 0.0) return group.x[rows[i - 1]];
        if (after != 0.0 && (before < 0.0) == (after < 0.0)) continue;
        return std::exp(std::lerp(std::log(group.x[rows[i - 1]]), std::log(group.x[rows[i]]),
                                  before / (before - after)));
    }
    const bool isNearer = std::abs(difference(rows.size() - 1)) < std::abs(difference(0));
    return isNearer ? kInfinity : -kInfinity;
}

double largestDifference(const GroupPoint& group) {
    // A scale such as 1/1024² may round the last bit of a number that was measured exactly.
    constexpr double kRounding = 1e-12;
    double largest = 0.0;
    for (std::size_t row = 0; row < group.operands[0].size(); ++row) {
        const double expected = group.operands[1][row];
        if (group.operands[0][row] == expected) continue;
        const double difference = std::abs(group.operands[0][row] - expected);
        const bool isRounding = difference <= kRounding * std::abs(expected);
        if (!isRounding || std::isinf(difference)) largest = greater(largest, difference);
    }
    return largest;
}

double largestDeviation(const GroupPoint& group) {
    double largest = 0.0;
    for (std::size_t row = 0; row < group.operands[0].size(); ++row) {
        const double expected = group.operands[1][row];
        if (group.operands[0][row] == expected) continue;
        const double difference = std::abs(group.operands[0][row] - expected);
        largest = greater(largest, difference / std::abs(expected));
    }
    return largest;
}

double familyWiseP(const GroupPoint& group) {
    const std::vector<double>& p = group.operands[0];
    return std::min(1.0, static_cast<double>(p.size()) * *std::ranges::min_element(p));
}

Judgement judge(Group group, const Quantity& quantity, const Requirement& requirement) {
    std::vector<Sampled*> all;
    for (auto& operand : group.operands)
        for (Sampled& sampled : operand) all.push_back(&sampled);
    const bool areDraws = keepRoundsOrDraws(all) && !requirement.isOfCounts;
    for (Sampled* sampled : all) {
        if (sampled->areDraws && !areDraws) *sampled = {sampled->point, {}, false};
    }
    Judgement judgement;
    const double point = quantity(pointOf(group));
    std::vector<double> values;
    for (const int round : roundsOf(group)) values.push_back(quantity(pointOf(group, round)));
    const auto isNotANumber = [](double value) { return std::isnan(value); };
    if (std::isnan(point) || std::ranges::any_of(values, isNotANumber)) {
        judgement.measured = "not a number";
        return judgement;
    }
    judgement.isSingleSample = values.empty();
    judgement.isAbsent = requirement.isInfinityAbsence && std::isinf(point);
    metrics::Interval interval{point, point};
    tables::Bounds bounds = tables::Bounds::None;
    const bool isEqual = std::ranges::all_of(values, [&](double value) { return value == point; });
    if (!isEqual && areDraws) {
        bounds = tables::Bounds::Interval;
        interval = tables::drawsInterval(values);
    } else if (!isEqual) {
        const auto told = metrics::medianInterval(values);
        const auto [low, high] = std::ranges::minmax(values);
        bounds = told ? tables::Bounds::Interval : tables::Bounds::Range;
        interval = told.value_or(metrics::Interval{low, high});
    }
    judgement.verdict = verdictOf(interval, requirement);
    judgement.measured = boundedText(point, bounds, interval, requirement);
    judgement.margin = std::min(point - requirement.low, requirement.high - point);
    judgement.marginText = quantityText(judgement.margin, requirement);
    return judgement;
}

std::string boundedText(double point, tables::Bounds bounds, const metrics::Interval& interval,
                        const Requirement& requirement) {
    const std::string text = quantityText(point, requirement);
    if (bounds == tables::Bounds::None) return text;
    return fmt::format(
        fmt::runtime(bounds == tables::Bounds::Interval ? "{} [{}, {}]" : "{} ({} … {})"), text,
        quantityText(interval.low, requirement), quantityText(interval.high, requirement));
}

std::string quantityText(double value, const Requirement& requirement) {
    if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
    return requirement.isPercent ? fmt::format("{:.4g} %", value * 100.0)
                                 : fmt::format("{:.4g}", value);
}

std::string rangeText(const Requirement& requirement) {
    const std::string low = quantityText(requirement.low, requirement);
    const std::string high = quantityText(requirement.high, requirement);
    if (std::isinf(requirement.high)) return (requirement.isLowExcluded ? "> " : "≥ ") + low;
    if (std::isinf(requirement.low)) return (requirement.isHighExcluded ? "< " : "≤ ") + high;
    return fmt::format("in {}{}, {}{}", requirement.isLowExcluded ? '(' : '[', low, high,
                       requirement.isHighExcluded ? ')' : ']');
}

}  // namespace gfxrepro::claims
