// A comparison for people and for other tools: Markdown, JUnit, JSON.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "runner/records/records.h"
#include "runner/regression/comparison.h"
#include "runner/report/markup.h"
#include "runner/report/writers.h"

namespace gfxrepro::regression {

namespace {

std::size_t countOf(const std::vector<Difference>& differences, SeriesVerdict verdict) {
    return static_cast<std::size_t>(std::ranges::count(differences, verdict, &Difference::verdict));
}

/// Whether both sides have a value.
bool isOfTwo(const Difference& difference) {
    return difference.verdict != SeriesVerdict::Missing &&
           difference.verdict != SeriesVerdict::Lost && !difference.isOfNone();
}

std::string ratioText(const Difference& difference) {
    if (!isOfTwo(difference) || difference.isPicture()) return "";
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", difference.ratio, difference.interval.low,
                       difference.interval.high);
}

std::string verdictText(const Difference& difference) {
    const std::string_view name = verdictName(difference.verdict);
    return difference.reason.empty() ? std::string(name)
                                     : fmt::format("{}: {}", name, difference.reason);
}

/// " ([before](…), [after](…), [difference](…))" of a picture whose files are kept.
std::string evidenceLinks(const Difference& difference) {
    if (difference.evidence.empty()) return "";
    std::string links;
    for (const auto& [label, ending] :
         {std::pair{"before", "-before.png"}, std::pair{"after", "-after.png"},
          std::pair{"difference", "-flip.png"}}) {
        if (!difference.picture && std::string_view(label) == "difference") continue;
        links += fmt::format("{}[{}]({}{})", links.empty() ? "" : ", ", label, difference.evidence,
                             ending);
    }
    return fmt::format(" ({})", links);
}

/// Empty on a side that has no number: it was lost, is new or void, or is how a case ended.
std::string valueText(const Difference& difference, bool isAfter) {
    const double value = isAfter ? difference.after : difference.before;
    const bool isAbsent =
        difference.verdict == (isAfter ? SeriesVerdict::Lost : SeriesVerdict::Missing);
    if (isAbsent || difference.key.metric == "status" || std::isnan(value)) return "";
    const std::string unit = isAfter ? ' ' + report::escapeMarkdown(difference.key.unit) : "";
    return fmt::format("{:.4g}{}", value, unit);
}

std::string markdownRow(const Difference& difference, const std::string& name) {
    const std::string title = report::escapeMarkdown(name);
    const std::string verdict =
        report::escapeMarkdown(verdictText(difference)) + evidenceLinks(difference);
    if (difference.isPicture() || difference.isOfNone()) {
        return fmt::format("| {} | | | | | {} |\n", title, verdict);
    }
    return fmt::format("| {} | {} | {} | {} | {:.2g} | {} |\n", title, valueText(difference, false),
                       valueText(difference, true), ratioText(difference), difference.floor,
                       verdict);
}

/// The names of tests: titles with the parameters that tell series apart, and their unit where
/// nothing else does.
std::vector<std::string> uniqueNames(const std::vector<const SeriesKey*>& keys) {
    std::vector<std::string> names = titlesOf(keys);
    std::map<std::string, int> counts;
    for (const std::string& name : names) ++counts[name];
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (counts[names[i]] > 1) names[i] += ' ' + keys[i]->unit;
    }
    return names;
}

}  // namespace

std::string summaryLine(const std::vector<Difference>& differences) {
    std::string text;
    for (const SeriesVerdict verdict :
         {SeriesVerdict::Lost, SeriesVerdict::Slower, SeriesVerdict::Faster, SeriesVerdict::Changed,
          SeriesVerdict::Same, SeriesVerdict::CannotTell, SeriesVerdict::Missing,
          SeriesVerdict::Void, SeriesVerdict::Failed}) {
        const std::size_t count = countOf(differences, verdict);
        if (count == 0) continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, verdictName(verdict));
    }
    return text.empty() ? "nothing to compare" : text;
}

std::string stepLine(const SeriesStep& found) {
    return fmt::format("step in {}: × {:.3f} since night {} of {} (chance {:.1g})",
                       found.key.title(), found.step.ratio, found.step.first + 1, found.nights,
                       found.step.chance);
}

bool Comparison::isAlarm() const {
    return std::ranges::any_of(differences, &Difference::isAlarm) ||
           std::ranges::any_of(steps, &SeriesStep::isAlarm);
}

std::string markdown(const Comparison& comparison) {
    const std::vector<Difference>& differences = comparison.differences;
    std::string text = fmt::format("# Comparison\n\n{}\n\n", summaryLine(differences));
    for (const std::string& note : comparison.notes) {
        text += fmt::format("Note: {}\n\n", report::escapeMarkdown(note));
    }
    for (const SeriesStep& step : comparison.steps) {
        text += fmt::format("{}\n\n", report::escapeMarkdown(stepLine(step)));
    }
    text += "| what | before | after | time after / before | floor | verdict |\n";
    text += "| --- | ---: | ---: | ---: | ---: | --- |\n";
    const std::vector<std::string> titles = titlesOf(keysOf(differences));
    for (std::size_t i = 0; i < differences.size(); ++i) {
        if (differences[i].verdict == SeriesVerdict::Same) continue;
        text += markdownRow(differences[i], titles[i]);
    }
    return text;
}

std::string junitXml(const Comparison& comparison) {
    using Outcome = report::JunitTest::Outcome;
    const std::vector<Difference>& differences = comparison.differences;
    report::JunitSuite suite{"regression", {}};
    std::vector<std::string> names = uniqueNames(keysOf(differences));
    for (std::size_t i = 0; i < differences.size(); ++i) {
        const Difference& one = differences[i];
        const bool isPass =
            one.verdict == SeriesVerdict::Same || one.verdict == SeriesVerdict::Faster;
        suite.tests.push_back({one.key.table, names[i],
                               isPass          ? Outcome::Passed
                               : one.isAlarm() ? Outcome::Failed
                                               : Outcome::Skipped,
                               std::string(verdictName(one.verdict)),
                               fmt::format("{} {}", verdictText(one), ratioText(one))});
    }
    names = uniqueNames(keysOf(comparison.steps));
    for (std::size_t i = 0; i < comparison.steps.size(); ++i) {
        const SeriesStep& step = comparison.steps[i];
        suite.tests.push_back({step.key.table, "history of " + names[i],
                               step.isAlarm() ? Outcome::Failed : Outcome::Passed, "step",
                               stepLine(step)});
    }
    return report::junitXml({suite}, comparison.started);
}

std::string smallerIsBetterJson(const std::vector<Difference>& differences) {
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    const std::vector<std::string> names = uniqueNames(keysOf(differences));
    for (std::size_t i = 0; i < differences.size(); ++i) {
        const Difference& difference = differences[i];
        if (!difference.key.isTime() || !(difference.after > 0.0)) continue;
        entries.push_back({{"name", names[i]},
                           {"unit", difference.key.unit},
                           {"value", difference.after},
                           {"range", fmt::format("× {}", ratioText(difference))},
                           {"extra", difference.key.params}});
    }
    return entries.empty() ? "" : entries.dump(2) + "\n";
}

}  // namespace gfxrepro::regression
