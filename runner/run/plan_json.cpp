#include "runner/run/plan_json.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/json_shape.h"
#include "engine/core/output_files.h"
#include "engine/scene/scene_reference.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

constexpr int kPlanSchema = 1;
/// Digits alone would be a number to who reads tables: 46e288818872 is one that is beyond all.
constexpr std::string_view kIdLetter = "c";
constexpr const char* kFrozenHash = "/frozen_hash";

constexpr JsonMember kPlan[] = {
    {"/schema", JsonKind::Int},         {"/hash", JsonKind::Text},
    {"/build", JsonKind::Text},         {"/profile", JsonKind::Text},
    {"/device_class", JsonKind::Text},  {"/seed", JsonKind::Text},
    {"/request", JsonKind::Object},     {"/request/configs", JsonKind::Texts},
    {"/request/sets", JsonKind::Texts}, {"/request/sweeps", JsonKind::Texts},
    {"/request/only", JsonKind::Texts}, {"/request/device", JsonKind::Text},
    {"/scenes", JsonKind::Texts},       {"/experiments", JsonKind::Objects},
    {"/cases", JsonKind::List},         {"/cases", JsonKind::Objects},
    {kFrozenHash, JsonKind::Text},      {"/shard", JsonKind::Object, false}};
constexpr JsonMember kExperiment[] = {{"/file", JsonKind::Text},
                                      {"/document", JsonKind::Object},
                                      {"/assumed", JsonKind::Objects},
                                      {"/paper", JsonKind::Object, false},
                                      {"/metrics", JsonKind::Objects, false}};
constexpr JsonMember kAssumed[] = {{"/value", JsonKind::Text}, {"/unit", JsonKind::Text}};
constexpr JsonMember kPaper[] = {{"/document", JsonKind::Object}, {"/cases", JsonKind::Objects}};
constexpr JsonMember kPaperCase[] = {{"/scene", JsonKind::Text},
                                     {"/params", JsonKind::Object},
                                     {"/params/output/width", JsonKind::Int},
                                     {"/params/output/height", JsonKind::Int}};
constexpr JsonMember kMetric[] = {{"/name", JsonKind::Text},
                                  {"/unit", JsonKind::Text},
                                  {"/doc", JsonKind::Text},
                                  {"/better", JsonKind::Text},
                                  {"/detail", JsonKind::Boolean}};
constexpr JsonMember kShard[] = {{"/index", JsonKind::Int},
                                 {"/count", JsonKind::Int},
                                 {"/whole", JsonKind::Text},
                                 {"/device", JsonKind::Text}};
constexpr JsonMember kCase[] = {{"/id", JsonKind::Text},
                                {"/experiment", JsonKind::Text},
                                {"/technique", JsonKind::Text},
                                {"/given", JsonKind::Object},
                                {"/params", JsonKind::Object},
                                {"/axes", JsonKind::Object},
                                {"/output", JsonKind::List},
                                {"/output/0", JsonKind::Int},
                                {"/output/1", JsonKind::Int},
                                {"/measure", JsonKind::Object},
                                {"/seed", JsonKind::Text},
                                {"/program_key", JsonKind::Text, false},
                                {"/scene_sample", JsonKind::Int, false}};

/// What a plan has of `measure` in numbers, each key once.
template <class Measure, class Each>
void eachNumber(Measure& measure, Each each) {
    each("/repeats", measure.repeats);
    each("/processes", measure.processes);
    each("/time_budget_s", measure.timeBudgetS);
    each("/frames", measure.frames);
    each("/time_limit_s", measure.timeLimitS);
}

std::vector<JsonMember> measureMembers() {
    std::vector<JsonMember> members = {{"/lane", JsonKind::Text},
                                       {"/within_budget", JsonKind::Boolean, false},
                                       {"/seeds", JsonKind::Text, false}};
    config::Measure measure;
    eachNumber(measure, [&](const char* place, auto value) {
        members.push_back(
            {place, std::is_same_v<decltype(value), int> ? JsonKind::Int : JsonKind::Number});
    });
    return members;
}

