// trend: grows or falls along x, or as a power of x.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/checks.h"
#include "engine/metrics/alike.h"
#include "engine/metrics/statistics.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

using namespace types;

constexpr std::array<std::string_view, 2> kDirections = {"increasing", "decreasing"};

struct TrendKeys : GivenBounds {
    GivenKey trend, over, direction, strictly;
};
const KeyTable<TrendKeys>& trendTable() {
    using T = TrendKeys;
    static const KeyTable<T> table =
        boundedTable<T>({{&T::trend, "trend", "a", "required",
                          "grows or falls, or as a power; bounds are its exponent's", text()},
                         {&T::over, overKey(kOver, "along which")},
                         {&T::direction, choiceKey("direction", kDirections, "none", "which way")},
                         {&T::strictly, flagKey("strictly", "no two equal; with direction")}},
                        &T::direction);
    return table;
}

/// 1 increasing, −1 decreasing, 0 by its exponent alone.
int directionOf(const TrendKeys& given, const std::string& what) {
    const GivenKey& direction = given.direction;
    if (!direction) return 0;
    return direction.choice(what) == 0 ? 1 : -1;
}

void readTrend(const ClaimKeys& keys, const TrendKeys& given, ClaimSpec& claim) {
    keys.readOne(given.trend, claim);
    keys.readOver(given.over, claim);
    keys.readBounds(given, claim, &given.direction);
    const int direction = directionOf(given, keys.what);
    const GivenKey& strictly = given.strictly;
    if (!strictly) return;
    (void)strictly.flag(keys.what);
    if (direction == 0) {
        keys.fail(*strictly, strictly.name() + " needs '" + given.direction.name() + "'");
    }
}

/// The least-squares slope of log(operand) over log(x), without the digits that logarithms round:
/// what grows as x² has exactly 2, and what is areAlike does not grow. Not-a-number unless all are
/// positive.
double exponent(const GroupPoint& group) {
    if (!arePositive(group.x) || !arePositive(group.operands[0])) return kNan;
    const std::vector<double> x = metrics::withoutRounding(group.x);
    const std::vector<double> y = metrics::withoutRounding(group.operands[0]);
    const auto count = static_cast<double>(y.size());
    double meanX = 0.0, meanY = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        meanX += std::log(x[i]) / count;
        meanY += std::log(y[i]) / count;
    }
    double covariance = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        const double dx = std::log(x[i]) - meanX;
        covariance += dx * (std::log(y[i]) - meanY);
        variance += dx * dx;
    }
    constexpr double kKnown = 1e12;
    return variance > 0.0 ? std::round(covariance / variance * kKnown) / kKnown : kNan;
}

/// With the rows sorted by x, the smallest step towards `direction`, relative to the larger of its
/// ends.
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

/// Exponent: a distance of one in it is a factor of x's range in the time.
Contrasts slope(Requirement requirement) {
    Contrast contrast{"exponent", exponent, std::move(requirement), Scale::Linear};
    contrast.distance = [range = contrast.requirement](const GroupPoint& group, double value) {
        const auto [low, high] = std::ranges::minmax(group.x);
        return distanceToBound(value, range) * std::log(high / low);
    };
    return [contrast](const GroupPoint&) { return std::vector<Contrast>{contrast}; };
}

/// Of the steps between neighbours by x, the one that begins at `place`, towards `direction`.
GroupNumber stepAt(std::size_t place, int direction) {
    return [place, direction](const GroupPoint& group) {
        const std::vector<std::size_t> rows = rowsByX(group);
        return direction * relativeDifference(group.operands[0][rows[place]],
                                              group.operands[0][rows[place + 1]]);
    };
}

/// Only what surely contradicts counts; within the noise it leaves the claim open.
Decision unlessSurelyBack(const metrics::Interval& step, double noise) {
    if (step.high >= 0.0) return {Verdict::Holds};
    if (step.high < -noise) return {Verdict::Fails};
    return {Verdict::Ambiguous, "a step back in every round, within the noise of these times"};
}

/// Of one that has to be: what is equal is so whatever the noise.
double distanceOfStep(const GroupPoint&, double step) {
    return step == 0.0 ? kInfinity : std::abs(step);
}

/// Direction: Kendall's rank correlation with x is above 0 towards it (Kendall 1938), and no step
/// goes back by more than the noise of these times for certain. Strictly: each surely forward.
Contrasts rising(int direction, bool isStrict) {
    return [direction, isStrict](const GroupPoint& group) {
        Requirement above;
        above.low = 0.0;
        above.isLowExcluded = true;
        const GroupNumber rank = [direction](const GroupPoint& one) {
            return direction * metrics::kendall(one.x, one.operands[0]);
        };
        Contrast whole{"rank correlation", rank, above, Scale::Linear};
        // From the first row to the last.
        whole.distance = [](const GroupPoint& one, double) {
            const std::vector<std::size_t> rows = rowsByX(one);
            const double first = one.operands[0][rows.front()];
            const double last = one.operands[0][rows.back()];
            return first > 0.0 && last > 0.0 ? std::abs(std::log(last / first)) : kInfinity;
        };
        std::vector<Contrast> contrasts{whole};
        Requirement notBack;
        notBack.low = 0.0;
        notBack.isLowExcluded = isStrict;
        notBack.isPercent = true;
        for (std::size_t place = 0; place + 1 < group.x.size(); ++place) {
            Contrast& step = contrasts.emplace_back(
                Contrast{"step", stepAt(place, direction), notBack, Scale::Linear});
            step.isBeside = true;
            if (isStrict) {
                step.distance = distanceOfStep;
            } else {
                step.decide = unlessSurelyBack;
            }
        }
        return contrasts;
    };
}

std::vector<ClaimPart> trendParts(const ClaimSpec& claim) {
    const TrendKeys given = trendTable().find(claim.keys);
    const bool isStrict = given.strictly && given.strictly->asBool();
    std::vector<ClaimPart> parts;
    if (const int direction = directionOf(given, claim.id); direction != 0) {
        const auto step = [direction](const GroupPoint& group) {
            return smallestStep(group, direction);
        };
        ClaimPart part{{0}, step, {}, "smallest step"};
        part.requirement.low = 0.0;
        part.requirement.isLowExcluded = isStrict;
        part.requirement.isPercent = true;
        part.requirement.text = std::string(isStrict ? "strictly " : "") +
                                (direction > 0 ? "increasing" : "decreasing") + " with " +
                                claim.over.value_or("");
        part.onTimes = rising(direction, isStrict);
        parts.push_back(std::move(part));
    }
    if (claim.hasBound()) {
        parts.push_back({{0}, exponent, rangeOf(claim, "exponent"), "exponent"});
        parts.back().onTimes = slope(parts.back().requirement);
    }
    for (ClaimPart& part : parts) {
        part.needsX = true;
        part.minRows = 2;
    }
    return parts;
}

}  // namespace

Kind trend() {
    return {trendTable().section(), readBy<trendTable, readTrend>, trendParts,
            Kind::Compares::Rows};
}

}  // namespace gfxrepro::claims
