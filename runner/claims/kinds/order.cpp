// order: a < b < c.
#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

void readOrder(const ClaimKeys& keys, ClaimSpec& claim) {
    keys.readSides("<", claim);
    if (claim.operands.size() < 2) keys.refuse(keys.operands, "order", "a < b < …");
}

/// The smallest relative difference of neighbours over the rows.
double smallestGap(const GroupPoint& group) {
    double smallest = kInfinity;
    for (std::size_t i = 1; i < group.operands.size(); ++i) {
        for (std::size_t row = 0; row < group.operands[i].size(); ++row) {
            smallest = lesser(
                smallest, relativeDifference(group.operands[i - 1][row], group.operands[i][row]));
        }
    }
    return smallest;
}

/// The gap of each pair of neighbours.
Contrasts neighbourGaps(const Requirement& requirement) {
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

std::vector<ClaimPart> orderParts(const ClaimSpec& claim) {
    ClaimPart part{{}, smallestGap, {}, "smallest gap"};
    for (std::size_t i = 0; i < claim.operands.size(); ++i) part.operands.push_back(i);
    part.requirement.low = 0.0;
    part.requirement.isLowExcluded = true;
    part.requirement.isPercent = true;
    part.requirement.text = joined(claim.operands, " < ");
    part.onTimes = neighbourGaps(part.requirement);
    return {part};
}

}  // namespace

Kind order() {
    return {sectionOf({"order", "a < b < c", "", "in this order", types::text()}, {}), readOrder,
            orderParts};
}

}  // namespace gfxrepro::claims
