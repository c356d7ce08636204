#include "runner/run/plan_json.h"

#include <fmt/format.h>

#include <charconv>
#include <climits>
#include <nlohmann/json.hpp>

#include "engine/core/hash.h"
#include "engine/core/output_files.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kPlanSchema = 1;
constexpr const char* kFrozenHash = "frozen_hash";

Json measureJson(const config::Measure& measure) {
    Json json = {{"lane", measure.lane == config::Measure::Lane::Timing ? "timing" : "quality"},
                 {"warmup", measure.warmup},
                 {"repeats", measure.repeats},
                 {"processes", measure.processes},
                 {"relative_error", measure.relativeError},
                 {"processes_at_most", measure.processesAtMost},
                 {"time_budget_s", measure.timeBudgetS},
                 {"frames", measure.frames},
                 {"time_limit_s", measure.timeLimitS}};
    if (measure.isWithinBudget) json["within_budget"] = true;
    return json;
}

void requireMap(const Node& node, const char* what) {
    if (node.isMap()) return;
    throw Error(node.location(), std::string(what) + " is not a map but " + node.kindName());
}

const Node& required(const Node& map, const char* key) {
    requireMap(map, ("what should hold '" + std::string(key) + "'").c_str());
    const Node* value = map.find(key);
    if (!value) throw Error(map.location(), "the entry '" + std::string(key) + "' is missing");
    return *value;
}

const Node& requiredMap(const Node& map, const char* key) {
    const Node& value = required(map, key);
    requireMap(value, key);
    return value;
}

std::uint64_t requiredSeed(const Node& map) {
    const Node& node = required(map, "seed");
    const std::string& text = node.text();
    std::uint64_t seed = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (problem != std::errc() || end != text.data() + text.size()) {
        throw Error(node.location(), "the seed '" + text + "' is no number");
    }
    return seed;
}

int intFrom(const Node& node, const char* what, int most = INT_MAX) {
    const auto value = node.tryInteger();
    if (value && *value >= 0 && *value <= most) return static_cast<int>(*value);
    throw Error(node.location(),
                fmt::format("'{}' is {}; expected a whole number from 0 to {}", what,
                            node.isScalar() ? node.text() : node.kindName(), most));
}

int requiredInt(const Node& map, const char* key) {
    return intFrom(required(map, key), key);
}

const std::string& requiredText(const Node& map, const char* key) {
    const Node& node = required(map, key);
    if (node.isScalar()) return node.text();
    throw Error(node.location(), fmt::format("'{}' is {}; expected text", key, node.kindName()));
}

