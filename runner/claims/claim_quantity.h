// Each type of claim as one number with a required range.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "engine/metrics/statistics.h"
#include "runner/claims/claims.h"
#include "runner/claims/operand.h"

namespace gfxrepro::claims {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a claim reads of a group of rows: each operand on each row, the abscissa, what is expected.
template <class Value>
struct GroupOf {
    std::vector<std::vector<Value>> operands;  // [operand][row]
    std::vector<Value> x;                      // [row]; empty without an abscissa
};
using Group = GroupOf<Sampled>;
using GroupPoint = GroupOf<double>;

/// The range that the quantity must lie in.
struct Requirement {
    double low = -kInfinity;
    double high = kInfinity;
    bool isLowExcluded = false;
    bool isHighExcluded = false;
    bool isInfinityAbsence = false;  // crossover alone: what is infinite is not there, and fails
    bool isOfCounts = false;         // exact alone: of what was counted, not of what it stands for
    std::string text;                // "exponent in [0.3, 1.2]"
    bool isPercent = false;          // shown ×100 with a percent sign
};

using Quantity = std::function<double(const GroupPoint&)>;

// A measured value may be +∞: the PSNR of equal pictures. It is larger than any other, equal to
// itself, and ∞ − ∞ or ∞ ÷ ∞ is not a number: a quantity that needs one is unmeasured.

/// order a < b < …: the smallest (right − left) / max(|right|, |left|) over neighbours and rows; ±1
/// where one of the two is infinite.
double smallestGap(const GroupPoint& group);
/// ratio a / b of the only row.
double firstRatio(const GroupPoint& group);
/// trend: least-squares slope of log(operand) over log(x). Not-a-number unless all are positive.
double exponent(const GroupPoint& group);
/// trend: with the rows sorted by x, the smallest step (towards `direction`), relative to the
/// larger of its ends.
double smallestStep(const GroupPoint& group, int direction);
/// independent: (max − min) / |median| over the rows.
double spread(const GroupPoint& group);
/// crossover: x where a − b changes its sign the first time, by interpolation of log(a/b) over
/// log(x). Without a change, +∞ where the two come nearer with x, else −∞. Not-a-number unless all
/// are positive.
double crossing(const GroupPoint& group);

/// exact: the largest |measured − expected| over the rows; operands are these two.
double largestDifference(const GroupPoint& group);
/// tolerance: the largest |measured − expected| / |expected|.
double largestDeviation(const GroupPoint& group);

/// same_mean: the smallest p of the rows × their number (Bonferroni), 1 at most.
double familyWiseP(const GroupPoint& group);

/// The rows in ascending x.
std::vector<std::size_t> rowsByX(const GroupPoint& group);
bool arePositive(const std::vector<double>& values);

/// The group in one round; and by its values alone.
GroupPoint pointOf(const Group& group, int round);
GroupPoint pointOf(const Group& group);
/// The rounds that all of its values have but those that are certain.
std::vector<int> roundsOf(const Group& group);

/// The verdict on one quantity of one group.
struct Judgement {
    Verdict verdict = Verdict::Unmeasured;
    std::string measured;
    double margin = 0.0;  // to the nearest bound, negative outside
    std::string marginText;
    bool isSingleSample = false;
    bool isAbsent = false;  // a crossing that is not there
    std::string why;        // of an ambiguous verdict on times; empty: the interval tells
};
/// What is inside of the range wholly holds, wholly outside fails, else is ambiguous.
Verdict verdictOf(const metrics::Interval& interval, const Requirement& requirement);

/// Of values that are no times, and the same in every run of the program: the quantity itself is
/// judged, of one sample too. Where it differs between rounds all the same (memory, the order of a
/// parallel sum), it is judged by what it was in them: their medianInterval, or the range of fewer.
/// Shares that were counted once are judged by the interval of the quantity over their draws.
/// Times are judged by judgeTimes() (claim_times.h).
Judgement judge(Group group, const Quantity& quantity, const Requirement& requirement);

/// "in [0.3, 1.2]", "≥ 10", "≤ 25 %".
std::string rangeText(const Requirement& requirement);
/// "2 [1.9, 2.1]" with an interval, "2 (1.9 … 2.1)" with a range.
std::string boundedText(double point, tables::Bounds bounds, const metrics::Interval& interval,
                        const Requirement& requirement);
/// "0.4123", "41.23 %".
std::string quantityText(double value, const Requirement& requirement);

}  // namespace gfxrepro::claims
