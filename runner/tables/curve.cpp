#include "runner/tables/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace gfxrepro::tables {

namespace {

/// Whether one of the values is no logarithm's.
bool isLinear(std::span<const std::pair<double, double>> points, double at) {
    return at <= 0.0 || std::ranges::any_of(points, [](const auto& point) {
               return point.first <= 0.0 || point.second <= 0.0;
           });
}

/// Of one round.
double readAt(std::span<const std::pair<double, double>> points, double at) {
    const bool isPlain = isLinear(points, at);
    const auto scaled = [&](double value) { return isPlain ? value : std::log(value); };
    std::set<double> values;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto [x0, y0] = points[i - 1];
        const auto [x1, y1] = points[i];
        if (at < std::min(x0, x1) || at > std::max(x0, x1)) continue;
        if (x0 == x1) {
            values.insert({y0, y1});
            continue;
        }
        if (at == x0 || at == x1) {
            values.insert(at == x0 ? y0 : y1);
            continue;
        }
        const double share = (scaled(at) - scaled(x0)) / (scaled(x1) - scaled(x0));
        const double value = std::lerp(scaled(y0), scaled(y1), share);
        values.insert(isPlain ? value : std::exp(value));
    }
    return values.size() == 1 ? *values.begin() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Summary readCurve(std::span<const CurvePoint> curve, double at) {
    std::vector<Sampled> all;
    std::vector<std::pair<double, double>> points;
    for (const CurvePoint& point : curve) {
        all.insert(all.end(), {point.x, point.y});
        points.emplace_back(point.x.point, point.y.point);
    }
    const double value = readAt(points, at);
    std::map<int, double> rounds;
    const bool isOver = std::ranges::any_of(
        all, [](const Sampled& sampled) { return !sampled.overProcesses.empty(); });
    for (const int round : isOver ? std::vector<int>() : commonRounds(all)) {
        points.clear();
        for (const CurvePoint& point : curve) {
            points.emplace_back(point.x.at(round), point.y.at(round));
        }
        rounds[round] = readAt(points, at);
    }
    const bool isThere =
        std::ranges::all_of(rounds, [](const auto& round) { return std::isfinite(round.second); });
    if (!isThere || !std::isfinite(value))
        return summaryOf(std::numeric_limits<double>::quiet_NaN(), {}, false);
    Summary summary = summaryOf(value, std::move(rounds), false);
    summary.isOverProcesses = isOver;
    return summary;
}

std::string whyNoValue(std::span<const CurvePoint> curve, const std::string& metric, double at) {
    const auto [low, high] =
        std::ranges::minmax(curve, {}, [](const CurvePoint& point) { return point.x.point; });
    if (low.x.point <= at && at <= high.x.point) {
        return fmt::format("'{}' passes {:.4g} more than once, or not in every process", metric,
                           at);
    }
    return fmt::format("'{}' goes from {:.4g} to {:.4g} and does not reach {:.4g}", metric,
                       low.x.point, high.x.point, at);
}

}  // namespace gfxrepro::tables
