#include "runner/claims/claim_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gfxrepro::claims {

namespace {

/// To the nearest bound, as the share by which a time would differ.
double ratioToBound(double value, const Requirement& requirement) {
    double nearest = kInfinity;
    for (const double bound : {requirement.low, requirement.high}) {
        if (!std::isfinite(bound) || !std::isfinite(value)) continue;
        const double larger = std::max(std::abs(value), std::abs(bound));
        const double distance = value > 0.0 && bound > 0.0 ? std::abs(std::log(value / bound))
                                : larger > 0.0             ? std::abs(value - bound) / larger
                                                           : 0.0;
        nearest = std::min(nearest, distance);
    }
    return nearest;
}

double toBound(double value, const Requirement& requirement) {
    return std::min(std::abs(value - requirement.low), std::abs(requirement.high - value));
}

/// Between the smallest and the largest x, as logarithms.
double logRange(const GroupPoint& group) {
    const auto [low, high] = std::ranges::minmax(group.x);
    return std::log(high / low);
}

/// The value in the middle of the rounds and its interval, on the contrast's scale.
struct Told {
    double middle = 0.0;
    metrics::Interval interval;
};

Told tell(std::vector<double> rounds, Scale scale) {
    const bool isFinite =
        std::ranges::all_of(rounds, [](double value) { return std::isfinite(value); });
    if (scale == Scale::Ranks || !isFinite) {
        return {metrics::summarize(rounds, metrics::Statistic::Median),
                *metrics::medianInterval(rounds)};
    }
    const bool isLogarithmic = scale == Scale::Logarithmic && arePositive(rounds);
    if (isLogarithmic) {
        for (double& value : rounds) value = std::log(value);
    }
    Told told{metrics::centre(rounds), *metrics::centreInterval(rounds)};
    if (isLogarithmic) {
        told = {std::exp(told.middle), {std::exp(told.interval.low), std::exp(told.interval.high)}};
    }
    return told;
}

/// A verdict, where times are far enough apart for one.
void decide(const Contrast& contrast, const Told& told, double distance, double noise,
            Judgement& judgement) {
    judgement.verdict = verdictOf(told.interval, contrast.requirement);
    if (contrast.isRefutation) {
        // Only what surely contradicts counts; within the noise it leaves the claim open.
        if (judgement.verdict != Verdict::Fails) {
            judgement.verdict = Verdict::Holds;
        } else if (toBound(told.interval.high, contrast.requirement) <= noise) {
            judgement.verdict = Verdict::Ambiguous;
            judgement.why = "a step back in every round, within the noise of this table";
        }
        return;
    }
    const bool isDecided =
        judgement.verdict == Verdict::Holds || judgement.verdict == Verdict::Fails;
    if (!isDecided || distance >= noise) return;
    judgement.verdict = Verdict::Ambiguous;
    judgement.why =
        fmt::format("nearer to the bound than the noise of this table, {:.3g} %", 100.0 * noise);
}

std::string whyTooFew(std::size_t rounds) {
    if (rounds < 2) return "one sample of a time decides nothing";
    return fmt::format("a range of {} processes; an interval needs {}", rounds,
                       metrics::kFewestForInterval);
}

Judgement judgeContrast(const Group& group, const std::vector<int>& rounds,
                        const Contrast& contrast, double noise) {
    const GroupPoint whole = pointOf(group);
    double middle = contrast.quantity(whole);
    std::vector<double> values;
    for (const int round : rounds) values.push_back(contrast.quantity(pointOf(group, round)));
    Judgement judgement;
    if (std::isnan(middle) ||
        std::ranges::any_of(values, [](double value) { return std::isnan(value); })) {
        judgement.measured = "not a number";
        return judgement;
    }
    const Requirement& requirement = contrast.requirement;
    if (values.size() < metrics::kFewestForInterval) {
        judgement.verdict = Verdict::Ambiguous;
        judgement.why = whyTooFew(values.size());
        metrics::Interval range{middle, middle};
        if (values.size() > 1) range = {std::ranges::min(values), std::ranges::max(values)};
        judgement.measured =
            boundedText(middle, values.size() > 1 ? tables::Bounds::Range : tables::Bounds::None,
                        range, requirement);
    } else {
        const Told told = tell(values, contrast.scale);
        middle = told.middle;
        const double distance = contrast.distance ? contrast.distance(whole, middle)
                                                  : ratioToBound(middle, requirement);
        decide(contrast, told, distance, noise, judgement);
        judgement.measured =
            boundedText(middle, tables::Bounds::Interval, told.interval, requirement);
    }
    if (!contrast.name.empty()) judgement.measured = contrast.name + " " + judgement.measured;
    judgement.isAbsent = requirement.isInfinityAbsence && std::isinf(middle);
    judgement.margin = std::min(middle - requirement.low, requirement.high - middle);
    judgement.marginText = quantityText(judgement.margin, requirement);
    return judgement;
}

/// Of the steps between neighbours by x, the one that begins at `place`, towards `direction`.
Quantity stepAt(std::size_t place, int direction) {
    return [place, direction](const GroupPoint& group) {
        const std::vector<std::size_t> rows = rowsByX(group);
        const double before = group.operands[0][rows[place]];
        const double after = group.operands[0][rows[place + 1]];
        if (before == after) return 0.0;
        return direction * (after - before) / std::max(std::abs(before), std::abs(after));
    };
}

}  // namespace

