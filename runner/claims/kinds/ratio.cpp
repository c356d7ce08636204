// ratio: a / b.
#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

void readRatio(const ClaimKeys& keys, ClaimSpec& claim) {
    keys.readSides(" / ", claim);
    if (claim.operands.size() != 2) keys.refuse(keys.operands, "ratio", "a / b");
    keys.readBounds(claim);
}

std::vector<ClaimPart> ratioParts(const ClaimSpec& claim) {
    const auto ratio = [](const GroupPoint& group) {
        return group.operands[0][0] / group.operands[1][0];
    };
    return {{{0, 1}, ratio, rangeOf(claim, joined(claim.operands, " / "))}};
}

}  // namespace

Kind ratio() {
    return {boundedSection({"ratio", "a / b", "", "the ratio lies within bounds", types::text()}),
            readRatio, ratioParts, Kind::Compares::Operands, Scale::Logarithmic};
}

}  // namespace gfxrepro::claims
