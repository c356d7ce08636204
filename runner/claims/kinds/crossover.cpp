// crossover: two change places along x.
#include <cmath>

#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

using namespace types;

struct CrossoverKeys : GivenBounds {
    GivenKey crossover, over;
};
const KeyTable<CrossoverKeys>& crossoverTable() {
    using C = CrossoverKeys;
    static const KeyTable<C> table =
        boundedTable<C>({{&C::crossover, "crossover", "[a, b]", "required",
                          "the two change places, within bounds", tupleOf(text(), 2)},
                         {&C::over, overKey(kOver, "along which")}});
    return table;
}

void readCrossover(const ClaimKeys& keys, const CrossoverKeys& given, ClaimSpec& claim) {
    keys.readList(given.crossover, claim);
    if (claim.operands.size() != 2) keys.refuse(given.crossover, "[a, b]");
    keys.readOver(given.over, claim);
    keys.readBounds(given, claim);
}

/// x where a − b changes its sign the first time, by interpolation of log(a/b) over log(x). Without
/// a change, +∞ where the two come nearer with x, else −∞. Not-a-number unless all are positive.
double crossing(const GroupPoint& group) {
    const std::vector<double>& a = group.operands[0];
    const std::vector<double>& b = group.operands[1];
    if (!arePositive(group.x) || !arePositive(a) || !arePositive(b)) return kNan;
    const std::vector<std::size_t> rows = rowsByX(group);
    const auto difference = [&](std::size_t i) {
        return std::log(ratioOf(a[rows[i]], b[rows[i]]));
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (std::isnan(difference(i))) return kNan;
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const double before = difference(i - 1);
        const double after = difference(i);
        if (before == 0.0) return group.x[rows[i - 1]];
        if (after != 0.0 && (before < 0.0) == (after < 0.0)) continue;
        return std::exp(std::lerp(std::log(group.x[rows[i - 1]]), std::log(group.x[rows[i]]),
                                  before / (before - after)));
    }
    const bool isNearer = std::abs(difference(rows.size() - 1)) < std::abs(difference(0));
    return isNearer ? kInfinity : -kInfinity;
}

/// Where both vary, lines that are one cross somewhere by chance: so one of them has to be surely
/// the larger in the first row, and the other one in the last.
Contrasts changesPlaces(Contrasts crossings) {
    return [crossings](const GroupPoint& group) {
        std::vector<Contrast> contrasts = crossings(group);
        const std::vector<std::size_t> rows = rowsByX(group);
        if (std::isnan(crossing(group))) return contrasts;
        const auto& a = group.operands[0];
        const auto& b = group.operands[1];
        const bool isFirst = a[rows.front()] > b[rows.front()];
        for (const bool isAtEnd : {false, true}) {
            const std::size_t row = isAtEnd ? rows.back() : rows.front();
            Requirement beyond;
            (isFirst != isAtEnd ? beyond.low : beyond.high) = 1.0;
            beyond.isLowExcluded = beyond.isHighExcluded = true;
            const GroupNumber ratio = [row](const GroupPoint& one) {
                return one.operands[0][row] / one.operands[1][row];
            };
            contrasts.push_back(
                {isAtEnd ? "ratio in the last row" : "ratio in the first row", ratio, beyond});
            contrasts.back().isBeside = true;
        }
        return contrasts;
    };
}

std::vector<ClaimPart> crossoverParts(const ClaimSpec& claim) {
    const std::string name =
        "crossing of " + joined(claim.operands, " and ") + " at " + claim.over.value_or("");
    ClaimPart part{{0, 1}, crossing, rangeOf(claim, name), "crossing at"};
    part.requirement.absence = "there is no crossing within the rows";
    part.needsX = true;
    part.minRows = 2;
    part.onTimes =
        changesPlaces(asItself(part.measuredName, crossing, part.requirement, Scale::Ranks));
    return {part};
}

}  // namespace

Kind crossover() {
    return {crossoverTable().section(), readBy<crossoverTable, readCrossover>, crossoverParts,
            Kind::Compares::Operands, Scale::Ranks};
}

}  // namespace gfxrepro::claims
