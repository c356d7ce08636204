#include "runner/report/claim_parts.h"

#include <fmt/format.h>

#include "runner/core/text.h"

namespace gfxrepro::report {

namespace {

using Type = config::ClaimSpec::Type;

Requirement rangeOf(const config::ClaimSpec& claim, const std::string& name,
                    bool isPercent = false) {
    Requirement requirement;
    if (claim.low) requirement.low = *claim.low;
    if (claim.high) requirement.high = *claim.high;
    requirement.isLowExcluded = claim.isLowExcluded;
    requirement.isHighExcluded = claim.isHighExcluded;
    requirement.isPercent = isPercent;
    requirement.text = name + " " + rangeText(requirement);
    return requirement;
}

ClaimPart orderPart(const config::ClaimSpec& claim) {
    ClaimPart part{{}, smallestGap, {}, "smallest gap"};
    for (std::size_t i = 0; i < claim.operands.size(); ++i) part.operands.push_back(i);
    part.requirement.low = 0.0;
    part.requirement.isLowExcluded = true;
    part.requirement.isPercent = true;
    part.requirement.text = joined(claim.operands, " < ");
    part.onTimes = neighbourGaps(part.requirement);
    return part;
}

std::vector<ClaimPart> trendParts(const config::ClaimSpec& claim) {
    std::vector<ClaimPart> parts;
    if (claim.direction != 0) {
        const int direction = claim.direction;
        ClaimPart part{
            {0},
            [direction](const GroupPoint& group) { return smallestStep(group, direction); },
            {},
            "smallest step"};
        part.requirement.low = 0.0;
        part.requirement.isLowExcluded = claim.isStrict;
        part.requirement.isPercent = true;
        part.requirement.text = std::string(claim.isStrict ? "strictly " : "") +
                                (direction > 0 ? "increasing" : "decreasing") + " with " +
                                claim.over.value_or("");
        part.onTimes = rising(direction);
        parts.push_back(std::move(part));
    }
    if (claim.low || claim.high) {
        parts.push_back({{0}, exponent, rangeOf(claim, "exponent"), "exponent"});
        parts.back().onTimes = slope(parts.back().requirement);
    }
    for (ClaimPart& part : parts) {
        part.needsX = true;
        part.minRows = 2;
    }
    return parts;
}

std::vector<ClaimPart> independentParts(const config::ClaimSpec& claim) {
    std::vector<ClaimPart> parts;
    for (std::size_t i = 0; i < claim.operands.size(); ++i) {
        const std::string name = "spread of " + claim.operands[i];
        parts.push_back({{i}, spread, rangeOf(claim, name, true), "spread"});
        parts.back().minRows = 2;
        parts.back().onTimes = allAlike(claim.high.value_or(0.0));
    }
    return parts;
}

ClaimPart exactPart(const config::ClaimSpec& claim) {
    ClaimPart part{{0}, largestDifference, {}, "largest difference"};
    part.requirement.high = 0.0;
    part.requirement.isOfCounts = true;
    part.requirement.text = claim.operands[0] + " = " +
                            (claim.low ? quantityText(*claim.low, part.requirement) : "printed");
    part.needsExpected = true;
    return part;
}

ClaimPart tolerancePart(const config::ClaimSpec& claim) {
    ClaimPart part{
        {0}, largestDeviation, rangeOf(claim, "deviation from printed", true), "largest deviation"};
    part.needsExpected = true;
    return part;
}

ClaimPart crossoverPart(const config::ClaimSpec& claim) {
    ClaimPart part{{0, 1},
                   crossing,
                   rangeOf(claim, "crossing of " + joined(claim.operands, " and ") + " at " +
                                      claim.over.value_or("")),
                   "crossing at"};
    part.requirement.isInfinityAbsence = true;
    part.needsX = true;
    part.minRows = 2;
    return part;
}

ClaimPart sameMeanPart(const config::ClaimSpec& claim) {
    ClaimPart part{{0}, familyWiseP, {}, "p of all rows"};
    part.requirement.low = *claim.low;
    part.requirement.text = fmt::format("the same expectation ({}: p of all rows ≥ {:.4g})",
                                        claim.operands[0], *claim.low);
    return part;
}

std::vector<ClaimPart> partsByType(const config::ClaimSpec& claim) {
    switch (claim.type) {
        case Type::Order:
            return {orderPart(claim)};
        case Type::Ratio:
            return {{{0, 1}, firstRatio, rangeOf(claim, joined(claim.operands, " / ")), ""}};
        case Type::Trend:
            return trendParts(claim);
        case Type::Independent:
            return independentParts(claim);
        case Type::Bound:
            return {{{0},
                     [](const GroupPoint& group) { return group.operands[0][0]; },
                     rangeOf(claim, claim.operands[0]),
                     ""}};
        case Type::Exact:
            return {exactPart(claim)};
        case Type::Tolerance:
            return {tolerancePart(claim)};
        case Type::Crossover:
            return {crossoverPart(claim)};
        case Type::SameMean:
            return {sameMeanPart(claim)};
    }
    return {};
}

/// Ratios and times scatter evenly on a logarithmic scale; of where curves cross none is known.
Scale scaleOf(Type type) {
    if (type == Type::Crossover) return Scale::Ranks;
    return type == Type::Ratio || type == Type::Bound ? Scale::Logarithmic : Scale::Linear;
}

}  // namespace

std::vector<ClaimPart> partsOf(const config::ClaimSpec& claim) {
    std::vector<ClaimPart> parts = partsByType(claim);
    for (ClaimPart& part : parts) {
        if (part.onTimes) continue;
        part.onTimes =
            asItself(part.measuredName, part.quantity, part.requirement, scaleOf(claim.type));
    }
    return parts;
}

}  // namespace gfxrepro::report