config::Measure measureFrom(const Node& node) {
    config::Measure measure;
    measure.lane = requiredText(node, "lane") == "timing" ? config::Measure::Lane::Timing
                                                          : config::Measure::Lane::Quality;
    measure.warmup = requiredInt(node, "warmup");
    measure.repeats = requiredInt(node, "repeats");
    measure.processes = requiredInt(node, "processes");
    measure.relativeError = required(node, "relative_error").asDouble();
    measure.processesAtMost = requiredInt(node, "processes_at_most");
    measure.timeBudgetS = required(node, "time_budget_s").asDouble();
    measure.frames = requiredInt(node, "frames");
    measure.timeLimitS = required(node, "time_limit_s").asDouble();
    const Node* isWithinBudget = node.find("within_budget");
    measure.isWithinBudget = isWithinBudget && isWithinBudget->asBool();
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

void takeAssumed(const Node& assumed, config::Experiment& experiment) {
    requireMap(assumed, "assumed");
    for (config::Assumption& assumption : experiment.assumptions) {
        const Node* bound = assumed.find(assumption.name);
        if (!bound) continue;
        assumption.isBound = true;
        assumption.value = required(*bound, "value");
        assumption.unit = requiredText(*bound, "unit");
    }
}

Json paperToJson(const config::Experiment& experiment) {
    Json cases = Json::array();
    for (const Case& item : experiment.paperCases) {
        cases.push_back(
            {{"scene", item.recordedScene()}, {"params", item.recordedParams().toJson()}});
    }
    return {{"document", experiment.paperDocument.toJson()}, {"cases", std::move(cases)}};
}

void readPaper(const Node& node, config::Experiment& experiment) {
    experiment.paperDocument = requiredMap(node, "document");
    for (const Node& item : required(node, "cases").items()) {
        Case& paper = experiment.paperCases.emplace_back();
        paper.experiment = experiment.id;
        if (const std::string& scene = requiredText(item, "scene"); !scene.empty()) {
            paper.scene = Node::scalar(scene);
        }
        paper.axes = Node::map({});
        paper.params = requiredMap(item, "params");
        const Node output = requiredMap(paper.params, "output");
        paper.outputWidthPx = requiredInt(output, "width");
        paper.outputHeightPx = requiredInt(output, "height");
        paper.params.erase("output");
    }
}

Json outputsToJson(const config::Outputs& outputs) {
    Json metrics = Json::array();
    for (const config::MetricInfo& info : outputs.metrics) {
        metrics.push_back({{"name", info.name},
                           {"unit", info.unit},
                           {"doc", info.doc},
                           {"better", config::betterText(info.better)},
                           {"detail", info.isDetail}});
    }
    return metrics;
}

config::Outputs outputsFrom(const Node& metrics) {
    config::Outputs outputs;
    for (const Node& item : metrics.items()) {
        config::MetricInfo info{requiredText(item, "name"), requiredText(item, "unit"),
                                requiredText(item, "doc")};
        for (const config::Better better : {config::Better::Lower, config::Better::Higher}) {
            if (requiredText(item, "better") == config::betterText(better)) info.better = better;
        }
        info.isDetail = required(item, "detail").asBool();
        outputs.metrics.push_back(std::move(info));
    }
    return outputs;
}

/// Throws Error for a plan that is not as it was written. (The plan's own hash has neither
/// assumptions nor published parameters, and with --only it is that of all cases, which the plan
/// does not have.)
void requireAsPlanned(const fs::path& path, const Node& node, const Plan& plan) {
    const auto fail = [&](const std::string& what) {
        throw Error(path.string() + ": " + what + " planned: " + path.filename().string() +
                    " was changed");
    };
    const Node::Sequence& cases = required(node, "cases").items();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& item = plan.cases[i];
        if (caseId(item, cases[i].toJson(), plan) == item.id) continue;
        fail("the case " + item.id + ", " + item.title() + ", is not the one that was");
    }
    Json head = Json::object();
    for (const auto& [name, value] : node.entries()) {
        if (name != "cases" && name != kFrozenHash) head[name] = value.toJson();
    }
    if (frozenHash(head, plan.cases) == requiredText(node, kFrozenHash)) return;
    fail("the experiments, their cases or the profile are not those that were");
}

std::vector<std::string> textsFrom(const Node& list) {
    std::vector<std::string> texts;
    for (const Node& item : list.items()) texts.push_back(item.text());
    return texts;
}

}  // namespace

std::string caseId(const Case& item, Json written, const Plan& plan) {
    const auto scene =
        item.scene.isNull() ? plan.sceneKeys.end() : plan.sceneKeys.find(item.scene.text());
    written["id"] = "";
    written["scene"] = scene == plan.sceneKeys.end() ? "" : scene->second;
    if (written.contains("program")) written["program"].erase(config::placeholder::kHere);
    written["device_class"] = plan.deviceClass;
    written["build"] = plan.buildId;
    return sha256(written.dump()).substr(0, 12);
}

std::string planHash(const Plan& plan, const std::vector<Json>& documents) {
    Json content = {{"profile", plan.profile},
                    {"device_class", plan.deviceClass},
                    {"build", plan.buildId},
                    {"seed", plan.seed}};
    for (const Case& item : plan.cases) content["cases"].push_back(item.id);
    for (const Json& document : documents) content["documents"].push_back(document);
    return sha256(content.dump());
}

std::string frozenHash(const Json& head, const std::vector<Case>& cases) {
    Json content = {{"head", head}, {"cases", Json::array()}};
    for (const Case& item : cases) content["cases"].push_back(item.id);
    return sha256(content.dump());
}

Json toJson(const Case& item) {
    Json json = {{"id", item.id},
                 {"experiment", item.experiment},
                 {"technique", item.technique},
                 {"scene", item.scene.toJson()},
                 {"given", item.given.toJson()},
                 {"params", item.params.toJson()},
                 {"axes", item.axes.toJson()},
                 {"output", {item.outputWidthPx, item.outputHeightPx}},
                 {"measure", measureJson(item.measure)},
                 {"seed", std::to_string(item.seed)}};
    if (!item.offered.isNull()) json["offered"] = item.offered.toJson();
    if (!item.program.isNull()) {
        json["program"] = item.program.toJson();
        json["program_key"] = item.programKey;
    }
    if (!item.standsFor.isNull()) json[config::kStandsFor] = item.standsFor.toJson();
    if (item.sceneSample) json[config::kSceneSample] = *item.sceneSample;
    return json;
}

