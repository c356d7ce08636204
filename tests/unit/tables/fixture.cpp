#include "tests/unit/tables/fixture.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/support.h"

namespace gfxrepro::tables {

config::Experiment experimentFrom(const std::string& body) {
    const test::TemporaryFolder folder;
    const auto file = folder.write(
        "table-9.9.yaml", "table: zju2005/9.9\ntitle: A table\ntechnique: voxelization\n" + body);
    return config::loadExperiment(file, {}, folder.path());
}

config::Experiment withPaperCases(
    config::Experiment experiment,
    std::initializer_list<std::pair<const char*, const char*>> cases) {
    for (const auto& [scene, params] : cases) {
        experiment.paperCases.push_back({scene, parseYaml(params, "paper case")});
    }
    return experiment;
}

namespace {

/// Whether the recorded case lies at that point of the sweep: what both name is the same.
bool isAt(const PlannedCase& recorded, const PlannedCase& point) {
    const Node* standsFor = recorded.params.find(kStandsFor);
    const std::string scene = standsFor ? standsFor->text() : recorded.scene;
    if (recorded.table != point.table) return false;
    if (!point.scene.empty() && scene != point.scene) return false;
    for (const auto& [name, value] : point.params.entries()) {
        const Node* own = recorded.params.find(name);
        if (own && !own->sameContent(value)) return false;
    }
    return true;
}

}  // namespace

std::vector<PlannedCase> planOf(const config::Experiment& experiment, const Recorded& records) {
    std::vector<PlannedCase> planned;
    std::set<std::string> placed;
    for (const config::CaseSpec& spec : config::expandCases(experiment)) {
        PlannedCase point{
            "", experiment.id, spec.scene.isNull() ? "" : spec.scene.text(), spec.params, {}};
        point.params.setPath("output.width", Node::number(spec.outputWidthPx));
        point.params.setPath("output.height", Node::number(spec.outputHeightPx));
        for (const auto& [axis, value] : spec.axes) point.axes.push_back(axis);
        bool isRecorded = false;
        for (const PlannedCase& item : records.cases) {
            if (!isAt(item, point)) continue;
            isRecorded = true;
            if (!placed.insert(item.id).second) continue;
            planned.push_back(item);
            planned.back().axes = point.axes;
        }
        if (!isRecorded) planned.push_back(std::move(point));
    }
    for (const PlannedCase& item : records.cases) {
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
    current_.table = "zju2005/9.9";
    current_.technique = "voxelization";
    const auto json = nlohmann::json::parse(params);
    if (json.contains("method")) current_.method = json["method"].get<std::string>();
    current_.scene = scene;
    records_.cases.push_back(
        {current_.caseId, current_.table, scene, parseJson(params, "params"), {}});
    current_.lane = "timing";
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
