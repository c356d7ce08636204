#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {

config::Case makeCase(const std::string& experiment, const std::string& method, int size,
                      config::Measure::Lane lane) {
    config::Case item;
    item.experiment = experiment;
    item.technique = "mock";
    item.params = Node::map({});
    item.params.set("method", Node::scalar(method));
    item.params.set("size", Node::number(size));
    item.axes = item.params;
    item.outputWidthPx = item.outputHeightPx = 8;
    item.measure.lane = lane;
    item.id = experiment + ' ' + method + ' ' + std::to_string(size);
    return item;
}

cluster::PastCase makePast(const config::Case& item, double renderS) {
    return {item, {0.0, 0.0, renderS, 0.0, 1 << 20}};
}

records::Record makeRow(const config::Case& item, double value, int process) {
    return records::Record{
        .caseId = item.id,
        .table = item.experiment,
        .process = process,
        .lane = item.measure.lane == config::Measure::Lane::Timing ? "timing" : "quality",
        .metric = "number",
        .value = value};
}

cluster::ShardRun makeShard(const run::Plan& plan, int index, int count,
                            const std::vector<std::size_t>& cases, const std::string& renderer) {
    cluster::ShardRun shard{.path = "s" + std::to_string(index)};
    shard.run.plan = plan;
    shard.run.plan.shard = run::Shard{index, count, {}};
    shard.run.plan.cases.clear();
    shard.run.manifest = {{"cpu", "CPU"},
                          {"cores", 2},
                          {"gl", {{"vendor", "V"}, {"renderer", renderer}, {"version", "4.5"}}},
                          {"scenes", run::Json::object()},
                          {"invocations", run::Json::array()}};
    for (const std::size_t i : cases) {
        shard.run.plan.cases.push_back(plan.cases[i]);
        shard.run.records.push_back(makeRow(plan.cases[i], static_cast<double>(i)));
    }
    return shard;
}

}  // namespace gfxrepro::test
