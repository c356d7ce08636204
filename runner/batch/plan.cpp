#include "runner/batch/plan.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>

#include "runner/batch/ledger.h"
#include "runner/core/files.h"
#include "runner/core/hash.h"
#include "runner/report/case_records.h"

namespace gfxrepro::batch {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kPlanSchema = 1;

/// The first 12 digits of the hash of everything that the case's results depend on.
std::string contentId(const Case& item, const std::string& sceneKey, const Plan& plan) {
    Json content = item.toJson();
    content["scene"] = sceneKey;
    content["device_class"] = plan.deviceClass;
    content["build"] = plan.buildId;
    return sha256(content.dump()).substr(0, 12);
}

std::string hashOf(const Plan& plan) {
    Json content = {{"profile", plan.profile},
                    {"device_class", plan.deviceClass},
                    {"build", plan.buildId},
                    {"seed", plan.seed}};
    for (const Case& item : plan.cases) content["cases"].push_back(item.id);
    for (const config::Experiment& experiment : plan.experiments) {
        content["documents"].push_back(experiment.document.toJson());
    }
    return sha256(content.dump());
}

Json toJson(const config::Measure& measure) {
    return {{"lane", measure.lane == config::Measure::Lane::Timing ? "timing" : "quality"},
            {"warmup", measure.warmup},
            {"repeats", measure.repeats},
            {"processes", measure.processes},
            {"relative_error", measure.relativeError},
            {"processes_at_most", measure.processesAtMost},
            {"time_budget_s", measure.timeBudgetS},
            {"frames", measure.frames},
            {"time_limit_s", measure.timeLimitS},
            {"memory_limit_bytes", measure.memoryLimitBytes}};
}

void requireMap(const config::Node& node, const char* what) {
    if (node.isMap()) return;
    throw Error(node.location(), std::string(what) + " is no map but " + node.kindName());
}

const config::Node& required(const config::Node& map, const char* key) {
    requireMap(map, ("what should hold '" + std::string(key) + "'").c_str());
    const config::Node* value = map.find(key);
    if (!value) throw Error(map.location(), "the entry '" + std::string(key) + "' is missing");
    return *value;
}

const config::Node& requiredMap(const config::Node& map, const char* key) {
    const config::Node& value = required(map, key);
    requireMap(value, key);
    return value;
}

std::uint64_t requiredSeed(const config::Node& map) {
    const config::Node& node = required(map, "seed");
    const std::string& text = node.text();
    std::uint64_t seed = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (problem != std::errc() || end != text.data() + text.size()) {
        throw Error(node.location(), "the seed '" + text + "' is no number");
    }
    return seed;
}

/// Twelve hexadecimal digits: files have it in their names.
std::string requiredId(const config::Node& map) {
    const config::Node& node = required(map, "id");
    const std::string& id = node.text();
    const bool isId = id.size() == 12 && id.find_first_not_of("0123456789abcdef") == id.npos;
    if (!isId) throw Error(node.location(), "'" + id + "' is no id of a case");
    return id;
}

int requiredInt(const config::Node& map, const char* key) {
    return static_cast<int>(required(map, key).asInteger());
}

config::Measure measureFrom(const config::Node& node) {
    config::Measure measure;
    measure.lane = required(node, "lane").text() == "timing" ? config::Measure::Lane::Timing
                                                             : config::Measure::Lane::Quality;
    measure.warmup = requiredInt(node, "warmup");
    measure.repeats = requiredInt(node, "repeats");
    measure.processes = requiredInt(node, "processes");
    // Plans of older versions know of no further rounds.
    if (node.find("relative_error")) {
        measure.relativeError = required(node, "relative_error").asDouble();
        measure.processesAtMost = requiredInt(node, "processes_at_most");
        measure.timeBudgetS = required(node, "time_budget_s").asDouble();
    }
    measure.frames = requiredInt(node, "frames");
    measure.timeLimitS = required(node, "time_limit_s").asDouble();
    measure.memoryLimitBytes = required(node, "memory_limit_bytes").asInteger();
    return measure;
}

/// Value and unit of the assumptions that are bound to the cases.
Json assumedJson(const config::Experiment& experiment) {
    Json json = Json::object();
    for (const config::Assumption& assumption : experiment.assumptions) {
        if (!assumption.isBound) continue;
        json[assumption.name] = {{"value", assumption.value.text()}, {"unit", assumption.unit}};
    }
    return json;
}

void takeAssumed(const config::Node& assumed, config::Experiment& experiment) {
    requireMap(assumed, "assumed");
    for (config::Assumption& assumption : experiment.assumptions) {
        const config::Node* bound = assumed.find(assumption.name);
        if (!bound) continue;
        assumption.isBound = true;
        assumption.value = required(*bound, "value");
        assumption.unit = required(*bound, "unit").text();
    }
}

Json paperToJson(const config::Experiment& experiment) {
    Json cases = Json::array();
    for (const config::PaperCase& item : experiment.paperCases) {
        cases.push_back({{"scene", item.scene}, {"params", item.params.toJson()}});
    }
    return {{"document", experiment.paperDocument.toJson()}, {"cases", std::move(cases)}};
}

void readPaper(const config::Node& node, config::Experiment& experiment) {
    experiment.paperDocument = requiredMap(node, "document");
    for (const config::Node& item : required(node, "cases").items()) {
        experiment.paperCases.push_back(
            {required(item, "scene").text(), requiredMap(item, "params")});
    }
}

std::vector<std::string> textsFrom(const config::Node& list) {
    std::vector<std::string> texts;
    for (const config::Node& item : list.items()) texts.push_back(item.text());
    return texts;
}

}  // namespace

