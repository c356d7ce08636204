// same_mean: noisy pictures have the expectation of their truth.
#include <fmt/format.h>

#include <algorithm>

#include "engine/metrics/mean_test.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

/// More would call a coin a test.
constexpr NumberRange kRates{.least = 0, .most = 0.1, .isLeastExcluded = true};

struct SameMeanKeys {
    GivenKey sameMean, falseAlarms;
};
const KeyTable<SameMeanKeys>& sameMeanTable() {
    using S = SameMeanKeys;
    static const KeyTable<S> table = kindTable<S>(
        {{&S::sameMean, "same_mean", "a", "required",
          fmt::format(
              "noisy pictures have the expectation of their truth; a column of the metric {}",
              metrics::kSameMeanP),
          types::text()},
         {&S::falseAlarms,
          shareKey("false_alarms", kRates,
                   "how often it may fail where it holds, over all rows together")}});
    return table;
}

/// The rate of false alarms is the least p that holds.
void readSameMean(const ClaimKeys& keys, const SameMeanKeys& given, ClaimSpec& claim) {
    keys.readOne(given.sameMean, claim);
    claim.low = keys.readShare(given.falseAlarms, kRates);
}

/// The smallest p of the rows × their number (Bonferroni), 1 at most.
double familyWiseP(const GroupPoint& group) {
    const std::vector<double>& p = group.operands[0];
    return std::min(1.0, static_cast<double>(p.size()) * std::ranges::min(p));
}

std::vector<ClaimPart> sameMeanParts(const ClaimSpec& claim) {
    ClaimPart part{{0}, familyWiseP, {}, "p of all rows"};
    part.isOfSeeds = true;
    part.requirement.low = *claim.low;
    part.requirement.text = fmt::format("the same expectation ({}: p of all rows ≥ {:.4g})",
                                        claim.operands[0], *claim.low);
    return {part};
}

/// Pictures that are too few for as few false alarms.
std::string refusedSameMean(const ClaimSpec& claim, const Sampling& sampling) {
    if (!sampling.truthFrames) return "";  // a technique that records it knows its samples
    const int frames = sampling.frames, truths = *sampling.truthFrames;
    if (truths == 0) {
        return "is 'same_mean' and needs an image whose truth has several 'frames': {frame: 1000, "
               "frames: 6}";
    }
    if (frames < 2) return "is 'same_mean' and needs 'output.frames', a seed each: 2 or more";
    const auto rows = static_cast<double>(sampling.rows);
    const double least =
        rows * metrics::leastP(static_cast<std::size_t>(frames), static_cast<std::size_t>(truths));
    if (least <= *claim.low) return "";
    return fmt::format(
        "asks for {:.3g} % of false alarms over {} row{}, and could not fail: {} frames and {} of "
        "the truth come to no p below {:.2g} %; take more ('output.frames', 'truth: {{frames}}')",
        100.0 * *claim.low, rows, rows == 1.0 ? "" : "s", frames, truths, 100.0 * least);
}

std::string_view hintOnTests(std::string_view column) {
    const bool isTest = column == metrics::kSameMeanP || column == metrics::kBiasSeen;
    return isTest ? "; it is of an image whose truth has several 'frames'" : "";
}

}  // namespace

Kind sameMean() {
    Kind kind{sameMeanTable().section(), readBy<sameMeanTable, readSameMean>, sameMeanParts};
    kind.isOfAllRows = true;
    kind.metric = metrics::kSameMeanP;
    kind.hintOn = hintOnTests;
    kind.refused = refusedSameMean;
    return kind;
}

}  // namespace gfxrepro::claims
