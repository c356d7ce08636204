// exact: is the printed number, or a given one.
#include <cmath>

#include "engine/metrics/alike.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

using namespace types;

struct ExactKeys {
    GivenKey exact, equals;
};
const KeyTable<ExactKeys>& exactTable() {
    using E = ExactKeys;
    static const KeyTable<E> table =
        kindTable<E>({{&E::exact, "exact", "a", "required", "is exactly so", text()},
                      {&E::equals, "equals", "number | printed", "required", "what it is",
                       anyOf({number(), choice({"printed"})})}});
    return table;
}

void readExact(const ClaimKeys& keys, const ExactKeys& given, ClaimSpec& claim) {
    keys.readOne(given.exact, claim);
    const Node& equals = *given.equals;
    if (equals.isScalar() && equals.text() == "printed") return keys.requirePrinted();
    if (!equals.tryDouble()) keys.refuse(given.equals, "a number, or printed");
    claim.low = claim.high = equals.tryDouble();
}

/// The largest |measured − expected| over the rows; operands are these two.
double largestDifference(const GroupPoint& group) {
    double largest = 0.0;
    for (std::size_t row = 0; row < group.operands[0].size(); ++row) {
        const double expected = group.operands[1][row];
        // A scale such as 1/1024² may round the last bit of a number that was measured exactly.
        if (metrics::areAlike(group.operands[0][row], expected)) continue;
        largest = greater(largest, std::abs(group.operands[0][row] - expected));
    }
    return largest;
}

std::vector<ClaimPart> exactParts(const ClaimSpec& claim) {
    ClaimPart part{{0}, largestDifference, {}, "largest difference"};
    part.requirement.high = 0.0;
    part.requirement.isOfCounts = true;
    part.requirement.text = claim.operands[0] + " = " +
                            (claim.low ? quantityText(*claim.low, part.requirement) : "printed");
    part.needsExpected = true;
    return {part};
}

}  // namespace

Kind exact() {
    Kind kind{exactTable().section(), readBy<exactTable, readExact>, exactParts,
              Kind::Compares::Values};
    kind.boundedForm = "'bound: a' with it";
    return kind;
}

}  // namespace gfxrepro::claims