Case caseFromJson(const Node& node) {
    const Node::Sequence& output = required(node, "output").items();
    if (output.size() != 2) throw Error(node.location(), "'output' is not [width, height]");
    Case item;
    item.id = requiredText(node, "id");
    item.experiment = requiredText(node, "experiment");
    item.technique = requiredText(node, "technique");
    item.scene = required(node, "scene");
    item.given = requiredMap(node, "given");
    item.params = requiredMap(node, "params");
    item.axes = requiredMap(node, "axes");
    item.outputWidthPx = intFrom(output[0], "output");
    item.outputHeightPx = intFrom(output[1], "output");
    item.measure = measureFrom(required(node, "measure"));
    item.seed = requiredSeed(node);
    if (const Node* offered = node.find("offered")) item.offered = *offered;
    if (const Node* program = node.find("program")) {
        item.program = *program;
        item.programKey = requiredText(node, "program_key");
    }
    if (const Node* name = node.find(config::kStandsFor)) item.standsFor = *name;
    if (const Node* sample = node.find(config::kSceneSample)) {
        item.sceneSample = intFrom(*sample, config::kSceneSample, config::kMostSceneSample);
    }
    return item;
}

void Plan::write(const std::function<void(std::string_view)>& to) const {
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
                 {"experiments", Json::array()}};
    for (const auto& [reference, key] : sceneKeys) json["scenes"][reference] = key;
    for (const config::Experiment& experiment : experiments) {
        json["experiments"].push_back({{"file", experiment.file.string()},
                                       {"document", experiment.document.toJson()},
                                       {"assumed", assumedJson(experiment)}});
        if (!experiment.paperCases.empty()) {
            json["experiments"].back()["paper"] = paperToJson(experiment);
        }
        if (!experiment.outputs.metrics.empty()) {
            json["experiments"].back()["metrics"] = outputsToJson(experiment.outputs);
        }
    }
    if (shard) {
        json["shard"] = {
            {"index", shard->index}, {"count", shard->count}, {"cases", shard->caseIds}};
    }
    json[kFrozenHash] = frozenHash(json, cases);
    std::string text = json.dump(1);
    text.resize(text.size() - 2);  // "\n}"
    to(text + ",\n \"cases\": [");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        to(fmt::format("{}\n  {}", i == 0 ? "" : ",", toJson(cases[i]).dump()));
    }
    to("\n ]\n}\n");
}

void Plan::writeFile(const fs::path& path) const {
    AtomicFile file(path);
    write([&](std::string_view text) { file.write(text); });
    file.commit();
}

Plan Plan::fromJsonFile(const fs::path& path) {
    const Node node = parseJsonFile(path);
    if (required(node, "schema").asInteger() != kPlanSchema) {
        throw Error(path.string() + ": schema " + requiredText(node, "schema") +
                    "; this program reads schema " + std::to_string(kPlanSchema));
    }
    Plan plan;
    plan.hash = requiredText(node, "hash");
    plan.buildId = requiredText(node, "build");
    plan.profile = requiredText(node, "profile");
    plan.deviceClass = requiredText(node, "device_class");
    plan.seed = requiredSeed(node);
    const Node& request = required(node, "request");
    plan.request = {textsFrom(required(request, "configs")), textsFrom(required(request, "sets")),
                    textsFrom(required(request, "sweeps")), textsFrom(required(request, "only")),
                    requiredText(request, "device")};
    for (const auto& [reference, key] : required(node, "scenes").entries()) {
        plan.sceneKeys[reference] = key.text();
    }
    for (const Node& item : required(node, "experiments").items()) {
        plan.experiments.push_back(config::experimentFromDocument(
            requiredMap(item, "document"), fs::path(requiredText(item, "file"))));
        takeAssumed(required(item, "assumed"), plan.experiments.back());
        if (const Node* paper = item.find("paper")) {
            readPaper(*paper, plan.experiments.back());
        }
        if (const Node* metrics = item.find("metrics")) {
            plan.experiments.back().outputs = outputsFrom(*metrics);
        }
    }
    for (const Node& item : required(node, "cases").items()) {
        plan.cases.push_back(caseFromJson(item));
    }
    if (const Node* shard = node.find("shard")) {
        plan.shard = Shard{requiredInt(*shard, "index"), requiredInt(*shard, "count")};
        for (const std::string& id : textsFrom(required(*shard, "cases"))) {
            plan.shard->caseIds.insert(id);
        }
    }
    requireAsPlanned(path, node, plan);
    return plan;
}

}  // namespace gfxrepro::run
