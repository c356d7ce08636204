#include "runner/report/highlights.h"

#include <algorithm>

#include "runner/report/picture_grid.h"

namespace gfxrepro::report {

using claims::ClaimResult;
using claims::Verdict;

namespace {

/// The document's own claims come first, and of these one that fails.
const ClaimResult* tellingClaim(const std::vector<ClaimResult>& claims) {
    const ClaimResult* best = nullptr;
    const auto rank = [](const ClaimResult& claim) {
        const int verdict = claim.verdict == Verdict::Fails   ? 2
                            : claim.verdict == Verdict::Holds ? 1
                                                              : 0;
        return verdict == 0 ? 0 : verdict + (claim.isOfDocument() ? 2 : 0);
    };
    for (const ClaimResult& claim : claims) {
        if (rank(claim) > (best ? rank(*best) : 0)) best = &claim;
    }
    return best;
}

const Shot* tellingShot(const RunPart& part, bool isFailing) {
    const Shot* best = nullptr;
    const auto isBetter = [&](const Shot& shot, const Shot& known) {
        if (shot.flip.empty() != known.flip.empty()) return known.flip.empty();
        if (!shot.flip.empty()) {
            return isFailing ? shot.flipMean > known.flipMean : shot.flipMean < known.flipMean;
        }
        return shot.bytes > known.bytes;
    };
    const std::vector<std::string>& shows = part.experiment->shows;
    for (const std::size_t i : mainShots(part.shots, shows)) {
        const Shot& shot = part.shots[i];
        if (shot.isTruth()) continue;
        if (!best || isBetter(shot, *best)) best = &shot;
    }
    return best;
}

/// `count` of them, evenly over the list.
std::vector<Highlight> spread(const std::vector<Highlight>& all, std::size_t count) {
    if (all.size() <= count) return all;
    std::vector<Highlight> chosen;
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
    return chosen;
}

}  // namespace

std::vector<Highlight> highlightsOf(const std::vector<const Page*>& pages) {
    std::vector<Highlight> failing, holding;
    for (const Page* page : pages) {
        for (std::size_t run = 0; run < page->parts.size(); ++run) {
            const RunPart& part = page->parts[run];
            const ClaimResult* claim = tellingClaim(part.claims);
            if (!claim || !part.experiment || part.shots.empty()) continue;
            const bool isFailing = claim->verdict == Verdict::Fails;
            const Shot* shot = tellingShot(part, isFailing);
            if (!shot) continue;
            (isFailing ? failing : holding).push_back({page, run, shot, claim});
            break;
        }
    }
    const std::size_t fewest = std::min(holding.size(), kHighlights / 2);
    const std::vector<Highlight> bad = spread(failing, kHighlights - fewest);
    std::vector<Highlight> chosen = spread(holding, kHighlights - bad.size());
    chosen.insert(chosen.end(), bad.begin(), bad.end());
    std::ranges::stable_sort(chosen, {}, [&](const Highlight& one) {
        return std::ranges::find(pages, one.page) - pages.begin();
    });
    return chosen;
}

}  // namespace gfxrepro::report
