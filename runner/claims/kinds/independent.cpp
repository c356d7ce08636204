// independent: does not depend on something.
#include <algorithm>
#include <cmath>

#include "engine/metrics/alike.h"
#include "engine/metrics/statistics.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

using namespace types;

constexpr NumberRange kSpreads{.least = 0};

struct IndependentKeys {
    GivenKey independent, of, atMost;
};
const KeyTable<IndependentKeys>& independentTable() {
    using I = IndependentKeys;
    static const KeyTable<I> table =
        kindTable<I>({{&I::independent, "independent", "a | [a, b]", "required",
                       "does not depend on something", oneOrMore(text())},
                      {&I::of, overKey("of", "on which")},
                      {&I::atMost, shareKey(kAtMost, kSpreads, "how far it may vary")}});
    return table;
}

void readIndependence(const ClaimKeys& keys, const IndependentKeys& given, ClaimSpec& claim) {
    keys.readList(given.independent, claim);
    keys.readOver(given.of, claim);
    claim.high = keys.readShare(given.atMost, kSpreads);
}

/// (max − min) / |median| over the rows.
double spread(const GroupPoint& group) {
    const std::vector<double>& values = group.operands[0];
    const auto [low, high] = std::ranges::minmax(values);
    if (metrics::areAlike(low, high)) return 0.0;
    return (high - low) / std::abs(metrics::summarize(values, metrics::Statistic::Median));
}

/// Of each two rows the ratio lies in [1 / (1 + w), 1 + w] (equivalence by the inclusion of the
/// interval: Schuirmann 1987, the two one-sided tests procedure).
Contrasts allAlike(double within) {
    return [within](const GroupPoint& group) {
        Requirement alike;
        alike.low = 1.0 / (1.0 + within);
        alike.high = 1.0 + within;
        const std::vector<double>& values = group.operands[0];
        std::vector<Contrast> contrasts;
        for (std::size_t i = 0; i < values.size(); ++i) {
            for (std::size_t j = i + 1; j < values.size(); ++j) {
                const bool isRising = values[i] <= values[j];
                const std::size_t low = isRising ? i : j, high = isRising ? j : i;
                const GroupNumber ratio = [low, high](const GroupPoint& one) {
                    return one.operands[0][high] / one.operands[0][low];
                };
                contrasts.push_back({"ratio of two rows", ratio, alike});
            }
        }
        return contrasts;
    };
}

std::vector<ClaimPart> independentParts(const ClaimSpec& claim) {
    std::vector<ClaimPart> parts;
    for (std::size_t i = 0; i < claim.operands.size(); ++i) {
        const std::string name = "spread of " + claim.operands[i];
        parts.push_back({{i}, spread, rangeOf(claim, name, true), "spread"});
        parts.back().minRows = 2;
        parts.back().onTimes = allAlike(claim.high.value_or(0.0));
    }
    return parts;
}

}  // namespace

Kind independent() {
    return {independentTable().section(), readBy<independentTable, readIndependence>,
            independentParts, Kind::Compares::Rows};
}

}  // namespace gfxrepro::claims
