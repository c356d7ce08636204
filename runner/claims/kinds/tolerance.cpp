// tolerance: is the printed number, within a share of it.
#include <cmath>

#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

/// At 100 % of the printed value nothing would be too little.
constexpr NumberRange kDeviations{.least = 0, .most = 1, .isMostExcluded = true};

void readTolerance(const ClaimKeys& keys, ClaimSpec& claim) {
    keys.readOne(claim);
    keys.requirePrinted();
    claim.high = keys.readShare("at_most", kDeviations);
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
    const bool isFromPrint = claim.boundFrom == ClaimSpec::BoundSource::Print;
    if (!isFromPrint || claim.origin == ClaimSpec::Origin::Ours) return "";
    return "is 'tolerance', whose width is never printed; write 'bound_from: ours', or 'text'";
}

}  // namespace

Kind tolerance() {
    Kind kind{sectionOf({"tolerance", "a", "", "is the printed value", types::text()},
                        {shareKey("at_most", kDeviations, "how far from the printed value")}),
              readTolerance, toleranceParts, Kind::Compares::Values};
    kind.refused = refusedTolerance;
    return kind;
}

}  // namespace gfxrepro::claims
