// What the kept results say of each claim, held against what its config knows of it.

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <regex>
#include <set>

#include "engine/scene/scene_reference.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/config/experiment.h"
#include "runner/tables/table.h"
#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

using Known = config::ClaimSpec::Known;

/// Another tree than its own is looked at where the environment names one.
const fs::path kSource =
    std::getenv("GFXREPRO_SOURCE") ? std::getenv("GFXREPRO_SOURCE") : GFXREPRO_SOURCE_DIR;

/// A verdict of a kept run.
struct Kept {
    claims::Verdict verdict;
    std::string deviceClass, profile;
    std::string file;                  // with the claim: what a message names
    std::set<std::string> scans = {};  // its scenes that were files
};

/// By table and claim.
std::map<std::pair<std::string, std::string>, std::vector<Kept>> keptVerdicts(
    const fs::path& root) {
    std::map<std::pair<std::string, std::string>, std::vector<Kept>> kept;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().filename() != "claims.csv") continue;
        const fs::path folder = entry.path().parent_path();
        std::map<std::string, claims::KeptRun> runs;
        for (const claims::KeptRun& run : claims::readKeptRuns(folder / "runs.csv")) {
            runs[run.table] = run;
        }
        for (const claims::ClaimResult& claim : claims::readClaims(entry.path())) {
            const claims::KeptRun& run = runs.at(claim.table);
            std::set<std::string> scans;
            for (const std::string& scene : run.scans) scans.insert(scene::sceneName(scene));
            kept[{claim.table, claim.id}].push_back(
                {claim.verdict, run.deviceClass, folder.filename(),
                 fs::relative(entry.path(), root).string() + ": " + claim.table + " " + claim.id,
                 scans});
        }
    }
    return kept;
}

/// By name alone: kept results have no plan that knows with which seeds they were loaded.
std::set<std::string> scenesOf(const config::Experiment& experiment) {
    std::set<std::string> scenes;
    for (const config::Case& item : config::expandCases(experiment)) {
        if (!item.scene.isNull()) scenes.insert(scene::sceneName(item.scene.text()));
    }
    return scenes;
}

bool isOf(const Known& known, const config::Experiment& experiment, const Kept& kept) {
    const std::set<std::string> scenes = scenesOf(experiment);
    claims::SceneFiles files;
    for (const std::string& scene : scenes) files[scene] = kept.scans.contains(scene);
    if (known.scenes && *known.scenes != claims::sceneClass(scenes, files)) return false;
    return known.device.value_or(kept.deviceClass) == kept.deviceClass &&
           known.profile.value_or(kept.profile) == kept.profile;
}

/// What a config and the kept results say differently: a claim that fails somewhere without a
/// reason, and a reason of a claim that holds in every run that it is of.
std::vector<std::string> complaints(const config::Experiment& experiment,
                                    const decltype(keptVerdicts(""))& all) {
    std::vector<std::string> texts;
    for (const config::ClaimSpec& claim : experiment.claims) {
        const auto found = all.find({experiment.id, claim.id});
        if (found == all.end()) continue;
        for (const Kept& kept : found->second) {
            const bool isKnown = std::ranges::any_of(
                claim.because, [&](const Known& k) { return isOf(k, experiment, kept); });
            if (kept.verdict == claims::Verdict::Fails && !isKnown) {
                texts.push_back(kept.file + " fails, and its config has no reason for it");
            }
        }
        for (const Known& known : claim.because) {
            if (known.verdict != "fails") continue;  // ambiguous is no verdict that turns
            std::size_t holding = 0, others = 0;
            for (const Kept& kept : found->second) {
                if (isOf(known, experiment, kept)) {
                    ++(kept.verdict == claims::Verdict::Holds ? holding : others);
                }
            }
            if (holding > 0 && others == 0) {
                texts.push_back(
                    experiment.id + " " + claim.id +
                    " holds in every kept run, and has a stale reason: " + known.reason);
            }
        }
    }
    return texts;
}

