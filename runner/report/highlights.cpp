// Which pictures stand for a document on the first screen.
#include <algorithm>
#include <functional>

#include "runner/report/pages.h"

namespace gfxrepro::report {

using claims::ClaimResult;
using claims::Verdict;

namespace {

/// The judged ones; the document's own come first, and of these those that fail.
std::vector<const ClaimResult*> tellingClaims(const std::vector<ClaimResult>& claims) {
    const auto rank = [](const ClaimResult* claim) {
        return (claim->isCounted() ? 2 : 0) + (claim->verdict == Verdict::Fails ? 1 : 0);
    };
    std::vector<const ClaimResult*> telling;
    for (const ClaimResult& claim : claims) {
        const bool isJudged = claim.verdict == Verdict::Fails || claim.verdict == Verdict::Holds;
        // A sentence that goes on from the one before says nothing alone.
        if (isJudged && !claim.text.starts_with("…")) telling.push_back(&claim);
    }
    std::ranges::stable_sort(telling, std::greater<>(), rank);
    return telling;
}

/// The pictures that the page shows first; the one that tells most of such a claim before others.
std::vector<const Shot*> tellingShots(const RunPart& part, bool isFailing) {
    std::vector<const Shot*> shots;
    for (const std::size_t i : mainShots(part.shots, part.experiment->shows)) {
        if (!part.shots[i].isTruth()) shots.push_back(&part.shots[i]);
    }
    std::ranges::stable_sort(shots, [&](const Shot* a, const Shot* b) {
        if (a->flip.empty() != b->flip.empty()) return b->flip.empty();
        if (!a->flip.empty()) {
            return isFailing ? a->flipMean > b->flipMean : a->flipMean < b->flipMean;
        }
        return a->bytes > b->bytes;
    });
    return shots;
}

/// `count` of them, evenly over the list.
std::vector<Highlight> spread(const std::vector<Highlight>& all, std::size_t count) {
    if (all.size() <= count) return all;
    std::vector<Highlight> chosen;
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
    return chosen;
}

/// Moves to `chosen` the first of `left` whose picture is least like those of its page there.
void takeLeastAlike(const ShotDifference& difference, std::vector<Highlight>& left,
                    std::vector<Highlight>& chosen) {
    const auto isNew = [&](const Highlight& one) {
        double least = 1.0;
        for (const Highlight& other : chosen) {
            if (other.page != one.page) continue;
            least = std::min(least, difference(one.run, *one.shot, *other.shot));
        }
        return least;
    };
    const auto best = std::ranges::max_element(left, {}, isNew);
    chosen.push_back(*best);
    left.erase(best);
}

}  // namespace

std::vector<Highlight> highlightsOf(const std::vector<const Page*>& pages,
                                    const ShotDifference& difference) {
    std::vector<Highlight> failing, holding;
    std::vector<std::vector<Highlight>> further;  // of each page, of its next claims
    for (const Page* page : pages) {
        for (std::size_t run = 0; run < page->parts.size(); ++run) {
            const RunPart& part = page->parts[run];
            const std::vector<const ClaimResult*> claims = tellingClaims(part.claims);
            if (claims.empty() || !part.experiment || part.shots.empty()) continue;
            const bool isFailing = claims[0]->verdict == Verdict::Fails;
            const std::vector<const Shot*> shots = tellingShots(part, isFailing);
            if (shots.empty()) continue;
            (isFailing ? failing : holding).push_back({page, run, shots[0], claims[0]});
            std::vector<Highlight>& others = further.emplace_back();
            for (std::size_t i = 1; i < std::min(claims.size(), shots.size()); ++i) {
                others.push_back({page, run, shots[i], claims[i]});
            }
            break;
        }
    }
    const std::size_t fewest = std::min(holding.size(), kHighlights / 2);
    const std::vector<Highlight> bad = spread(failing, kHighlights - fewest);
    std::vector<Highlight> chosen = spread(holding, kHighlights - bad.size());
    chosen.insert(chosen.end(), bad.begin(), bad.end());
    const bool areAllShown = chosen.size() == failing.size() + holding.size();
    std::vector<Highlight> left;
    for (std::size_t i = 0; areAllShown && i < kHighlights; ++i) {
        for (const std::vector<Highlight>& others : further) {
            if (i < others.size()) left.push_back(others[i]);
        }
    }
    const std::size_t missing = std::min(left.size(), kHighlights - chosen.size());
    for (std::size_t i = 0; i < missing; ++i) takeLeastAlike(difference, left, chosen);
    std::ranges::stable_sort(chosen, {}, [&](const Highlight& one) {
        return std::ranges::find(pages, one.page) - pages.begin();
    });
    return chosen;
}

}  // namespace gfxrepro::report
