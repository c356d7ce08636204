// What a unit measured, as rows.
#include <limits>

#include "runner/run/scheduler.h"

namespace gfxrepro::run {

std::vector<records::Record> recordsOf(const Unit& unit, const CaseResult& result) {
    const Case& item = *unit.item;
    records::Record row;
    row.caseId = item.id;
    row.table = item.experiment;
    row.technique = item.technique;
    row.method = item.method();
    row.scene = item.recordedScene();
    row.process = unit.process;
    row.lane = item.measure.lane == config::Measure::Lane::Timing ? "timing" : "quality";
    row.status = result.status;
    row.message = result.message;
    if (result.status != records::Status::Ok && result.status != records::Status::Flaky) {
        row.value = std::numeric_limits<double>::quiet_NaN();
        return {row};
    }
    std::vector<records::Record> rows;
    for (const Sample& sample : result.samples) {
        row.frame = sample.frame;
        row.repeat = sample.repeat;
        row.pass = sample.pass;
        row.metric = sample.metric;
        row.unit = sample.unit;
        row.value = sample.value;
        rows.push_back(row);
        if (sample.isVoid) {
            rows.back().status = records::Status::Ambiguous;
            rows.back().message = result.voidReason;
        }
    }
    return rows;
}

}  // namespace gfxrepro::run