/// One or two sentences, of a length that is read at a glance.
bool isPlain(const std::string& reason) {
    constexpr std::size_t kMostBytes = 320;
    static const std::regex kEnd(R"([.!?](?=\s+["“(A-Z0-9]|$))");
    const auto ends = std::distance(std::sregex_iterator(reason.begin(), reason.end(), kEnd),
                                    std::sregex_iterator());
    const bool isOpen = !reason.empty() && reason.back() != '.';
    return ends + (isOpen ? 1 : 0) <= 2 && reason.size() <= kMostBytes;
}

template <class Visit>
void visitConfigs(const Visit& visit) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / "configs")) {
        const std::string name = entry.path().stem().string();
        const bool isSweep = entry.path().parent_path().filename() == "sweeps";
        const bool isOfDocument = name.starts_with("table-") || name.starts_with("figure-") ||
                                  name.starts_with("section-");
        if (entry.path().extension() != ".yaml" || !(isSweep || isOfDocument)) continue;
        visit(config::loadExperiment(entry.path(), {}, kSource / "configs"));
    }
}

TEST(KeptVerdicts, EveryFailingClaimHasAReasonAndNoHoldingOneAStaleOne) {
    const auto all = keptVerdicts(kSource / "results" / "reference");
    ASSERT_GT(all.size(), 100u);
    visitConfigs([&](const config::Experiment& experiment) {
        EXPECT_THAT(complaints(experiment, all), IsEmpty());
    });
}

/// The cases as far as a row's labels are of them.
std::vector<config::Case> casesOf(const config::Experiment& experiment) {
    std::vector<config::Case> cases = config::expandCases(experiment);
    for (config::Case& item : cases) item.params = item.given;
    return cases;
}

/// scripts/update_verdicts takes from it what claims ask today, whose they are, and on which part
/// of their rows it judged them.
TEST(KeptVerdicts, TheFullestQuickRunAsksWhatTheConfigsAsk) {
    std::vector<claims::ClaimResult> fullest;
    for (const auto& device : fs::directory_iterator(kSource / "results" / "reference")) {
        const fs::path file = device.path() / "quick" / "claims.csv";
        if (!fs::exists(file)) continue;
        std::vector<claims::ClaimResult> kept = claims::readClaims(file);
        std::erase_if(kept, [](const auto& claim) { return claim.table.starts_with("sweep/"); });
        if (kept.size() > fullest.size()) fullest = std::move(kept);
    }
    ASSERT_GT(fullest.size(), 300u);
    std::map<std::pair<std::string, std::string>, const claims::ClaimResult*> kept;
    std::set<std::string> keptDocuments, others;
    const auto documentOf = [](const std::string& id) { return id.substr(0, id.find('/')); };
    for (const claims::ClaimResult& claim : fullest) {
        kept[{claim.table, claim.id}] = &claim;
        keptDocuments.insert(documentOf(claim.table));
    }
    std::size_t count = 0;
    visitConfigs([&](const config::Experiment& experiment) {
        if (experiment.kind == config::ExperimentKind::Sweep) return;
        if (!keptDocuments.contains(documentOf(experiment.id))) {
            others.insert(documentOf(experiment.id));
            return;
        }
        config::Experiment quick =
            config::loadExperiment(experiment.file, {.profile = "quick"}, kSource / "configs");
        if (!quick.paperDocument.isNull()) {
            quick.paperCases =
                casesOf(config::experimentFromDocument(quick.paperDocument, quick.file));
        }
        const std::vector<config::Case> planned = casesOf(quick);
        claims::ReportContext context;
        for (const claims::ClaimResult& claim : claims::evaluateClaims(
                 quick, tables::buildTable(quick, planned, {}), context, planned)) {
            SCOPED_TRACE(claim.table + " " + claim.id);
            ++count;
            ASSERT_TRUE(kept.contains({claim.table, claim.id}));
            const claims::ClaimResult& judged = *kept.at({claim.table, claim.id});
            EXPECT_EQ(judged.origin, claim.origin);
            // Runs of before did not name the axis of the values in an order.
            const std::string required =
                claim.required.ends_with(": " + judged.required) ? judged.required : claim.required;
            EXPECT_EQ(judged.required, required);
            EXPECT_EQ(judged.sameAs, claim.sameAs);
            // No technique says here what its parameters are where a config does not: of rows that
            // are told by one, nothing is known.
            const bool isJudged = judged.verdict != claims::Verdict::NotApplicable;
            if (isJudged && !claim.rows.empty()) EXPECT_EQ(judged.rows, claim.rows);
        }
    });
    EXPECT_EQ(count, fullest.size());
    for (const std::string& document : others) {
        std::cout << document << " was not looked at: no run of it is kept yet\n";
    }
}