Contrasts asItself(std::string name, Quantity quantity, Requirement requirement, Scale scale) {
    Contrast contrast{std::move(name), std::move(quantity), std::move(requirement), scale};
    if (scale == Scale::Linear) {
        contrast.distance = [range = contrast.requirement](const GroupPoint&, double value) {
            return toBound(value, range);
        };
    }
    if (scale == Scale::Ranks) contrast.distance = [](const auto&, double) { return kInfinity; };
    return [contrast](const GroupPoint&) { return std::vector<Contrast>{contrast}; };
}

Contrasts neighbourGaps(Requirement requirement) {
    return [requirement](const GroupPoint& group) {
        std::vector<Contrast> contrasts;
        for (std::size_t i = 1; i < group.operands.size(); ++i) {
            const Quantity gap = [i](const GroupPoint& all) {
                return smallestGap({{all.operands[i - 1], all.operands[i]}, {}});
            };
            contrasts.push_back(asItself("gap", gap, requirement, Scale::Linear)(group)[0]);
        }
        return contrasts;
    };
}

Contrasts slope(Requirement requirement) {
    Contrast contrast{"exponent", exponent, std::move(requirement), Scale::Linear};
    contrast.distance = [range = contrast.requirement](const GroupPoint& group, double value) {
        return toBound(value, range) * logRange(group);
    };
    return [contrast](const GroupPoint&) { return std::vector<Contrast>{contrast}; };
}

Contrasts rising(int direction) {
    return [direction](const GroupPoint& group) {
        Requirement above;
        above.low = 0.0;
        above.isLowExcluded = true;
        const Quantity rank = [direction](const GroupPoint& one) {
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
        notBack.isPercent = true;
        for (std::size_t place = 0; place + 1 < group.x.size(); ++place) {
            contrasts.push_back(
                {"step", stepAt(place, direction), notBack, Scale::Linear, {}, true});
        }
        return contrasts;
    };
}

Contrasts allAlike(double within) {
    return [within](const GroupPoint& group) {
        Requirement alike;
        alike.low = 1.0 / (1.0 + within);
        alike.high = 1.0 + within;
        const std::vector<double>& values = group.operands[0];
        std::vector<Contrast> contrasts;
        for (std::size_t i = 0; i < values.size(); ++i) {
            for (std::size_t j = i + 1; j < values.size(); ++j) {
                const bool isRising = values[i] <= values[j];
                const std::size_t low = isRising ? i : j, high = isRising ? j : i;
                const Quantity ratio = [low, high](const GroupPoint& one) {
                    return one.operands[0][high] / one.operands[0][low];
                };
                contrasts.push_back({"ratio of two rows", ratio, alike});
            }
        }
        return contrasts;
    };
}

Judgement judgeTimes(const Group& group, const Contrasts& contrasts, std::optional<double> noise) {
    const std::vector<int> rounds = roundsOf(group);
    std::optional<Judgement> worst;
    for (const Contrast& contrast : contrasts(pointOf(group))) {
        Judgement judgement = judgeContrast(group, rounds, contrast, noise.value_or(0.0));
        const auto isWorse = [&] {
            const int left = severity(judgement.verdict), right = severity(worst->verdict);
            return left != right ? left > right
                                 : judgement.margin < worst->margin && !contrast.isRefutation;
        };
        if (!worst || isWorse()) worst = std::move(judgement);
    }
    return worst.value_or(Judgement{});
}

}  // namespace gfxrepro::claims
