#include "runner/run/plan.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/scene/scene_reference.h"
#include "runner/run/ledger.h"
#include "runner/run/plan_json.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::string hashOf(const Plan& plan) {
    std::vector<Json> documents;
    for (const config::Experiment& experiment : plan.experiments) {
        documents.push_back(experiment.document.toJson());
    }
    return planHash(plan, documents);
}

void requireNoImport(const config::Experiment& experiment) {
    if (experiment.technique != config::kImported) return;
    throw Error(config::contentOf(experiment.document).technique->location(),
                "technique 'imported': its numbers are measured elsewhere; `gfxrepro import "
                "FILE.csv --config " +
                    experiment.file.filename().string() + "` takes them");
}

}  // namespace

std::string Shard::name() const {
    return std::to_string(index) + '/' + std::to_string(count);
}

Plan makePlan(const std::vector<config::Experiment>& experiments, const scene::Catalog& catalog,
              std::span<const technique::TechniqueInfo> techniques, const std::string& profile,
              const std::string& deviceClass, std::uint64_t seed) {
    Plan plan;
    plan.profile = profile;
    plan.deviceClass = deviceClass;
    plan.seed = seed;
    plan.buildId = programBuildId();
    plan.experiments = experiments;
    for (config::Experiment& experiment : plan.experiments) {
        requireNoImport(experiment);
        experiment.paperCases = resolvePaperCases(experiment, catalog, techniques);
    }
    std::size_t units = 0;
    std::map<std::string, std::string> idsOfFiles;
    std::set<std::string> caseIds;
    config::FileDigests digests;
    for (config::Experiment& experiment : plan.experiments) {
        const auto [first, isNew] = idsOfFiles.try_emplace(experiment.slug(), experiment.id);
        if (!isNew) {
            const bool isSame = first->second == experiment.id;
            throw Error(experiment.file.string() + ": the experiment '" + experiment.id +
                        (isSame ? "' is given twice"
                                : "' and '" + first->second + "' would write the same files, '" +
                                      first->first + "'; allowed: one of them in a run"));
        }
        std::vector<Case> cases = resolveCases(experiment, catalog, techniques, seed);
        if (!cases.empty()) experiment.measure.seeds = cases.front().measure.seeds;
        bindAssumptions(experiment, cases, catalog, techniques);
        if (experiment.hasDefaultLayout()) {
            experiment.outputs =
                technique::outputsOf(technique::findTechnique(techniques, experiment.technique, {}),
                                     config::programOf(experiment));
        }
        requireCaseCount(plan.cases.size() + cases.size(), experiment);
        units += unitCount(cases);
        requireUnitCount(units, {experiment.file.string(), 0, 0});
        for (Case& item : cases) {
            for (const auto& [name, reference] : scenesOf(item)) {
                std::string& known = plan.sceneKeys[reference.text()];
                if (known.empty()) known = catalog.contentKey(reference);
            }
            item.programKey = programKeyOf(item, digests);
            item.id = caseId(item, toJson(item), plan);
            if (!caseIds.insert(item.id).second) {
                throw Error(experiment.file.string() + ": the sweep gives the case '" +
                            item.title() + "' twice");
            }
        }
        if (plan.cases.empty()) {
            plan.cases = std::move(cases);  // of 100,000 cases a second list counts
        } else {
            std::ranges::move(cases, std::back_inserter(plan.cases));
        }
    }
    plan.hash = hashOf(plan);
    return plan;
}

std::string programKeyOf(const Case& item, config::FileDigests& digests) {
    if (item.program.isNull()) return "";
    const config::ExternalProgram program = config::readProgram(item.program);
    return config::programKey(config::filesOf(program, program.valuesOf(item.params)), digests);
}

void rebind(Plan& plan, const std::string& deviceClass) {
    plan.deviceClass = deviceClass;
    for (Case& item : plan.cases) item.id = caseId(item, toJson(item), plan);
}

std::string whyNotResumable(const Plan& plan, const std::string& deviceClass,
                            const scene::Catalog& catalog) {
    if (const std::string build = programBuildId(); plan.buildId != build) {
        return "the program or a shader changed (build " + plan.buildId.substr(0, 12) + " then, " +
               build.substr(0, 12) + " now)";
    }
    if (plan.deviceClass != deviceClass) {
        return "the run began on a " + plan.deviceClass + " device, this one is a " + deviceClass +
               " device";
    }
    for (const auto& [reference, key] : plan.sceneKeys) {
        if (catalog.contentKey(Node::scalar(reference)) != key) {
            return "the scene '" + reference + "' changed";
        }
    }
    config::FileDigests digests;
    for (const Case& item : plan.cases) {
        if (item.programKey.empty()) continue;  // of none, or one that was not at hand then
        if (programKeyOf(item, digests) != item.programKey) {
            return "the program of " + item.experiment + ", or a file of it, changed";
        }
    }
    return "";
}

std::string planDifference(const Plan& then, const Plan& now) {
    if (then.buildId != now.buildId) {
        return "the program or a shader changed (build " + then.buildId.substr(0, 12) + " then, " +
               now.buildId.substr(0, 12) + " now)";
    }
    if (then.deviceClass != now.deviceClass) {
        return "the run began on a " + then.deviceClass + " device, this one is a " +
               now.deviceClass + " device";
    }
    if (then.hash == now.hash) return "";
    for (const auto& [reference, key] : then.sceneKeys) {
        const auto found = now.sceneKeys.find(reference);
        if (found != now.sceneKeys.end() && found->second != key) {
            return "the scene '" + reference + "' changed";
        }
    }
    for (const config::Experiment& before : then.experiments) {
        const auto after =
            std::ranges::find(now.experiments, before.file, &config::Experiment::file);
        if (after == now.experiments.end()) continue;
        if (before.document.toJson() != after->document.toJson()) {
            return "the config " + before.file.string() + " changed";
        }
    }
    return "the experiments are not the same";
}

std::string programBuildId() {
    return buildIdOf("/proc/self/exe", dataFolder("shaders"));
}

std::string buildIdOf(const fs::path& program, const fs::path& shaders) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : entriesBelow(shaders)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::string content = sha256OfFile(program);
    for (const fs::path& file : files) {
        content += '\n' + fs::relative(file, shaders).string() + ' ' + sha256OfFile(file);
    }
    return sha256(content);
}

}  // namespace gfxrepro::run