TEST(KeptVerdicts, ReasonsAreOneOrTwoSentences) {
    visitConfigs([](const config::Experiment& experiment) {
        for (const config::ClaimSpec& claim : experiment.claims) {
            for (const Known& known : claim.because) {
                EXPECT_TRUE(isPlain(known.reason))
                    << experiment.id << ' ' << claim.id << ": " << known.reason
                    << "\nallowed: two sentences of 320 bytes; what proves it stands where "
                       "shown_by says";
            }
        }
    });
}

/// The first word that is a claim's code ("R1-traced"), which tells a reader of the page nothing.
std::string codeIn(const std::string& text) {
    static const std::regex kCode(R"((^|[^\w-])([A-Z]\d{1,2}[a-z]?(-[a-z0-9_]+)*)(?![\w-]))");
    std::smatch found;
    return std::regex_search(text, found, kCode) ? found[2].str() : "";
}

TEST(KeptVerdicts, ReasonsNameOtherClaimsInWords) {
    EXPECT_EQ(codeIn("As N3-min: nest and tree"), "N3-min");
    EXPECT_EQ(codeIn("by 2048² of 3 × 3 texels, ΔS = 2, on an H100"), "");
    visitConfigs([](const config::Experiment& experiment) {
        for (const config::ClaimSpec& claim : experiment.claims) {
            for (const Known& known : claim.because) {
                EXPECT_EQ(codeIn(known.reason), "")
                    << experiment.id << ' ' << claim.id << ": say what the other claim says";
            }
        }
    });
}

TEST(KeptVerdicts, WhatDiffersIsFound) {
    config::Experiment experiment;
    experiment.id = "p/1";
    const config::ClaimSpec claim{.id = "A"};
    experiment.claims = {claim};
    const Kept fails{claims::Verdict::Fails, "software", "quick", "f"};
    const Kept holds{claims::Verdict::Holds, "software", "quick", "h"};
    EXPECT_EQ(complaints(experiment, {{{"p/1", "A"}, {fails}}}).size(), 1u);
    experiment.claims[0].because = {{"fails", "software", std::nullopt, std::nullopt, "r", ""}};
    EXPECT_THAT(complaints(experiment, {{{"p/1", "A"}, {fails, holds}}}), IsEmpty());
    EXPECT_EQ(complaints(experiment, {{{"p/1", "A"}, {holds}}}).size(), 1u);
    experiment.claims[0].because[0].device = "gpu";
    EXPECT_EQ(complaints(experiment, {{{"p/1", "A"}, {fails}}}).size(), 1u);
    // What is known of real scenes alone tells nothing of generated ones.
    experiment.technique = "t";
    experiment.scene = Node::scalar("s");
    experiment.claims[0].because[0] = {"fails", std::nullopt, std::nullopt, "files", "r", ""};
    Kept real = fails;
    const Kept generated = fails;
    real.scans = {"s"};
    EXPECT_THAT(complaints(experiment, {{{"p/1", "A"}, {real}}}), IsEmpty());
    EXPECT_EQ(complaints(experiment, {{{"p/1", "A"}, {generated}}}).size(), 1u);
    EXPECT_TRUE(isPlain("Ten. 2.5 % of them, at 0.3 m"));
    EXPECT_FALSE(isPlain("One. Two. Three."));
}

}  // namespace
}  // namespace gfxrepro::test
