// bound: every value lies within bounds.
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

struct BoundKeys : GivenBounds {
    GivenKey bound;
};
const KeyTable<BoundKeys>& boundTable() {
    static const KeyTable<BoundKeys> table =
        boundedTable<BoundKeys>({{&BoundKeys::bound, "bound", "a", "required",
                                  "every value lies within bounds", types::text()}});
    return table;
}

void readBound(const ClaimKeys& keys, const BoundKeys& given, ClaimSpec& claim) {
    keys.readOne(given.bound, claim);
    keys.readBounds(given, claim);
}

std::vector<ClaimPart> boundParts(const ClaimSpec& claim) {
    const auto value = [](const GroupPoint& group) { return group.operands[0][0]; };
    return {{{0}, value, rangeOf(claim, claim.operands[0])}};
}

}  // namespace

Kind bound() {
    return {boundTable().section(), readBy<boundTable, readBound>, boundParts,
            Kind::Compares::Values, Scale::Logarithmic};
}

}  // namespace gfxrepro::claims
