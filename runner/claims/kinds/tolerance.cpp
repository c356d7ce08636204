// tolerance: is the printed number, within a share of it.
#include <cmath>

#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

void readTolerance(const ClaimKeys& keys, ClaimSpec& claim) {
    keys.readOne(claim);
    keys.requirePrinted();
    keys.readShare(claim);
}

/// The largest |measured − expected| / |expected|; operands are these two.
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

std::vector<ClaimPart> toleranceParts(const ClaimSpec& claim) {
    ClaimPart part{
        {0}, largestDeviation, rangeOf(claim, "deviation from printed", true), "largest deviation"};
    part.needsExpected = true;
    return {part};
}

std::string refusedTolerance(const ClaimSpec& claim, const Sampling&) {
    if (*claim.high >= 1.0) {
        return "is within 100 % of what is printed or more, so that nothing is too little";
    }
    const bool isFromPrint = claim.boundFrom == ClaimSpec::BoundSource::Print;
    if (!isFromPrint || claim.origin == ClaimSpec::Origin::Ours) return "";
    return "has its bound from print, and how far from it a tolerance may be is not";
}

}  // namespace

Kind tolerance() {
    Kind kind{sectionOf({"tolerance", "a", "", "is the printed value", types::text()},
                        {shareKey("at_most", "25% | fraction", "how far from the printed value")}),
              readTolerance, toleranceParts, Kind::Compares::Values};
    kind.refused = refusedTolerance;
    return kind;
}

}  // namespace gfxrepro::claims