std::string Case::title() const {
    std::string title = experiment;
    if (!axes.isMap()) return title;
    for (const auto& [name, value] : axes.entries()) {
        title += ' ' + name + '=' + (value.isScalar() ? value.text() : value.toFlowText());
    }
    if (!standsFor.isNull()) title += " (" + scene.text() + ")";
    return title;
}

std::string Case::slug() const {
    std::string slug = experiment;
    std::replace(slug.begin(), slug.end(), '/', '-');
    return slug;
}

std::string Case::method() const {
    const config::Node* method = params.find("method");
    return method ? method->text() : "";
}

Json Case::recordedParams() const {
    Json json = params.toJson();
    json["output"] = {{"width", outputWidthPx}, {"height", outputHeightPx}};
    addSceneTo(json);
    return json;
}

void Case::addSceneTo(Json& json) const {
    if (!standsFor.isNull()) json[report::kStandsFor] = standsFor.toJson();
    if (sceneSample) json[report::kSceneSample] = *sceneSample;
}

Json Case::toJson() const {
    Json json = {{"id", id},
                 {"experiment", experiment},
                 {"technique", technique},
                 {"scene", scene.toJson()},
                 {"given", given.toJson()},
                 {"params", params.toJson()},
                 {"axes", axes.toJson()},
                 {"output", {outputWidthPx, outputHeightPx}},
                 {"measure", batch::toJson(measure)},
                 {"seed", std::to_string(seed)}};
    if (!offered.isNull()) json["offered"] = offered.toJson();
    addSceneTo(json);
    return json;
}

Case Case::fromJson(const config::Node& node) {
    const config::Node::Sequence& output = required(node, "output").items();
    if (output.size() != 2) throw Error(node.location(), "'output' is not [width, height]");
    Case item;
    item.id = requiredId(node);
    item.experiment = required(node, "experiment").text();
    item.technique = required(node, "technique").text();
    item.scene = required(node, "scene");
    item.given = requiredMap(node, "given");
    item.params = requiredMap(node, "params");
    item.axes = requiredMap(node, "axes");
    item.outputWidthPx = static_cast<int>(output[0].asInteger());
    item.outputHeightPx = static_cast<int>(output[1].asInteger());
    item.measure = measureFrom(required(node, "measure"));
    item.seed = requiredSeed(node);
    if (const config::Node* offered = node.find("offered")) item.offered = *offered;
    if (const config::Node* name = node.find(report::kStandsFor)) item.standsFor = *name;
    if (const config::Node* sample = node.find(report::kSceneSample)) {
        item.sceneSample = static_cast<int>(sample->asInteger());
    }
    return item;
}

std::string Shard::name() const {
    return std::to_string(index) + '/' + std::to_string(count);
}

bool Plan::measures(const Case& item) const {
    return !shard || shard->caseIds.contains(item.id);
}

Json Plan::toJson() const {
    Json json = {{"schema", kPlanSchema},
                 {"hash", hash},
                 {"build", buildId},
                 {"profile", profile},
                 {"device_class", deviceClass},
                 {"seed", std::to_string(seed)},
                 {"request",
                  {{"configs", request.configs},
                   {"sets", request.sets},
                   {"sweeps", request.sweeps},
                   {"only", request.only},
                   {"device", request.device}}},
                 {"scenes", Json::object()},
                 {"experiments", Json::array()},
                 {"cases", Json::array()}};
    for (const auto& [reference, key] : sceneKeys) json["scenes"][reference] = key;
    for (const config::Experiment& experiment : experiments) {
        json["experiments"].push_back({{"file", experiment.file.string()},
                                       {"document", experiment.document.toJson()},
                                       {"assumed", assumedJson(experiment)}});
        if (!experiment.paperCases.empty()) {
            json["experiments"].back()["paper"] = paperToJson(experiment);
        }
    }
    for (const Case& item : cases) json["cases"].push_back(item.toJson());
    if (shard) {
        json["shard"] = {
            {"index", shard->index}, {"count", shard->count}, {"cases", shard->caseIds}};
    }
    return json;
}

