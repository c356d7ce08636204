#include "runner/regression/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runner/report/markup.h"

namespace gfxrepro::regression {

namespace {

std::size_t countOf(const std::vector<Difference>& differences, Verdict verdict) {
    return static_cast<std::size_t>(std::ranges::count(differences, verdict, &Difference::verdict));
}

std::string ratioText(const Difference& difference) {
    if (difference.verdict == Verdict::Missing || difference.verdict == Verdict::Lost) return "";
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", difference.ratio, difference.interval.low,
                       difference.interval.high);
}

std::string verdictText(const Difference& difference) {
    const std::string_view name = verdictName(difference.verdict);
    return difference.reason.empty() ? std::string(name)
                                     : fmt::format("{}: {}", name, difference.reason);
}

}  // namespace

std::string summaryLine(const std::vector<Difference>& differences) {
    std::string text;
    for (const Verdict verdict : {Verdict::Lost, Verdict::Slower, Verdict::Faster, Verdict::Changed,
                                  Verdict::Same, Verdict::CannotTell, Verdict::Missing}) {
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
    for (const Difference& difference : differences) {
        if (difference.verdict == Verdict::Same) continue;
        text += fmt::format("| {} | {:.4g} | {:.4g} {} | {} | {:.2g} | {} |\n",
                            report::escapeMarkdown(difference.key.title()), difference.before,
                            difference.after, difference.key.unit, ratioText(difference),
                            difference.floor, verdictText(difference));
    }
    return text;
}

std::string junitXml(const Comparison& comparison) {
    const std::vector<Difference>& differences = comparison.differences;
    const auto failures = std::ranges::count_if(differences, &Difference::isAlarm) +
                          std::ranges::count_if(comparison.steps, &SeriesStep::isAlarm);
    const std::size_t skipped =
        countOf(differences, Verdict::CannotTell) + countOf(differences, Verdict::Missing);
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"regression\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n",
        differences.size() + comparison.steps.size(), failures, skipped);
    for (const Difference& difference : differences) {
        text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"",
                            report::escapeXml(difference.key.table),
                            report::escapeXml(difference.key.title()));
        const bool isPass =
            difference.verdict == Verdict::Same || difference.verdict == Verdict::Faster;
        if (isPass) {
            text += "/>\n";
            continue;
        }
        text += fmt::format("><{} message=\"{}\"/></testcase>\n",
                            difference.isAlarm() ? "failure" : "skipped",
                            report::escapeXml(fmt::format("{} {}", verdictText(difference),
                                                          ratioText(difference))));
    }
    for (const SeriesStep& step : comparison.steps) {
        text += fmt::format("  <testcase classname=\"{}\" name=\"history of {}\"",
                            report::escapeXml(step.key.table), report::escapeXml(step.key.title()));
        text += step.isAlarm() ? fmt::format("><failure message=\"{}\"/></testcase>\n",
                                             report::escapeXml(stepLine(step)))
                               : "/>\n";
    }
    return text + "</testsuite>\n";
}

std::string smallerIsBetterJson(const std::vector<Difference>& differences) {
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (const Difference& difference : differences) {
        if (!difference.key.isTime() || difference.after <= 0.0) continue;
        entries.push_back(
            {{"name", fmt::format("{} {}", difference.key.title(), difference.key.params)},
             {"unit", difference.key.unit},
             {"value", difference.after},
             {"range", fmt::format("× {}", ratioText(difference))}});
    }
    return entries.dump(2) + "\n";
}

}  // namespace gfxrepro::regression
