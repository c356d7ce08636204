// How cases failed and why times are void, said of what that left undecided.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "runner/records/records.h"
#include "runner/regression/comparison.h"

namespace gfxrepro::regression {

namespace {

/// Finds what is said of a case, also where one side's build knows parameters that the other does
/// not: cases are held against each other by the parameters that all of them know.
class Cases {
  public:
    Cases(const std::vector<Difference>& differences, const CaseTexts& before,
          const CaseTexts& after) {
        ParamNames ofDifferences, ofBefore, ofAfter;
        for (const Difference& one : differences) addParamNames(one.key, ofDifferences);
        for (const auto& [key, text] : before) addParamNames(key, ofBefore);
        for (const auto& [key, text] : after) addParamNames(key, ofAfter);
        for (const ParamNames* side : {&ofDifferences, &ofBefore, &ofAfter}) {
            for (const auto& one : *side) {
                const auto [found, isNew] = common_.insert(one);
                if (isNew) continue;
                std::erase_if(found->second,
                              [&](const std::string& name) { return !one.second.contains(name); });
            }
        }
    }

    SeriesKey of(SeriesKey key) const {
        key.params = reducedParams(key, common_);
        key.pass = key.unit = "";
        key.metric = "status";
        return key;
    }

    CaseTexts matched(const CaseTexts& texts) const {
        CaseTexts result;
        for (const auto& [key, text] : texts) result[of(key)] = text;
        return result;
    }

  private:
    ParamNames common_;
};

const std::string* textOf(const CaseTexts& texts, const SeriesKey& key) {
    const auto found = texts.find(key);
    return found == texts.end() ? nullptr : &found->second;
}

Difference failure(const SeriesKey& key, const std::string* before, const std::string& after) {
    const std::string_view flaky = records::statusName(records::Status::Flaky);
    const bool wasMeasured = !before || (before->starts_with(flaky) && !after.starts_with(flaky));
    Difference result{
        .key = key, .verdict = wasMeasured ? Verdict::Lost : Verdict::Failed, .reason = after};
    if (before && *before != after) {
        result.reason = fmt::format("before {}; after {}", *before, after);
    }
    return result;
}

}  // namespace

void noteFailures(std::vector<Difference>& differences, const CaseTexts& before,
                  const CaseTexts& after) {
    if (before.empty() && after.empty()) return;
    const Cases cases(differences, before, after);
    const CaseTexts earlier = cases.matched(before), later = cases.matched(after);
    std::set<SeriesKey> said;
    for (Difference& one : differences) {
        if (one.verdict != Verdict::Lost && one.verdict != Verdict::Missing) continue;
        const SeriesKey key = cases.of(one.key);
        const bool isLost = one.verdict == Verdict::Lost;
        const std::string* text = textOf(isLost ? later : earlier, key);
        if (!text) continue;
        one.reason = isLost ? *text : fmt::format("{}: {}", one.reason, *text);
        if (isLost) said.insert(key);
    }
    for (const auto& [key, text] : after) {
        const SeriesKey own = cases.of(key);
        if (!said.contains(own)) differences.push_back(failure(key, textOf(earlier, own), text));
    }
    std::ranges::sort(differences, {}, &Difference::key);
}

void noteVoidTimes(std::vector<Difference>& differences, const CaseTexts& before,
                   const CaseTexts& after) {
    if (before.empty() && after.empty()) return;
    const Cases cases(differences, before, after);
    const CaseTexts earlier = cases.matched(before), later = cases.matched(after);
    for (Difference& one : differences) {
        if (!one.key.isTime()) continue;
        const SeriesKey key = cases.of(one.key);
        const std::string* then = textOf(earlier, key);
        const std::string* now = textOf(later, key);
        const std::string* either = now ? now : then;
        if (!either) continue;
        if (one.verdict == Verdict::Void) {
            one.reason = *either;
        } else if (one.verdict == Verdict::Lost && now) {
            one.reason = fmt::format("its times are void: {}", *now);
        } else if (one.verdict == Verdict::Missing && then) {
            one.reason += fmt::format(": void before: {}", *then);
        } else if (one.verdict == Verdict::CannotTell) {
            one.reason += fmt::format(" (void in some rounds: {})", *either);
        }
    }
}

}  // namespace gfxrepro::regression
