// tolerance: is the printed number, within a share of it.
#include <cmath>

#include "engine/metrics/alike.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

/// At 100 % of the printed value nothing would be too little.
constexpr NumberRange kDeviations{.least = 0, .most = 1, .isMostExcluded = true};

struct ToleranceKeys {
    GivenKey tolerance, atMost;
};
const KeyTable<ToleranceKeys>& toleranceTable() {
    using T = ToleranceKeys;
    static const KeyTable<T> table = kindTable<T>(
        {{&T::tolerance, "tolerance", "a", "required", "is the printed value", types::text()},
         {&T::atMost, shareKey(kAtMost, kDeviations, "how far from the printed value")}});
    return table;
}

void readTolerance(const ClaimKeys& keys, const ToleranceKeys& given, ClaimSpec& claim) {
    keys.readOne(given.tolerance, claim);
    keys.requirePrinted();
    claim.high = keys.readShare(given.atMost, kDeviations);
}

/// The largest |measured − expected| / |expected|; operands are these two.
double largestDeviation(const GroupPoint& group) {
    double largest = 0.0;
    for (std::size_t row = 0; row < group.operands[0].size(); ++row) {
        const double expected = group.operands[1][row];
        if (metrics::areAlike(group.operands[0][row], expected)) continue;
        const double difference = std::abs(group.operands[0][row] - expected);
        largest = greater(largest, difference / std::abs(expected));
    }
    return largest;
}

/// Of each row its own, with its sign: without, noise alone is a deviation.
Contrasts deviations(Requirement within) {
    within.low = -within.high;
    return [within](const GroupPoint& group) {
        std::vector<Contrast> contrasts;
        for (std::size_t row = 0; row < group.operands[0].size(); ++row) {
            const GroupNumber deviation = [row](const GroupPoint& one) {
                const double value = one.operands[0][row], expected = one.operands[1][row];
                return metrics::areAlike(value, expected) ? 0.0
                                                          : (value - expected) / std::abs(expected);
            };
            contrasts.push_back(asItself("deviation", deviation, within, Scale::Linear)(group)[0]);
        }
        return contrasts;
    };
}

std::vector<ClaimPart> toleranceParts(const ClaimSpec& claim) {
    ClaimPart part{
        {0}, largestDeviation, rangeOf(claim, "deviation from printed", true), "largest deviation"};
    part.needsExpected = true;
    part.onTimes = deviations(part.requirement);
    return {part};
}

std::string refusedTolerance(const ClaimSpec& claim, const Sampling&) {
    const bool isFromPrint = claim.boundFrom == ClaimSpec::BoundSource::Print;
    if (!isFromPrint || claim.origin == ClaimSpec::Origin::Ours) return "";
    return "is 'tolerance', whose width is never printed; write 'bound_from: ours', or 'text'";
}

}  // namespace

Kind tolerance() {
    Kind kind{toleranceTable().section(), readBy<toleranceTable, readTolerance>, toleranceParts,
              Kind::Compares::Values};
    kind.refused = refusedTolerance;
    return kind;
}

}  // namespace gfxrepro::claims
