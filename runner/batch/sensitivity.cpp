#include "runner/batch/sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "runner/core/text.h"
#include "runner/report/csv.h"
#include "runner/report/markup.h"

namespace gfxrepro::batch {

namespace {

using Json = nlohmann::ordered_json;
using report::ClaimResult;
using report::Verdict;

std::string textOf(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return report::shortestText(value.get<double>());
    return value.dump();
}

/// `points` values of [low, high].
std::vector<double> pointsOf(double low, double high, int points, bool isInteger) {
    constexpr double kWideFactor = 10.0;
    const bool isByRatio = low > 0.0 && high / low > kWideFactor;
    std::vector<double> values;
    for (int i = 0; i < points; ++i) {
        const double t = points == 1 ? 0.0 : i / (points - 1.0);
        double value = isByRatio ? low * std::pow(high / low, t) : low + (high - low) * t;
        if (isInteger) value = std::round(value);
        if (values.empty() || value != values.back()) values.push_back(value);
    }
    return values;
}

/// What `--set` calls it; nothing for a name that is neither a parameter nor `output`.
std::vector<std::string> keysOf(const std::string& name, const Case& item) {
    if (name == "output") return {"output.width", "output.height"};
    if (item.params.find(name)) return {"params." + name};
    return {};
}

Json currentValue(const std::string& name, const Case& item) {
    if (name == "output") return item.outputWidthPx;
    return item.params.find(name)->toJson();
}

/// Why the assumption is not varied; empty if it is.
std::string whyFixed(const config::Assumption& assumption, const Case& item) {
    if (keysOf(assumption.name, item).empty()) return "no parameter of the technique";
    for (const std::string& axis : {assumption.name, assumption.name + ".width"}) {
        if (item.axes.find(axis)) return "an axis of the table: it is varied there";
    }
    const Json range = assumption.range.toJson();
    if (!range.is_array() || range.size() < 2) return "its range is no list";
    return "";
}

std::vector<Variation> variationsOf(const config::Assumption& assumption, const Case& item,
                                    int points) {
    const Json range = assumption.range.toJson();
    const Json current = currentValue(assumption.name, item);
    std::vector<Json> values(range.begin(), range.end());
    if (range.size() == 2 && range[0].is_number() && range[1].is_number()) {
        values.clear();
        for (const double value : pointsOf(range[0].get<double>(), range[1].get<double>(), points,
                                           current.is_number_integer())) {
            values.emplace_back(value);
        }
    }
    std::vector<Variation> variations;
    for (const Json& value : values) {
        Variation variation{assumption.name, textOf(value), std::nullopt, {}};
        if (variation.value == textOf(current)) continue;
        if (value.is_number()) variation.number = value.get<double>();
        for (const std::string& key : keysOf(assumption.name, item)) {
            variation.sets.push_back(key + "=" + variation.value);
        }
        variations.push_back(std::move(variation));
    }
    return variations;
}

/// "8.7 %" is 8.7.
std::optional<double> numberIn(const std::string& text) {
    return parseDouble(text.substr(0, text.find(' ')));
}

/// Where the margin of a claim passes 0 between two values; nothing where the margins do not tell.
std::optional<double> flipBetween(const Outcome& a, const Outcome& b, std::size_t claim) {
    const std::optional<double> first = numberIn(a.claims[claim].margin);
    const std::optional<double> second = numberIn(b.claims[claim].margin);
    if (!first || !second || (*first < 0.0) == (*second < 0.0)) return std::nullopt;
    const double t = *first / (*first - *second);
    return *a.variation.number + t * (*b.variation.number - *a.variation.number);
}

bool holds(const Outcome& outcome, std::size_t claim) {
    return outcome.claims[claim].verdict == Verdict::Holds;
}

/// "bias is 0.03 or 0.1 (flips between 0.003 and 0.03, near 0.012)": the values under which the
/// claim holds, or those under which it does not.
std::string condition(const std::string& assumption, std::vector<const Outcome*> outcomes,
                      std::size_t claim, bool whereItHolds) {
    std::vector<std::string> values;
    std::string flips;
    for (const Outcome* outcome : outcomes) {
        if (holds(*outcome, claim) == whereItHolds) values.push_back(outcome->variation.value);
    }
    std::erase_if(outcomes, [](const Outcome* outcome) { return !outcome->variation.number; });
    std::ranges::sort(outcomes, {},
                      [](const Outcome* outcome) { return *outcome->variation.number; });
    for (std::size_t i = 1; i < outcomes.size(); ++i) {
        const Outcome &a = *outcomes[i - 1], &b = *outcomes[i];
        if (holds(a, claim) == holds(b, claim)) continue;
        flips += fmt::format("{} between {} and {}", flips.empty() ? "flips" : ",",
                             a.variation.value, b.variation.value);
        if (const auto at = flipBetween(a, b, claim)) flips += fmt::format(", near {:.3g}", *at);
    }
    return fmt::format("{} is {}{}", assumption, joined(values, " or "),
                       flips.empty() ? "" : " (" + flips + ")");
}

}  // namespace

std::string Variation::title() const {
    return assumption.empty() ? "as configured" : assumption + " = " + value;
}

Variations variationsOf(const config::Experiment& experiment, const std::vector<Case>& cases,
                        int points) {
    Variations result;
    result.runs.push_back({});
    for (const config::Assumption& assumption : experiment.assumptions) {
        const std::string why =
            cases.empty() ? "the table has no cases" : whyFixed(assumption, cases.front());
        if (!why.empty()) {
            result.fixed.emplace_back(assumption.name, why);
            continue;
        }
        for (Variation& variation : variationsOf(assumption, cases.front(), points)) {
            result.runs.push_back(std::move(variation));
        }
    }
    return result;
}

std::string dependence(const std::vector<Outcome>& outcomes, std::size_t claim) {
    const auto holding =
        std::ranges::count_if(outcomes, [&](const Outcome& o) { return holds(o, claim); });
    if (static_cast<std::size_t>(holding) == outcomes.size()) {
        return fmt::format("holds under all {}", outcomes.size());
    }
    if (holding == 0) return fmt::format("holds under none of {}", outcomes.size());
    std::vector<std::string> order;
    std::map<std::string, std::vector<const Outcome*>> byAssumption;
    for (const Outcome& outcome : outcomes) {
        const std::string& name = outcome.variation.assumption;
        if (name.empty()) continue;
        if (!byAssumption.contains(name)) order.push_back(name);
        byAssumption[name].push_back(&outcome);
    }
    const bool holdsAsConfigured = holds(outcomes.front(), claim);
    std::vector<std::string> conditions;
    for (const std::string& name : order) {
        const bool decides = std::ranges::any_of(byAssumption[name], [&](const Outcome* o) {
            return holds(*o, claim) != holdsAsConfigured;
        });
        if (decides) {
            conditions.push_back(condition(name, byAssumption[name], claim, !holdsAsConfigured));
        }
    }
    return fmt::format("holds {} {}", holdsAsConfigured ? "unless" : "only if",
                       joined(conditions, ", or "));
}

std::string sensitivityMarkdown(const config::Experiment& experiment,
                                const std::vector<Outcome>& outcomes,
                                const Variations& variations) {
    using report::escapeMarkdown;
    const std::vector<ClaimResult>& claims = outcomes.front().claims;
    std::string text = fmt::format(
        "# Sensitivity of {}\n\n{}\n\nEach assumption alone takes the values of its range; {} "
        "runs.\n\n| claim | says | as configured | under the assumptions |\n| --- | --- | --- | "
        "--- "
        "|\n",
        escapeMarkdown(experiment.id), escapeMarkdown(experiment.title), outcomes.size());
    for (std::size_t i = 0; i < claims.size(); ++i) {
        text += fmt::format("| {} | {} | {} | {} |\n", escapeMarkdown(claims[i].id),
                            escapeMarkdown(claims[i].text), report::verdictName(claims[i].verdict),
                            escapeMarkdown(dependence(outcomes, i)));
    }
    text += "\n| run |";
    for (const ClaimResult& claim : claims) text += fmt::format(" {} |", escapeMarkdown(claim.id));
    text += "\n| --- |";
    for (std::size_t i = 0; i < claims.size(); ++i) text += " --- |";
    text += '\n';
    for (const Outcome& outcome : outcomes) {
        text += fmt::format("| {} |", escapeMarkdown(outcome.variation.title()));
        for (const ClaimResult& claim : outcome.claims) {
            text += fmt::format(" {}: {} |", report::verdictName(claim.verdict),
                                escapeMarkdown(claim.measured));
        }
        text += '\n';
    }
    if (variations.fixed.empty()) return text;
    text += "\nNot varied:\n";
    for (const auto& [name, why] : variations.fixed) {
        text += fmt::format("- {}: {}\n", escapeMarkdown(name), why);
    }
    return text;
}

std::string sensitivityCsv(const std::vector<Outcome>& outcomes) {
    std::string text = "assumption,value,claim,verdict,measured,required,margin\n";
    for (const Outcome& outcome : outcomes) {
        for (const ClaimResult& claim : outcome.claims) {
            report::CsvRow row(text);
            row.text(outcome.variation.assumption).text(outcome.variation.value).text(claim.id);
            row.text(report::verdictName(claim.verdict)).text(claim.measured);
            row.text(claim.required).text(claim.margin);
            row.end();
        }
    }
    return text;
}

}  // namespace gfxrepro::batch
