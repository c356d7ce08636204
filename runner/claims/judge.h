// The verdict on the quantity of a group of rows: of times, and of everything else.
//
// Times are judged on rounds, in which all that is compared was measured alternately. A quantity
// is computed in each round of its own: what slows a whole round, an hour or a
// neighbour, falls out of a ratio of two times of that round. Judged is what a column of the
// quantity shows: its median over rounds, by the same interval (metrics::medianInterval). It holds
// the truth in 95 % from six rounds on whatever the distribution, which
// tests/unit/claims/coverage_test.cpp shows. Wilcoxon's signed ranks would need a third fewer
// rounds, but hold another number where rounds scatter more to one side.
//
// Extreme values (the smallest of many gaps or steps, the spread) move with the number of rows and
// the noise; times are judged without them, each comparison by its own interval. That all must
// hold needs no correction for their number (intersection-union test: Berger 1982, "Multiparameter
// hypothesis testing and acceptance sampling", Technometrics 24). That one fails is the union of
// theirs: among k comparisons on their bounds up to k times the 2.5 % of one end. So one fails only
// where it is sure by itself and among all of its claim that are not surely within their bounds
// (metrics::jointChances, forgiveChance()): together they fail by chance in 2.5 %. That takes
// rounds to scatter evenly about a bound at which many rows lie, as those of equal things do.
//
// Random numbers whose seed is another in each round are judged likewise, and nothing is decided of
// those of one seed: however many processes drew them, they are one sample.
//
// Rounds that end by a relative error are no fixed number; FrameTimes::isKnownTo says by which rule
// their intervals hold the truth as often, too.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/metrics/statistics.h"
#include "runner/claims/claims.h"
#include "runner/claims/kinds/kind.h"
#include "runner/tables/expression.h"

namespace gfxrepro::claims {

using tables::Sampled;

using Group = GroupOf<Sampled>;
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
    bool isAbsent = false;  // not there (Requirement::absence)
    bool isBeside = false;  // of a contrast that is told only where it is worse
    std::string why;        // of an ambiguous verdict on times; empty: the interval tells
    /// Of what has an interval that is not wholly within the range: how far beyond the nearer bound
    /// each round lies; of draws, the share of them that lies within.
    std::map<int, double> beyond = {};
    std::optional<double> drawsWithin = {};
};
/// What is inside of the range wholly holds, wholly outside fails, else is ambiguous.
Verdict verdictOf(const metrics::Interval& interval, const Requirement& requirement);

/// Of values that are no times, and the same in every run of the program: the quantity itself is
/// judged, of one sample too. Where it differs between rounds all the same (memory, the order of a
/// parallel sum), it is judged by what it was in them: their medianInterval, or the range of fewer.
/// Shares that were counted once are judged by the interval of the quantity over their draws.
Judgement judge(Group group, const GroupNumber& quantity, const Requirement& requirement);

/// Whether another seed would give the group other values.
bool isRandom(const Group& group);
/// Whether one of its values is taken over processes (tables::Summary::isOverProcesses).
bool isOverProcesses(const Group& group);
/// Why a group has no interval however many rounds there are: what is taken over processes, too few
/// seeds of random numbers; empty where it has one.
std::string whyNoInterval(const Group& group);

/// Of times, and of random numbers: each of the contrasts. With fewer than
/// metrics::kFewestForInterval rounds nothing is decided; nor where times would have to differ by
/// less than `noise`, that of what is read, for another verdict.
std::vector<Judgement> judgeVarying(const Group& group, const Contrasts& contrasts,
                                    std::optional<double> noise);

/// What fails by no more than the farthest of so many would by chance is ambiguous: `all` are those
/// of a claim, of which one that fails is enough.
void forgiveChance(std::span<Judgement* const> all);

/// The worst of the judgements, the first of the contrasts where they are alike.
Judgement worstOf(std::vector<Judgement> judgements);

}  // namespace gfxrepro::claims