Json measureJson(const config::Measure& measure) {
    Json json = {{"lane", measure.lane == config::Measure::Lane::Timing ? "timing" : "quality"}};
    eachNumber(measure,
               [&](const char* place, auto value) { json[Json::json_pointer(place)] = value; });
    if (measure.isWithinBudget) json["within_budget"] = true;
    using Seeds = config::Measure::Seeds;
    if (measure.seeds != Seeds::None) {
        json["seeds"] = measure.seeds == Seeds::Process ? "process" : "case";
    }
    return json;
}

config::Measure measureFrom(const Json& json) {
    config::Measure measure;
    measure.lane = json.at("lane") == "timing" ? config::Measure::Lane::Timing
                                               : config::Measure::Lane::Quality;
    eachNumber(measure, [&](const char* place, auto& value) {
        json.at(Json::json_pointer(place)).get_to(value);
    });
    measure.isWithinBudget = json.value("within_budget", false);
    const std::string seeds = json.value("seeds", "");
    if (!seeds.empty()) {
        measure.seeds =
            seeds == "process" ? config::Measure::Seeds::Process : config::Measure::Seeds::Case;
    }
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

Json paperToJson(const config::Experiment& experiment) {
    Json cases = Json::array();
    for (const Case& item : experiment.paperCases) {
        cases.push_back(
            {{"scene", item.recordedScene()}, {"params", item.recordedParams().toJson()}});
    }
    return {{"document", experiment.paperDocument.toJson()}, {"cases", std::move(cases)}};
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

/// The experiments of a plan, read one after another.
class ExperimentReader {
  public:
    ExperimentReader(const Json& json, const SourceLocation& where, std::string prefix)
        : json_(json), where_(where), prefix_(std::move(prefix)) {
        requireMembers(json, kExperiment, where, prefix_);
        requireEach(json, "/assumed", kAssumed, where, prefix_);
        requireEach(json, "/metrics", kMetric, where, prefix_);
    }

    config::Experiment unread() const {
        config::Experiment experiment;
        experiment.file = json_.at("file").get<std::string>();
        experiment.document = nodeFromJson(json_.at("document"), where_);
        return experiment;
    }

    config::Experiment read() const {
        config::Experiment experiment = config::experimentFromDocument(
            nodeFromJson(json_.at("document"), where_), json_.at("file").get<std::string>());
        takeAssumed(experiment);
        if (json_.contains("paper")) takePaper(json_.at("paper"), experiment);
        if (json_.contains("metrics")) takeOutputs(json_.at("metrics"), experiment.outputs);
        return experiment;
    }

  private:
    void takeAssumed(config::Experiment& experiment) const {
        const Json& assumed = json_.at("assumed");
        for (config::Assumption& assumption : experiment.assumptions) {
            const auto bound = assumed.find(assumption.name);
            if (bound == assumed.end()) continue;
            assumption.isBound = true;
            assumption.value = nodeFromJson(bound->at("value"), where_);
            bound->at("unit").get_to(assumption.unit);
        }
    }

    void takePaper(const Json& paper, config::Experiment& experiment) const {
        requireMembers(paper, kPaper, where_, prefix_ + "/paper");
        requireEach(paper, "/cases", kPaperCase, where_, prefix_ + "/paper");
        experiment.paperDocument = nodeFromJson(paper.at("document"), where_);
        for (const Json& json : paper.at("cases")) {
            Case& item = experiment.paperCases.emplace_back();
            item.experiment = experiment.id;
            if (const auto scene = json.at("scene").get<std::string>(); !scene.empty()) {
                item.scene = Node::scalar(scene);
            }
            item.axes = Node::map({});
            item.params = nodeFromJson(json.at("params"), where_);
            json.at("params").at("output").at("width").get_to(item.outputWidthPx);
            json.at("params").at("output").at("height").get_to(item.outputHeightPx);
            item.params.erase("output");
        }
    }

    static void takeOutputs(const Json& metrics, config::Outputs& outputs) {
        for (const Json& json : metrics) {
            config::MetricInfo info{json.at("name"), json.at("unit"), json.at("doc")};
            for (const config::Better better : {config::Better::Lower, config::Better::Higher}) {
                if (json.at("better") == config::betterText(better)) info.better = better;
            }
            json.at("detail").get_to(info.isDetail);
            outputs.metrics.push_back(std::move(info));
        }
    }

    const Json& json_;
    const SourceLocation& where_;
    std::string prefix_;
};

[[noreturn]] void failAsChanged(const SourceLocation& where, const std::string& what) {
    const std::string name = fs::path(std::string(where.file)).filename().string();
    throw Error(where, what + " planned: " + name + " was changed");
}

/// Takes the cases out of `json`. Throws Error for one that is not as it was written.
void requireCases(const SourceLocation& where, Json& json, const Plan& plan) {
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        const Case& item = plan.cases[i];
        const std::string id = caseId(item, std::move(json.at("cases").at(i)), plan);
        // Runs of before ids had a letter are read, too.
        if (item.id == id || item.id == id.substr(kIdLetter.size())) continue;
        failAsChanged(where,
                      "the case " + item.id + ", " + item.title() + ", is not the one that was");
    }
}

/// Throws Error where anything else is not. (The plan's own hash has neither assumptions nor
/// published parameters, and with --only or of a shard it is that of all cases, which the plan does
/// not have.)
void requireFrozen(const SourceLocation& where, Json json, const Plan& plan) {
    const Json::json_pointer frozen(kFrozenHash);
    const auto hash = json.at(frozen).get<std::string>();
    json.erase(frozen.back());
    json.erase("cases");
    if (frozenHash(json, plan.cases) == hash) return;
    failAsChanged(where, "the experiments, their cases or the profile are not those that were");
}

std::vector<std::string> textsFrom(const Json& list) {
    std::vector<std::string> texts;
    for (const Json& text : list) texts.push_back(text.get<std::string>());
    return texts;
}

/// Of what is no number 0: the hashes tell that.
std::uint64_t seedFrom(const Json& text) {
    const auto& digits = text.get_ref<const std::string&>();
    std::uint64_t seed = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), seed);
    return seed;
}

}  // namespace

