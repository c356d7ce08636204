// Claims about times: judged on rounds, in which all that is compared was measured alternately.
//
// A quantity is computed in each round of its own: what slows a whole round, an hour or a
// neighbour, falls out of a ratio of two times of that round. The interval is over rounds, by
// Wilcoxon's signed ranks (metrics::centreInterval) on the scale on which they scatter evenly: a
// ratio of two equally noisy times is as likely 1.1 as 1 / 1.1. It holds the truth in 95 % from
// six rounds on, which tests/unit/claims/coverage_test.cpp shows.
//
// Extreme values (the smallest of many gaps or steps, the spread) move with the number of rows and
// the noise; times are judged without them, each comparison by its own interval. That all must
// hold needs no correction for their number (intersection-union test: Berger 1982, "Multiparameter
// hypothesis testing and acceptance sampling", Technometrics 24). That one fails is the union of
// theirs: among k comparisons on their bounds, up to k times the 2.5 % of one end.
//
// Rounds that end by a relative error are no fixed number; FrameTimes::isKnownTo says by which rule
// their intervals hold the truth as often, too.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runner/claims/claim_quantity.h"

namespace gfxrepro::claims {

/// On which scale a quantity scatters evenly. Logarithmic where all of its values are positive,
/// else linear. Ranks: on none that is known; only the order of the rounds counts (medianInterval).
enum class Scale { Linear, Logarithmic, Ranks };

/// One comparison of times.
struct Contrast {
    std::string name;  // "exponent": before the measured value; may be empty
    Quantity quantity;
    Requirement requirement;
    Scale scale = Scale::Logarithmic;
    /// By which share times would have to differ for the quantity to reach its bound: what is
    /// compared with the noise of the table. Absent: as a quantity that is a ratio or a time.
    std::function<double(const GroupPoint&, double quantity)> distance = {};
    /// It can only fail: not to be told from its bound is as good as to hold.
    bool isRefutation = false;
};
/// The contrasts of a group with these values.
using Contrasts = std::function<std::vector<Contrast>(const GroupPoint&)>;

/// Whatever the quantity is: itself, on a scale.
Contrasts asItself(std::string name, Quantity quantity, Requirement requirement, Scale scale);
/// order a < b < …: the gap of each pair of neighbours.
Contrasts neighbourGaps(Requirement requirement);
/// trend, exponent: a distance of one in the exponent is a factor of x's range in the time.
Contrasts slope(Requirement requirement);
/// trend, direction: Kendall's rank correlation with x is above 0 towards `direction` (Kendall
/// 1938), and no step goes back by more than the noise of the table for certain.
Contrasts rising(int direction);
/// independent, within w: of each two rows the ratio lies in [1 / (1 + w), 1 + w] (equivalence by
/// the inclusion of the interval: Schuirmann 1987, the two one-sided tests procedure).
Contrasts allAlike(double within);

/// The worst of the contrasts. With fewer than metrics::kFewestForInterval rounds nothing is
/// decided; nor where times would have to differ by less than `noise`, the table's, for another
/// verdict.
Judgement judgeTimes(const Group& group, const Contrasts& contrasts, std::optional<double> noise);

}  // namespace gfxrepro::claims
