#include "runner/studies/sensitivity.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/records/csv.h"
#include "runner/report/markup.h"
#include "runner/run/ledger.h"
#include "runner/run/plan_json.h"

namespace gfxrepro::studies {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;
using claims::ClaimResult;
using claims::Verdict;

std::string textOf(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) {
        // 100000, not 1e+05, which is no integer to a config.
        const auto number = value.get<double>();
        const bool isWhole = number == std::round(number) && std::abs(number) < 1e15;
        return isWhole ? fmt::format("{:.0f}", number) : records::shortestText(number);
    }
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

/// Each generated scene of the cases at another seed.
std::string seedSet(const std::string& seed, const std::vector<config::Case>& cases,
                    const scene::Catalog& catalog) {
    std::vector<std::string> seeded;
    for (const std::string& name : run::sceneNames(cases)) {
        const Node scene = Node::scalar(name);
        if (!catalog.resolve(scene).isSeeded()) continue;
        const std::string other = scene::withSeed(scene, std::stoull(seed)).text();
        seeded.push_back(fmt::format("{}: {}", name, other));
    }
    return fmt::format("{}={{{}}}", config::kSceneInstead, joined(seeded));
}

std::vector<std::string> setsOf(const std::string& name, const std::string& value,
                                const std::vector<config::Case>& cases,
                                const scene::Catalog& catalog) {
    if (name == config::kOutputAssumption)
        return {"output.width=" + value, "output.height=" + value};
    if (name == config::kSceneSeedAssumption) return {seedSet(value, cases, catalog)};
    if (name == config::kFramesAssumption) return {name + "=" + value};
    return {fmt::format("{}.{}={}", config::kParamsInstead, name, value)};
}

/// Why the assumption is not varied; empty if it is.
std::string whyFixed(const config::Assumption& assumption, const std::vector<config::Case>& cases) {
    if (!assumption.isBound) return "no parameter of the technique";
    const bool isScene = assumption.name == config::kSceneAssumption;
    for (const std::string& axis : {assumption.name, assumption.name + ".width"}) {
        const auto isSwept = [&](const config::Case& item) {
            return item.axes.find(axis) != nullptr;
        };
        if (!isScene && std::ranges::any_of(cases, isSwept)) {
            return "an axis of the table: it is varied there";
        }
    }
    if (assumption.range.isNull()) return "it has no range";
    if (isScene && run::alternativesOf(assumption, run::sceneNames(cases)).empty()) {
        return "no other scene for those of the table";
    }
    if (assumption.name == config::kSceneSeedAssumption && assumption.value.text() == "none") {
        return "no scene of the table is generated";
    }
    return "";
}

std::vector<Variation> sceneVariations(const config::Assumption& assumption,
                                       const std::vector<config::Case>& cases) {
    std::vector<Variation> variations;
    for (const auto& [name, other] : run::alternativesOf(assumption, run::sceneNames(cases))) {
        variations.push_back(
            {assumption.name,
             fmt::format("{} for {}", other.text(), name),
             std::nullopt,
             {fmt::format("{}={{{}: {}}}", config::kSceneInstead, name, other.text())}});
    }
    return variations;
}

/// The values of the range but for the one that the cases take.
std::vector<Variation> variationsOf(const config::Assumption& assumption,
                                    const std::vector<config::Case>& cases,
                                    const scene::Catalog& catalog, int points) {
    if (assumption.name == config::kSceneAssumption) return sceneVariations(assumption, cases);
    const Json range = assumption.range.toJson();
    const Node* current = cases.front().params.find(assumption.name);
    std::vector<Json> values(range.begin(), range.end());
    if (range.size() == 2 && range[0].is_number() && range[1].is_number()) {
        values.clear();
        const bool isInteger = range[0].is_number_integer() && range[1].is_number_integer() &&
                               (!current || current->tryInteger().has_value());
        for (const double value :
             pointsOf(range[0].get<double>(), range[1].get<double>(), points, isInteger)) {
            values.emplace_back(value);
        }
    }
    std::vector<Variation> variations;
    for (const Json& value : values) {
        Variation variation{assumption.name, textOf(value), std::nullopt, {}};
        if (variation.value == assumption.value.text()) continue;
        if (value.is_number()) variation.number = value.get<double>();
        variation.sets = setsOf(assumption.name, variation.value, cases, catalog);
        variations.push_back(std::move(variation));
    }
    return variations;
}

/// Where the margin of a claim passes 0 between two values; nothing where the margins do not tell.
std::optional<double> flipBetween(const VariationResult& a, const VariationResult& b,
                                  std::size_t claim) {
    const std::optional<double> first = a.claims[claim].distance;
    const std::optional<double> second = b.claims[claim].distance;
    if (!first || !second || (*first < 0.0) == (*second < 0.0)) return std::nullopt;
    const double t = *first / (*first - *second);
    return *a.variation.number + t * (*b.variation.number - *a.variation.number);
}

bool holds(const VariationResult& outcome, std::size_t claim) {
    return outcome.claims[claim].verdict == Verdict::Holds;
}

bool isJudged(const VariationResult& outcome, std::size_t claim) {
    if (claim >= outcome.claims.size()) return false;
    const Verdict verdict = outcome.claims[claim].verdict;
    return verdict != Verdict::NotApplicable && verdict != Verdict::Unmeasured;
}

/// The runs that judge the claim; the config as it is comes first, or none do.
std::vector<VariationResult> judged(const std::vector<VariationResult>& outcomes,
                                    std::size_t claim) {
    if (outcomes.empty() || !isJudged(outcomes.front(), claim)) return {};
    std::vector<VariationResult> kept;
    std::ranges::copy_if(outcomes, std::back_inserter(kept),
                         [&](const VariationResult& outcome) { return isJudged(outcome, claim); });
    return kept;
}

/// "bias is 0.03 or 0.1 (flips between 0.003 and 0.03, near 0.012)": the values under which the
/// claim holds, or those under which it does not.
std::string condition(const std::string& assumption, std::vector<const VariationResult*> outcomes,
                      std::size_t claim, bool whereItHolds) {
    std::vector<std::string> values;
    std::string flips;
    for (const VariationResult* outcome : outcomes) {
        if (holds(*outcome, claim) == whereItHolds) values.push_back(outcome->variation.value);
    }
    std::erase_if(outcomes,
                  [](const VariationResult* outcome) { return !outcome->variation.number; });
    std::ranges::sort(outcomes, {},
                      [](const VariationResult* outcome) { return *outcome->variation.number; });
    for (std::size_t i = 1; i < outcomes.size(); ++i) {
        const VariationResult &a = *outcomes[i - 1], &b = *outcomes[i];
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

Variations variationsOf(const config::Experiment& experiment,
                        const std::vector<config::Case>& cases, const scene::Catalog& catalog,
                        int points) {
    Variations result;
    result.runs.push_back({});
    std::vector<std::vector<Variation>> byAssumption;
    for (const config::Assumption& assumption : experiment.assumptions) {
        const std::string why =
            cases.empty() ? "the table has no cases" : whyFixed(assumption, cases);
        if (!why.empty()) {
            result.fixed.emplace_back(assumption.name, why);
            continue;
        }
        byAssumption.push_back(variationsOf(assumption, cases, catalog, points));
    }
    std::stable_partition(
        byAssumption.begin(), byAssumption.end(), [](const std::vector<Variation>& variations) {
            return !variations.empty() &&
                   variations.front().assumption.starts_with(config::kSceneAssumption);
        });
    std::size_t most = 0;
    for (const auto& variations : byAssumption) most = std::max(most, variations.size());
    for (std::size_t i = 0; i < most; ++i) {
        for (const auto& variations : byAssumption) {
            if (i < variations.size()) result.runs.push_back(variations[i]);
        }
    }
    return result;
}

std::vector<VariationResult> withLeft(std::vector<VariationResult> outcomes,
                                      const Variations& variations, std::size_t left) {
    const auto& runs = variations.runs;
    for (std::size_t i = runs.size() - std::min(left, runs.size()); i < runs.size(); ++i) {
        outcomes.push_back({runs[i], {}, "not made"});
    }
    return outcomes;
}

std::string dependence(const std::vector<VariationResult>& all, std::size_t claim) {
    const std::vector<VariationResult> outcomes = judged(all, claim);
    if (outcomes.empty()) return "not judged as configured";
    const auto holding =
        std::ranges::count_if(outcomes, [&](const VariationResult& o) { return holds(o, claim); });
    if (static_cast<std::size_t>(holding) == outcomes.size()) {
        return fmt::format("holds under all {}", outcomes.size());
    }
    if (holding == 0) return fmt::format("holds under none of {}", outcomes.size());
    std::vector<std::string> order;
    std::map<std::string, std::vector<const VariationResult*>> byAssumption;
    for (const VariationResult& outcome : outcomes) {
        const std::string& name = outcome.variation.assumption;
        if (name.empty()) continue;
        if (!byAssumption.contains(name)) order.push_back(name);
        byAssumption[name].push_back(&outcome);
    }
    const bool holdsAsConfigured = holds(outcomes.front(), claim);
    std::vector<std::string> conditions;
    for (const std::string& name : order) {
        const bool decides = std::ranges::any_of(byAssumption[name], [&](const VariationResult* o) {
            return holds(*o, claim) != holdsAsConfigured;
        });
        if (decides) {
            conditions.push_back(condition(name, byAssumption[name], claim, !holdsAsConfigured));
        }
    }
    return fmt::format("holds {} {}", holdsAsConfigured ? "unless" : "only if",
                       joined(conditions, ", or "));
}

std::string restsOn(const std::vector<VariationResult>& all, std::size_t claim) {
    const std::vector<VariationResult> outcomes = judged(all, claim);
    std::vector<std::string> known, tried, deciding;
    const auto note = [](std::vector<std::string>& names, const std::string& name) {
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    };
    for (const VariationResult& outcome : all) {
        if (!outcome.variation.assumption.empty()) note(known, outcome.variation.assumption);
    }
    for (const VariationResult& outcome : outcomes) {
        const std::string& name = outcome.variation.assumption;
        if (name.empty()) continue;
        note(tried, name);
        const bool isOther =
            outcome.claims[claim].verdict != outcomes.front().claims[claim].verdict;
        if (isOther) note(deciding, name);
    }
    if (tried.empty()) return "not tried";
    if (tried.size() < known.size()) {
        return fmt::format("{} ({} of {} tried)", deciding.empty() ? "none" : joined(deciding),
                           tried.size(), known.size());
    }
    if (deciding.empty()) return fmt::format("none of the {} tried", tried.size());
    return fmt::format("{} (of {} tried)", joined(deciding), tried.size());
}

namespace {

using report::escapeMarkdown;

constexpr std::size_t kColumns = 10;
constexpr const char* kHeader =
    "table,basis,assumption,value,claim,verdict,measured,required,margin,error\n";

std::string runsMarkdown(const std::vector<VariationResult>& outcomes) {
    const std::vector<ClaimResult>& claims = outcomes.front().claims;
    std::string text = "\n| run |";
    for (const ClaimResult& claim : claims) text += fmt::format(" {} |", escapeMarkdown(claim.id));
    text += "\n| --- |";
    for (std::size_t i = 0; i < claims.size(); ++i) text += " --- |";
    text += '\n';
    for (const VariationResult& outcome : outcomes) {
        text += fmt::format("| {} |", escapeMarkdown(outcome.variation.title()));
        for (const ClaimResult& claim : outcome.claims) {
            text += fmt::format(" {}: {} |", claims::verdictName(claim.verdict),
                                escapeMarkdown(claim.measured));
        }
        if (!outcome.error.empty()) text += fmt::format(" {} |", escapeMarkdown(outcome.error));
        text += '\n';
    }
    return text;
}

/// What a claim asks, without what is said about it.
Json requirementOf(const Node& claim) {
    Json json = claim.toJson();
    for (const char* key : {"says", "origin", "bound_from", "because", "same_as"}) json.erase(key);
    return json;
}

}  // namespace

std::string sensitivityMarkdown(const config::Experiment& experiment,
                                const std::vector<VariationResult>& outcomes,
                                const Variations& variations, std::size_t left) {
    const std::vector<ClaimResult>& claims = outcomes.front().claims;
    const std::vector<VariationResult> all = withLeft(outcomes, variations, left);
    std::string text = fmt::format(
        "# Sensitivity of {}\n\n{}\n\nEach assumption alone takes the values of its range; {} "
        "runs{}.\n\n| claim | says | as configured | rests on | under the assumptions |\n| --- | "
        "--- | --- | --- | --- |\n",
        escapeMarkdown(experiment.id), escapeMarkdown(experiment.title), outcomes.size(),
        left == 0 ? "" : fmt::format(", {} more were not made", left));
    for (std::size_t i = 0; i < claims.size(); ++i) {
        text +=
            fmt::format("| {} | {} | {} | {} | {} |\n", escapeMarkdown(claims[i].id),
                        escapeMarkdown(claims[i].text), claims::verdictName(claims[i].verdict),
                        escapeMarkdown(restsOn(all, i)), escapeMarkdown(dependence(outcomes, i)));
    }
    text += runsMarkdown(outcomes);
    if (variations.fixed.empty()) return text;
    text += "\nNot varied:\n";
    for (const auto& [name, why] : variations.fixed) {
        text += fmt::format("- {}: {}\n", escapeMarkdown(name), why);
    }
    return text;
}

std::string sensitivityCsv(const std::string& table, const std::vector<VariationResult>& outcomes,
                           const std::string& basis) {
    std::string text = kHeader;
    for (const VariationResult& outcome : outcomes) {
        const auto row = [&](const ClaimResult* claim) {
            records::CsvRow line(text);
            line.text(table).text(basis);
            line.text(outcome.variation.assumption).text(outcome.variation.value);
            line.text(claim ? claim->id : "");
            line.text(claim ? claims::verdictName(claim->verdict) : "");
            line.text(claim ? claim->measured : "").text(claim ? claim->required : "");
            if (claim && claim->distance) {
                line.number(*claim->distance);
            } else {
                line.text("");
            }
            line.text(outcome.error).end();
        };
        for (const ClaimResult& claim : outcome.claims) row(&claim);
        if (outcome.claims.empty()) row(nullptr);
    }
    return text;
}

namespace {

/// Calls `take(row, where, bytes)` for each row of what sensitivityCsv() wrote, without the header.
template <class Take>
void readRows(const fs::path& file, const Take& take) {
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> fields;
    reader.next(fields);  // the header
    std::size_t begin = reader.rowEnd();
    while (reader.next(fields)) {
        if (fields.size() != kColumns) {
            throw Error(reader.location(),
                        fmt::format("expected {} columns, found {}", kColumns, fields.size()));
        }
        take(fields, reader.location(), text.substr(begin, reader.rowEnd() - begin));
        begin = reader.rowEnd();
    }
}

}  // namespace

std::vector<VariationResult> readSensitivity(const fs::path& file, const std::string& table,
                                             const std::string& basis) {
    enum Column { Table, Basis, Name, Value, Claim, Word, Measured, Required, Margin, Problem };
    std::vector<VariationResult> outcomes;
    readRows(file, [&](const std::vector<std::string>& fields, const SourceLocation& where,
                       const std::string&) {
        if (fields[Table] != table || (!basis.empty() && fields[Basis] != basis)) return;
        const bool isNew = outcomes.empty() ||
                           outcomes.back().variation.assumption != fields[Name] ||
                           outcomes.back().variation.value != fields[Value];
        if (isNew) {
            outcomes.push_back({{fields[Name], fields[Value], parseDouble(fields[Value]), {}},
                                {},
                                fields[Problem]});
        }
        if (fields[Claim].empty()) return;
        ClaimResult& claim = outcomes.back().claims.emplace_back();
        claim.id = fields[Claim];
        claim.verdict = claims::verdictAt(where, fields[Word]);
        claim.measured = fields[Measured];
        claim.required = fields[Required];
        claim.distance = parseDouble(fields[Margin]);
    });
    return outcomes;
}

void keepSensitivity(const fs::path& file, const std::string& table, const std::string& csv) {
    std::map<std::string, std::string> rows;  // of each table, as they stand there
    if (fs::is_regular_file(file)) {
        readRows(file, [&](const std::vector<std::string>& fields, const SourceLocation&,
                           const std::string& row) { rows[fields.front()] += row; });
    }
    const std::string header = kHeader;
    rows[table] = csv.substr(header.size());
    std::string text = header;
    for (const auto& [name, ofTable] : rows) text += ofTable;
    writeFileAtomic(file, text);
}

std::string basisOf(const run::Plan& plan, const config::Experiment& experiment) {
    Json content = {{"device_class", plan.deviceClass}, {"technique", experiment.technique}};
    for (const config::Case& item : plan.cases) {
        if (item.experiment != experiment.id) continue;
        Json one = {{"scene", ""},
                    {"params", item.recordedParams().toJson()},
                    {"axes", item.axes.toJson()},
                    {"frames", item.measure.frames},
                    {"lane", static_cast<int>(item.measure.lane)}};
        for (const auto& [name, reference] : run::scenesOf(item)) {
            const auto scene = plan.sceneKeys.find(reference.text());
            if (scene != plan.sceneKeys.end()) one[name] = scene->second;
        }
        content["cases"].push_back(std::move(one));
    }
    const config::ContentKeys given = config::contentOf(experiment.document);
    if (given.layout) content["layout"] = given.layout->toJson();
    for (const std::vector<std::string>& row : experiment.printed.rows) {
        content["printed"].push_back(row);
    }
    if (given.claims) {
        for (const auto& [id, claim] : given.claims->entries()) {
            content["claims"][id] = requirementOf(claim);
        }
    }
    return sha256(content.dump()).substr(0, 12);
}

fs::path keptFile(const fs::path& folder, const run::Plan& plan) {
    return folder / fmt::format("{}-{}.csv", plan.deviceClass, plan.profile);
}

std::string sensitivityIndex(const fs::path& folder, const std::string& command) {
    std::string text =
        "# sensitivity\nOn which assumptions the verdicts rest: each assumption of a table took "
        "the values of its range, alone, and the claims were judged anew. `none` has the claims "
        "that no assumption tried turned. A table that is not here was not tried: all its claims "
        "are of times.\nWritten by `gfxrepro sensitivity … --keep`, last by\n\n    " +
        command + "\n";
    std::set<fs::path> files;
    for (const fs::directory_entry& file : entriesBelow(folder)) {
        if (file.path().extension() == ".csv") files.insert(file.path());
    }
    for (const fs::path& file : files) {
        const std::string name = file.stem().string();
        text += fmt::format(
            "\n## [{0}]({0}.csv)\n| table | none | rests on |\n| --- | --- | --- |\n", name);
        std::vector<std::string> tables;  // by the order of their rows
        readRows(file, [&](const std::vector<std::string>& fields, const SourceLocation&,
                           const std::string&) {
            if (tables.empty() || tables.back() != fields.front()) tables.push_back(fields.front());
        });
        for (const std::string& table : tables) {
            const std::vector<VariationResult> outcomes = readSensitivity(file, table);
            std::vector<std::string> firm, resting;
            for (std::size_t i = 0; i < outcomes.front().claims.size(); ++i) {
                const std::string& id = outcomes.front().claims[i].id;
                const std::string rests = restsOn(outcomes, i);
                if (rests == "not tried") continue;
                if (rests.starts_with("none")) {
                    firm.push_back(id);
                } else {
                    resting.push_back(fmt::format("{}: {}", id, rests));
                }
            }
            text +=
                fmt::format("| {} | {} | {} |\n", escapeMarkdown(table),
                            escapeMarkdown(joined(firm)), escapeMarkdown(joined(resting, "; ")));
        }
    }
    return text;
}

claims::KeptSensitivity keptSensitivity(const run::Plan& plan,
                                        const std::vector<config::Experiment>& experiments,
                                        const fs::path& folder) {
    claims::KeptSensitivity kept;
    const fs::path file = keptFile(folder, plan);
    if (!fs::is_regular_file(file)) return kept;
    for (const config::Experiment& experiment : experiments) {
        const std::vector<VariationResult> outcomes =
            readSensitivity(file, experiment.id, basisOf(plan, experiment));
        if (outcomes.empty()) continue;
        const std::vector<ClaimResult>& claims = outcomes.front().claims;
        for (std::size_t i = 0; i < claims.size(); ++i) {
            kept[{experiment.id, claims[i].id}] = {claims[i].verdict, restsOn(outcomes, i)};
        }
    }
    return kept;
}

std::optional<claims::KeptSensitivity> keptSensitivity(
    const run::Plan& plan, const std::vector<config::Experiment>& experiments) {
    const fs::path folder = dataFolder("configs").parent_path() / "results" / "sensitivity";
    if (!fs::is_directory(folder)) return std::nullopt;
    return keptSensitivity(plan, experiments, folder);
}

}  // namespace gfxrepro::studies
