// bound: every value lies within bounds.
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

void readBound(const ClaimKeys& keys, ClaimSpec& claim) {
    keys.readOne(claim);
    keys.readBounds(claim);
}

std::vector<ClaimPart> boundParts(const ClaimSpec& claim) {
    const auto value = [](const GroupPoint& group) { return group.operands[0][0]; };
    return {{{0}, value, rangeOf(claim, claim.operands[0])}};
}

}  // namespace

Kind bound() {
    return {boundedSection({"bound", "a", "", "every value lies within bounds", types::text()}),
            readBound, boundParts, Kind::Compares::Values, Scale::Logarithmic};
}

}  // namespace gfxrepro::claims
