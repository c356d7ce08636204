#include "tests/unit/tables/fixture.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/support.h"

namespace gfxrepro::tables {

config::Experiment experimentFrom(const std::string& body) {
    const TemporaryFolder folder;
    const auto file = folder.write(
        "table-9.9.yaml", "table: zju2005/9.9\ntitle: A table\ntechnique: voxelization\n" + body);
    return config::loadExperiment(file, {}, folder.path());
}

namespace {

/// The case whose records say this scene and these parameters.
config::Case caseOf(const std::string& experiment, const std::string& scene, Node params) {
    config::Case item;
    item.experiment = experiment;
    if (!scene.empty()) item.scene = Node::scalar(scene);
    item.axes = Node::map({});
    if (const Node* name = params.find(config::kStandsFor)) item.standsFor = *name;
    if (const Node* sample = params.find(config::kSceneSample)) {
        item.sceneSample = static_cast<int>(sample->asInteger());
    }
    if (const Node* output = params.find("output")) {
        item.outputWidthPx = static_cast<int>(output->find("width")->asInteger());
        item.outputHeightPx = static_cast<int>(output->find("height")->asInteger());
    }
    for (const char* name : {config::kStandsFor, config::kSceneSample, "output"})
        params.erase(name);
    item.params = std::move(params);
    return item;
}

}  // namespace

config::Experiment withPaperCases(
    config::Experiment experiment,
    std::initializer_list<std::pair<const char*, const char*>> cases) {
    for (const auto& [scene, params] : cases) {
        experiment.paperCases.push_back(caseOf(experiment.id, scene, parseYaml(params, "a case")));
    }
    return experiment;
}

namespace {

/// Whether the recorded case lies at that point of the sweep: what both name is the same.
bool isAt(const config::Case& recorded, const config::Case& point) {
    const std::string scene =
        recorded.standsFor.isNull() ? recorded.recordedScene() : recorded.standsFor.text();
    if (recorded.experiment != point.experiment) return false;
    if (!point.scene.isNull() && scene != point.scene.text()) return false;
    for (const auto& [name, value] : point.given.entries()) {
        const Node* own = recorded.params.find(name);
        if (own && !own->sameContent(value)) return false;
    }
    return true;
}

}  // namespace

std::vector<config::Case> planOf(const config::Experiment& experiment, const Recorded& records) {
    std::vector<config::Case> planned;
    std::set<std::string> placed;
    for (config::Case& point : config::expandCases(experiment)) {
        bool isRecorded = false;
        for (const config::Case& item : records.cases) {
            if (!isAt(item, point)) continue;
            isRecorded = true;
            if (!placed.insert(item.id).second) continue;
            planned.push_back(item);
            planned.back().axes = point.axes;
        }
        if (isRecorded) continue;
        for (const auto& [name, value] : point.given.entries()) point.params.set(name, value);
        planned.push_back(std::move(point));
    }
    for (const config::Case& item : records.cases) {
        if (placed.insert(item.id).second) planned.push_back(item);
    }
    return planned;
}

Table buildTable(const config::Experiment& experiment, const Recorded& records) {
    return buildTable(experiment, planOf(experiment, records), records);
}

std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               const Recorded& records) {
    std::vector<Table> tables;
    for (const config::Experiment& experiment : experiments) {
        tables.push_back(buildTable(experiment, records));
    }
    return tables;
}

RecordMaker& RecordMaker::beginCase(const std::string& scene, const std::string& params) {
    current_ = records::Record{};
    current_.caseId = "case:" + scene + params;
    current_.table = table_;
    current_.technique = "voxelization";
    const auto json = nlohmann::ordered_json::parse(params);
    if (json.contains("method")) current_.method = json["method"].get<std::string>();
    current_.scene = scene;
    records_.cases.push_back(caseOf(current_.table, scene, nodeFromJson(json)));
    records_.cases.back().id = current_.caseId;
    current_.lane = "timing";
    return *this;
}

RecordMaker& RecordMaker::seeds(config::Measure::Seeds seeds) {
    records_.cases.back().measure.seeds = seeds;
    return *this;
}

RecordMaker& RecordMaker::process(int process) {
    current_.process = process;
    return *this;
}

RecordMaker& RecordMaker::frame(int frame) {
    current_.frame = frame;
    return *this;
}

RecordMaker& RecordMaker::lane(const std::string& lane) {
    current_.lane = lane;
    return *this;
}

RecordMaker& RecordMaker::add(const std::string& metric, std::initializer_list<double> repeats,
                              const std::string& pass, const std::string& unit) {
    return add(metric, std::vector<double>(repeats), pass, unit);
}

RecordMaker& RecordMaker::add(const std::string& metric, const std::vector<double>& repeats,
                              const std::string& pass, const std::string& unit) {
    for (std::size_t i = 0; i < repeats.size(); ++i) {
        records::Record record = current_;
        record.metric = metric;
        record.pass = pass;
        record.unit = unit;
        record.repeat = current_.frame == records::kSetup ? records::kSetup : static_cast<int>(i);
        record.value = repeats[i];
        records_.push_back(record);
    }
    return *this;
}

RecordMaker& RecordMaker::fail(records::Status status, const std::string& message) {
    records::Record record = current_;
    record.value = std::numeric_limits<double>::quiet_NaN();
    record.status = status;
    record.message = message;
    records_.push_back(record);
    return *this;
}

}  // namespace gfxrepro::tables