std::map<std::string, Node> scenesOf(const Case& item) {
    std::map<std::string, Node> scenes;
    if (!item.scene.isNull()) scenes.emplace("scene", item.scene);
    for (const auto& [name, value] : item.params.entries()) {
        if (name == "scene" || !scene::isSceneKey(name) || !value.isScalar()) continue;
        if (!value.text().empty()) scenes.emplace(name, value);
    }
    return scenes;
}

std::string caseId(const Case& item, Json written, const Plan& plan) {
    written["id"] = "";
    written["scene"] = "";
    for (const auto& [name, reference] : scenesOf(item)) {
        const auto scene = plan.sceneKeys.find(reference.text());
        if (scene != plan.sceneKeys.end()) written[name] = scene->second;
    }
    if (written.contains("program")) written["program"].erase(config::placeholder::kHere);
    written["device_class"] = plan.deviceClass;
    written["build"] = plan.buildId;
    return std::string(kIdLetter) + sha256(written.dump()).substr(0, 12);
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

Case caseFromJson(const Json& json, const SourceLocation& where, const std::string& prefix) {
    requireMembers(json, kCase, where, prefix);
    requireMembers(json.at("measure"), measureMembers(), where, prefix + "/measure");
    const auto node = [&](const char* key) {
        const auto found = json.find(key);
        return found == json.end() ? Node() : nodeFromJson(*found, where);
    };
    Case item;
    json.at("id").get_to(item.id);
    json.at("experiment").get_to(item.experiment);
    json.at("technique").get_to(item.technique);
    item.scene = node("scene");
    item.given = node("given");
    item.params = node("params");
    item.axes = node("axes");
    json.at("output").at(0).get_to(item.outputWidthPx);
    json.at("output").at(1).get_to(item.outputHeightPx);
    item.measure = measureFrom(json.at("measure"));
    item.seed = seedFrom(json.at("seed"));
    item.offered = node("offered");
    item.program = node("program");
    item.programKey = json.value("program_key", "");
    item.standsFor = node(config::kStandsFor);
    if (const auto sample = json.find(config::kSceneSample); sample != json.end()) {
        item.sceneSample = sample->get<int>();
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
        json["shard"] = {{"index", shard->index},
                         {"count", shard->count},
                         {"whole", shard->whole},
                         {"device", shard->device}};
    }
    json[Json::json_pointer(kFrozenHash)] = frozenHash(json, cases);
    std::string text = json.dump(1);
    text.resize(text.size() - 2);  // "\n}"
    to(text + ",\n \"cases\": [");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        to(fmt::format("{}\n  {}", i == 0 ? "" : ",", toJson(cases[i]).dump()));
    }
    to("\n ]\n}\n");
}

