#include "runner/regression/series.h"

#include <fmt/format.h>

#include <set>

#include "runner/metrics/statistics.h"

namespace gfxrepro::regression {

namespace {

/// Repeats by frame.
using Frames = std::map<int, std::vector<double>>;

double meanOfMedians(const Frames& frames) {
    double sum = 0.0;
    for (const auto& [frame, repeats] : frames) {
        sum += metrics::summarize(repeats, metrics::Statistic::Median);
    }
    return sum / static_cast<double>(frames.size());
}

}  // namespace

std::string SeriesKey::title() const {
    std::string text = fmt::format("{} {}", table, technique);
    for (const std::string* part : {&method, &scene}) {
        if (!part->empty()) text += fmt::format(" {}", *part);
    }
    text += fmt::format(" {}", metric);
    if (!pass.empty()) text += fmt::format("/{}", pass);
    return text;
}

namespace {
/// Memory of the process, and what rounding and the order of parallel work change.
bool isOfTheMachine(const std::string& metric) {
    return metric == "peak_memory_bytes" || metric == "baseline_memory_bytes" ||
           metric == "image_digest" || metric == "fragments";
}
}  // namespace

SeriesMap seriesOf(const std::vector<report::Record>& records) {
    std::map<SeriesKey, std::map<int, Frames>> gathered;
    for (const report::Record& record : records) {
        if (record.status != report::Status::Ok || record.isControl()) continue;
        const SeriesKey key{record.table,  record.technique, record.method, record.scene,
                            record.params, record.pass,      record.metric, record.unit};
        if ((key.isTime() || key.isRate()) && record.lane != "timing") continue;
        if (isOfTheMachine(record.metric)) continue;
        gathered[key][record.process][record.frame].push_back(record.value);
    }
    SeriesMap series;
    for (const auto& [key, processes] : gathered) {
        for (const auto& [process, frames] : processes) {
            series[key].push_back(meanOfMedians(frames));
        }
    }
    return series;
}

void append(SeriesMap& series, const SeriesMap& more) {
    for (const auto& [key, values] : more) {
        Series& own = series[key];
        own.insert(own.end(), values.begin(), values.end());
    }
}

}  // namespace gfxrepro::regression
