// The claims of a run: judged, and how many have which verdict, in a line.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "engine/core/text.h"
#include "runner/claims/claims.h"

namespace gfxrepro::claims {

using ClaimSpec = config::ClaimSpec;

std::string claimSummaryLine(const std::vector<ClaimResult>& results) {
    if (results.empty()) return "no claims";
    std::map<Verdict, int> counts;
    for (const ClaimResult& result : results) ++counts[result.verdict];
    std::vector<std::string> parts;
    for (const auto& [verdict, count] : counts) {
        std::string word(verdictName(verdict));
        if (verdict == Verdict::Holds && count != 1) word = "hold";
        if (verdict == Verdict::Fails && count != 1) word = "fail";
        parts.push_back(std::to_string(count) + " " + word);
    }
    return joined(parts);
}

std::string originSummaryLine(const std::vector<ClaimResult>& results) {
    using Origin = ClaimSpec::Origin;
    static constexpr std::pair<Origin, const char*> kGroups[] = {
        {Origin::Document, "of the documents' own claims"},
        {Origin::Derived, "read off their numbers"},
        {Origin::Ours, "our aims"},
        {Origin::Definition, "definitions"},
        {Origin::Calibrated, "calibrated inputs"}};
    std::vector<std::string> parts;
    for (const auto& [origin, name] : kGroups) {
        std::vector<ClaimResult> alike;
        std::ranges::copy_if(
            results, std::back_inserter(alike),
            [origin = origin](const ClaimResult& result) { return result.origin == origin; });
        if (!alike.empty()) parts.push_back(fmt::format("{} {}", name, claimSummaryLine(alike)));
    }
    return parts.empty() ? claimSummaryLine(results) : joined(parts, "; ");
}

std::vector<ClaimResult> evaluateClaims(const std::vector<config::Experiment>& experiments,
                                        const std::vector<tables::Table>& tables,
                                        const ReportContext& context) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::vector<ClaimResult> results;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        for (ClaimResult& result : evaluateClaims(experiments[i], tables[i], context)) {
            results.push_back(std::move(result));
        }
    }
    return results;
}

}  // namespace gfxrepro::claims