void Plan::writeFile(const fs::path& path, std::uintmax_t mostBytes) const {
    AtomicFile file(path);
    std::uintmax_t bytes = 0;
    write([&](std::string_view text) {
        file.write(text);
        bytes += text.size();
    });
    requirePlanBytes(*this, bytes, mostBytes);
    file.commit();
}

std::uintmax_t planBytes(const Plan& plan) {
    std::uintmax_t bytes = 0;
    plan.write([&](std::string_view text) { bytes += text.size(); });
    return bytes;
}

void requirePlanBytes(const Plan& plan, std::uintmax_t bytes, std::uintmax_t mostBytes) {
    if (bytes <= mostBytes) return;
    const std::size_t others = plan.experiments.size() - 1;
    throw Error(
        fmt::format("{}{}: plan.json would have {} bytes; at most {} are read. Measure it "
                    "in parts (--only)",
                    plan.experiments.front().file.string(),
                    others == 0 ? "" : fmt::format(" and {} more", others), bytes, mostBytes));
}

namespace {

/// All of a plan but its experiments and cases.
Plan headFrom(const Json& json, const SourceLocation& where) {
    requireMembers(json, kPlan, where);
    if (json.at("schema") != kPlanSchema) {
        throw Error(where, fmt::format("schema {}; this program reads schema {}",
                                       json.at("schema").get<int>(), kPlanSchema));
    }
    Plan plan;
    json.at("hash").get_to(plan.hash);
    json.at("build").get_to(plan.buildId);
    json.at("profile").get_to(plan.profile);
    json.at("device_class").get_to(plan.deviceClass);
    plan.seed = seedFrom(json.at("seed"));
    const Json& request = json.at("request");
    plan.request = {textsFrom(request.at("configs")), textsFrom(request.at("sets")),
                    textsFrom(request.at("sweeps")), textsFrom(request.at("only")),
                    request.at("device")};
    for (const auto& [reference, key] : json.at("scenes").items()) {
        plan.sceneKeys[reference] = key.get<std::string>();
    }
    if (const auto shard = json.find("shard"); shard != json.end()) {
        requireMembers(*shard, kShard, where, "/shard");
        plan.shard =
            Shard{shard->at("index"), shard->at("count"), shard->at("whole"), shard->at("device")};
    }
    return plan;
}

/// The cases, and that all is as it was written.
void takeCases(Json json, const SourceLocation& where, Plan& plan) {
    for (const auto& [place, item] : json.at("cases").items()) {
        plan.cases.push_back(caseFromJson(item, where, "/cases/" + place));
    }
    if (plan.cases.size() > kMostCases) {
        throw Error(where,
                    fmt::format("{} cases; at most {} are read", plan.cases.size(), kMostCases));
    }
    requireUnitCount(unitCount(plan.cases), where);
    requireCases(where, json, plan);
    requireFrozen(where, std::move(json), plan);
}

}  // namespace

Plan Plan::fromJsonFile(const fs::path& path) {
    const SourceLocation where{path.string(), 0, 0};
    Json json = parseJsonObject(MappedFile(path).text(), where);
    Plan plan = headFrom(json, where);
    for (const auto& [place, item] : json.at("experiments").items()) {
        plan.experiments.push_back(ExperimentReader(item, where, "/experiments/" + place).read());
    }
    takeCases(std::move(json), where, plan);
    return plan;
}

Plan planWithUnreadExperiments(const fs::path& path) {
    const SourceLocation where{path.string(), 0, 0};
    Json json = parseJsonObject(MappedFile(path).text(), where);
    Plan plan = headFrom(json, where);
    for (const auto& [place, item] : json.at("experiments").items()) {
        plan.experiments.push_back(ExperimentReader(item, where, "/experiments/" + place).unread());
    }
    takeCases(std::move(json), where, plan);
    return plan;
}

}  // namespace gfxrepro::run
