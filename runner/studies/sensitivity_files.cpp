// The files of a sensitivity analysis: written, kept, and read again for a report.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/records/csv.h"
#include "runner/report/markup.h"
#include "runner/studies/sensitivity.h"

namespace gfxrepro::studies {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;
using claims::ClaimResult;
using report::escapeMarkdown;

constexpr const char* kHeader =
    "basis,assumption,value,claim,verdict,measured,required,margin,error\n";

std::string runsMarkdown(const std::vector<Outcome>& outcomes) {
    const std::vector<ClaimResult>& claims = outcomes.front().claims;
    std::string text = "\n| run |";
    for (const ClaimResult& claim : claims) text += fmt::format(" {} |", escapeMarkdown(claim.id));
    text += "\n| --- |";
    for (std::size_t i = 0; i < claims.size(); ++i) text += " --- |";
    text += '\n';
    for (const Outcome& outcome : outcomes) {
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
    for (const char* key : {"says", "origin", "bound_from", "because"}) json.erase(key);
    return json;
}

}  // namespace

std::string sensitivityMarkdown(const config::Experiment& experiment,
                                const std::vector<Outcome>& outcomes, const Variations& variations,
                                std::size_t left) {
    const std::vector<ClaimResult>& claims = outcomes.front().claims;
    const std::vector<Outcome> all = withLeft(outcomes, variations, left);
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

std::string untriedMarkdown(const config::Experiment& experiment) {
    return fmt::format(
        "# Sensitivity of {}\n\n{}\n\nNot tried: all its claims are of times, which vary with the "
        "machine beside the assumptions.\n",
        escapeMarkdown(experiment.id), escapeMarkdown(experiment.title));
}

std::string sensitivityCsv(const std::vector<Outcome>& outcomes, const std::string& basis) {
    std::string text = kHeader;
    for (const Outcome& outcome : outcomes) {
        const auto row = [&](const ClaimResult* claim) {
            records::CsvRow line(text);
            line.text(basis).text(outcome.variation.assumption).text(outcome.variation.value);
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

std::vector<Outcome> readSensitivity(const fs::path& file, const std::string& basis) {
    enum Column { Basis, Name, Value, Claim, Word, Measured, Required, Margin, Problem, Count };
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> fields;
    std::vector<Outcome> outcomes;
    reader.next(fields);  // the header
    while (reader.next(fields)) {
        if (fields.size() != Count) {
            throw Error(reader.location(),
                        fmt::format("expected {} columns, found {}", int{Count}, fields.size()));
        }
        if (!basis.empty() && fields[Basis] != basis) return {};
        const bool isNew = outcomes.empty() ||
                           outcomes.back().variation.assumption != fields[Name] ||
                           outcomes.back().variation.value != fields[Value];
        if (isNew) {
            outcomes.push_back({{fields[Name], fields[Value], parseDouble(fields[Value]), {}},
                                {},
                                fields[Problem]});
        }
        if (fields[Claim].empty()) continue;
        ClaimResult& claim = outcomes.back().claims.emplace_back();
        claim.id = fields[Claim];
        claim.verdict = claims::verdictAt(reader.location(), fields[Word]);
        claim.measured = fields[Measured];
        claim.required = fields[Required];
        claim.distance = parseDouble(fields[Margin]);
    }
    return outcomes;
}

std::string basisOf(const run::Plan& plan, const config::Experiment& experiment) {
    Json content = {{"device_class", plan.deviceClass}, {"technique", experiment.technique}};
    for (const config::Case& item : plan.cases) {
        if (item.experiment != experiment.id) continue;
        const auto scene =
            item.scene.isNull() ? plan.sceneKeys.end() : plan.sceneKeys.find(item.scene.text());
        content["cases"].push_back({{"scene", scene == plan.sceneKeys.end() ? "" : scene->second},
                                    {"params", item.recordedParams().toJson()},
                                    {"axes", item.axes.toJson()},
                                    {"frames", item.measure.frames},
                                    {"lane", static_cast<int>(item.measure.lane)}});
    }
    if (const Node* layout = experiment.document.find("layout")) {
        content["layout"] = layout->toJson();
    }
    for (const std::vector<std::string>& row : experiment.printed.rows) {
        content["printed"].push_back(row);
    }
    if (const Node* claims = experiment.document.find("claims")) {
        for (const auto& [id, claim] : claims->entries()) {
            content["claims"][id] = requirementOf(claim);
        }
    }
    return sha256(content.dump()).substr(0, 12);
}

fs::path keptFolder(const fs::path& folder, const run::Plan& plan) {
    return folder / plan.deviceClass / plan.profile;
}

std::string sensitivityIndex(const fs::path& folder, const std::string& command) {
    std::string text =
        "# sensitivity\nOn which assumptions the verdicts rest: each assumption of a table took "
        "the "
        "values of its range, alone, and the claims were judged anew. `none` has the claims that "
        "no "
        "assumption tried turned.\nWritten by `gfxrepro sensitivity … --keep`, last by\n\n    " +
        command + "\n";
    std::set<fs::path> files;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder)) {
        const bool isPage = file.path().extension() == ".md" && file.path().parent_path() != folder;
        if (isPage) files.insert(fs::path(file.path()).replace_extension(".csv"));
    }
    const auto link = [&](const fs::path& file) {
        const fs::path page = fs::path(file).replace_extension(".md").lexically_relative(folder);
        return fmt::format("[{}]({})", file.stem().string(), page.generic_string());
    };
    fs::path last;
    std::vector<std::string> untried;
    const auto sayUntried = [&] {
        if (!untried.empty())
            text += fmt::format("\nNot tried, each says why: {}.\n", joined(untried));
        untried.clear();
    };
    for (const fs::path& file : files) {
        const std::vector<Outcome> outcomes =
            fs::is_regular_file(file) ? readSensitivity(file) : std::vector<Outcome>{};
        if (file.parent_path() != last) {
            sayUntried();
            last = file.parent_path();
            text += fmt::format("\n## {}\n| table | none | rests on |\n| --- | --- | --- |\n",
                                last.lexically_relative(folder).generic_string());
        }
        std::vector<std::string> firm, resting;
        const std::size_t claims = outcomes.empty() ? 0 : outcomes.front().claims.size();
        for (std::size_t i = 0; i < claims; ++i) {
            const std::string& id = outcomes.front().claims[i].id;
            const std::string rests = restsOn(outcomes, i);
            if (rests.starts_with("none")) firm.push_back(id);
            if (!rests.starts_with("none") && rests != "not tried") {
                resting.push_back(fmt::format("{}: {}", id, rests));
            }
        }
        if (firm.empty() && resting.empty()) {
            untried.push_back(link(file));
            continue;
        }
        text += fmt::format("| {} | {} | {} |\n", link(file), escapeMarkdown(joined(firm)),
                            escapeMarkdown(joined(resting, "; ")));
    }
    sayUntried();
    return text;
}

claims::KeptSensitivity keptSensitivity(const run::Plan& plan,
                                        const std::vector<config::Experiment>& experiments,
                                        const fs::path& folder) {
    claims::KeptSensitivity kept;
    for (const config::Experiment& experiment : experiments) {
        const fs::path file = keptFolder(folder, plan) / (experiment.slug() + ".csv");
        if (!fs::is_regular_file(file)) continue;
        const std::vector<Outcome> outcomes = readSensitivity(file, basisOf(plan, experiment));
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