Plan Plan::fromJsonFile(const fs::path& path) {
    const config::Node node = config::parseJsonFile(path);
    if (required(node, "schema").asInteger() != kPlanSchema) {
        throw Error(path.string() + ": schema " + required(node, "schema").text() +
                    "; this program reads schema " + std::to_string(kPlanSchema));
    }
    Plan plan;
    plan.hash = required(node, "hash").text();
    plan.buildId = required(node, "build").text();
    plan.profile = required(node, "profile").text();
    plan.deviceClass = required(node, "device_class").text();
    plan.seed = requiredSeed(node);
    const config::Node& request = required(node, "request");
    plan.request = {textsFrom(required(request, "configs")),
                    textsFrom(required(request, "sets")),
                    textsFrom(required(request, "sweeps")),
                    {},
                    required(request, "device").text()};
    if (const config::Node* only = request.find("only")) plan.request.only = textsFrom(*only);
    for (const auto& [reference, key] : required(node, "scenes").entries()) {
        plan.sceneKeys[reference] = key.text();
    }
    for (const config::Node& item : required(node, "experiments").items()) {
        plan.experiments.push_back(config::experimentFromDocument(
            requiredMap(item, "document"), fs::path(required(item, "file").text())));
        if (const config::Node* assumed = item.find("assumed")) {
            takeAssumed(*assumed, plan.experiments.back());
        }
        if (const config::Node* paper = item.find("paper")) {  // older plans have none
            readPaper(*paper, plan.experiments.back());
        }
    }
    for (const config::Node& item : required(node, "cases").items()) {
        plan.cases.push_back(Case::fromJson(item));
    }
    if (const config::Node* shard = node.find("shard")) {
        plan.shard = Shard{requiredInt(*shard, "index"), requiredInt(*shard, "count")};
        for (const std::string& id : textsFrom(required(*shard, "cases"))) {
            plan.shard->caseIds.insert(id);
        }
    }
    return plan;
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
        experiment.paperCases = resolvePaperCases(experiment, catalog, techniques);
    }
    std::set<std::string> experimentIds;
    std::set<std::string> caseIds;
    for (config::Experiment& experiment : plan.experiments) {
        if (!experimentIds.insert(experiment.id).second) {
            throw Error(experiment.file.string() + ": the experiment '" + experiment.id +
                        "' is given twice");
        }
        std::vector<Case> cases = resolveCases(experiment, catalog, techniques, seed);
        bindAssumptions(experiment, cases, catalog, techniques);
        for (Case& item : cases) {
            std::string sceneKey;
            if (!item.scene.isNull()) {
                std::string& known = plan.sceneKeys[item.scene.text()];
                if (known.empty()) known = catalog.contentKey(item.scene);
                sceneKey = known;
            }
            item.id = contentId(item, sceneKey, plan);
            if (!caseIds.insert(item.id).second) {
                throw Error(experiment.file.string() + ": the sweep gives the case '" +
                            item.title() + "' twice");
            }
            plan.cases.push_back(std::move(item));
        }
    }
    plan.hash = hashOf(plan);
    return plan;
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
        if (catalog.contentKey(config::Node::scalar(reference)) != key) {
            return "the scene '" + reference + "' changed";
        }
    }
    for (const Case& item : plan.cases) {
        Case planned = item;
        planned.id.clear();
        const auto scene =
            item.scene.isNull() ? plan.sceneKeys.end() : plan.sceneKeys.find(item.scene.text());
        const std::string key = scene == plan.sceneKeys.end() ? "" : scene->second;
        if (contentId(planned, key, plan) != item.id) {
            return "the case " + item.id + ", " + item.title() +
                   ", is not the one that was planned: plan.json was changed";
        }
    }
    return "";
}

std::string planDifference(const Plan& then, const Plan& now) {
    if (then.hash == now.hash) return "";
    if (then.buildId != now.buildId) {
        return "the program or a shader changed (build " + then.buildId.substr(0, 12) + " then, " +
               now.buildId.substr(0, 12) + " now)";
    }
    if (then.deviceClass != now.deviceClass) {
        return "the run began on a " + then.deviceClass + " device, this one is a " +
               now.deviceClass + " device";
    }
    for (const auto& [reference, key] : then.sceneKeys) {
        const auto found = now.sceneKeys.find(reference);
        if (found != now.sceneKeys.end() && found->second != key) {
            return "the scene '" + reference + "' changed";
        }
    }
    for (std::size_t i = 0; i < std::min(then.experiments.size(), now.experiments.size()); ++i) {
        const config::Experiment& before = then.experiments[i];
        if (before.document.toJson() != now.experiments[i].document.toJson()) {
            return "the config " + before.file.string() + " changed";
        }
    }
    return "the experiments are not the same";
}

std::string programBuildId() {
    std::vector<fs::path> files;
    const fs::path shaders = dataFolder("shaders");
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(shaders)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::string content = sha256OfFile("/proc/self/exe");
    for (const fs::path& file : files) {
        content += '\n' + fs::relative(file, shaders).string() + ' ' + sha256OfFile(file);
    }
    return sha256(content);
}

}  // namespace gfxrepro::batch
