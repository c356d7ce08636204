#include "runner/claims/claim_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/core/text.h"

namespace gfxrepro::claims {

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

std::vector<ClaimPart> ratioParts(const config::ClaimSpec& claim) {
    return {{{0, 1}, firstRatio, rangeOf(claim, joined(claim.operands, " / ")), ""}};
}

std::vector<ClaimPart> boundParts(const config::ClaimSpec& claim) {
    return {{{0},
             [](const GroupPoint& group) { return group.operands[0][0]; },
             rangeOf(claim, claim.operands[0]),
             ""}};
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
    std::vector<ClaimPart> parts = {
        {{0, 1},
         crossing,
         rangeOf(claim, "crossing of " + joined(claim.operands, " and ") + " at " +
                            claim.over.value_or("")),
         "crossing at"}};
    ClaimPart& part = parts.front();
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

template <ClaimPart (*part)(const config::ClaimSpec&)>
std::vector<ClaimPart> alone(const config::ClaimSpec& claim) {
    return {part(claim)};
}

/// A kind of claim: what it is judged by, and the scale on which that scatters evenly where it is
/// of times. Ratios and times do on a logarithmic one; of where curves cross none is known.
struct Kind {
    Type type;
    std::vector<ClaimPart> (*parts)(const config::ClaimSpec&);
    Scale scale = Scale::Linear;
};
constexpr std::array<Kind, 9> kKinds = {{
    {Type::Order, alone<orderPart>},
    {Type::Ratio, ratioParts, Scale::Logarithmic},
    {Type::Trend, trendParts},
    {Type::Independent, independentParts},
    {Type::Bound, boundParts, Scale::Logarithmic},
    {Type::Exact, alone<exactPart>},
    {Type::Tolerance, alone<tolerancePart>},
    {Type::Crossover, alone<crossoverPart>, Scale::Ranks},
    {Type::SameMean, alone<sameMeanPart>},
}};

}  // namespace

std::vector<ClaimPart> partsOf(const config::ClaimSpec& claim) {
    const Kind& kind = *std::ranges::find(kKinds, claim.type, &Kind::type);
    std::vector<ClaimPart> parts = kind.parts(claim);
    for (ClaimPart& part : parts) {
        if (part.onTimes) continue;
        part.onTimes = asItself(part.measuredName, part.quantity, part.requirement, kind.scale);
    }
    return parts;
}

}  // namespace gfxrepro::claims
