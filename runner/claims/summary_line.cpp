// What many claims came to, in a line.
#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <map>

#include "engine/core/text.h"
#include "runner/claims/claims.h"

namespace gfxrepro::claims {

using Origin = ClaimSpec::Origin;

std::string claimSummaryLine(const std::vector<ClaimResult>& results) {
    if (results.empty()) return "no claims";
    std::map<Verdict, int> counts, inPart;
    for (const ClaimResult& result : results) {
        ++counts[result.verdict];
        inPart[result.verdict] += result.holdsOn.empty() ? 0 : 1;
    }
    std::vector<std::string> parts;
    for (const auto& [verdict, count] : counts) {
        std::string word(verdictName(verdict));
        if (verdict == Verdict::Holds && count != 1) word = "hold";
        if (verdict == Verdict::Fails && count != 1) word = "fail";
        if (inPart[verdict] > 0)
            word += fmt::format(" ({} hold{} on some scenes)", inPart[verdict],
                                inPart[verdict] == 1 ? "s" : "");
        parts.push_back(std::to_string(count) + " " + word);
    }
    return joined(parts);
}

std::string originSummaryLine(const std::vector<ClaimResult>& results) {
    struct CountedGroup {
        Origin origin;
        bool isCounted;
        const char* name;
    };
    static constexpr CountedGroup kGroups[] = {
        {Origin::Document, true, "of the documents' own claims"},
        {Origin::Document, false, "of these on part of their rows, or said twice"},
        {Origin::Existence, false, "that can hardly fail"},
        {Origin::Derived, false, "read off their numbers"},
        {Origin::Ours, false, "our aims"},
        {Origin::Definition, false, "definitions"},
        {Origin::Calibrated, false, "calibrated inputs"}};
    std::vector<std::string> parts;
    for (const CountedGroup& group : kGroups) {
        std::vector<ClaimResult> alike;
        std::ranges::copy_if(results, std::back_inserter(alike), [&](const ClaimResult& result) {
            return result.origin == group.origin && result.isCounted() == group.isCounted;
        });
        if (alike.empty()) continue;
        parts.push_back(fmt::format("{} {}", group.name, claimSummaryLine(alike)));
    }
    return parts.empty() ? claimSummaryLine(results) : joined(parts, "; ");
}

}  // namespace gfxrepro::claims
