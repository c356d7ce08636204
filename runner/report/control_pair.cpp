#include "runner/report/control_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "runner/metrics/statistics.h"
#include "runner/report/sampling.h"

namespace gfxrepro::report {

namespace {

constexpr metrics::Statistic kMedian = metrics::Statistic::Median;

struct Pair {
    std::string title;
    Samples sides[2];  // one process each, a unit a frame
};

double largestChange(const Pair& pair) {
    constexpr std::uint64_t kSeed = 1;
    const std::vector<metrics::Statistic> median{kMedian};
    const double ratio = summarize(pair.sides[1], kMedian) / summarize(pair.sides[0], kMedian);
    metrics::Interval interval{ratio, ratio};
    if (pair.sides[0].isRepeated() && pair.sides[1].isRepeated()) {
        const std::vector<double> first = drawSummaries(pair.sides[0], median, kSeed)[0];
        std::vector<double> ratios = drawSummaries(pair.sides[1], median, kSeed + 1)[0];
        for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] /= first[i];
        interval = metrics::centralInterval(std::move(ratios));
    }
    return std::max({std::abs(ratio - 1.0), interval.high - 1.0, 1.0 - interval.low});
}

}  // namespace

std::vector<std::string> controlNotes(const std::vector<Record>& records) {
    std::map<std::string, Pair> pairs;
    for (const Record& record : records) {
        if (!record.isControl() || record.metric != "wall_time_ms") continue;
        if (record.status != Status::Ok && record.status != Status::Flaky) continue;
        Pair& pair = pairs[record.caseId];
        pair.title = record.table;
        if (!record.scene.empty()) pair.title += ' ' + record.scene;
        if (!record.method.empty()) pair.title += ' ' + record.method;
        Samples& side = pair.sides[record.process - kFirstControl];
        side.processes.resize(1);
        side.processes[0][record.frame].push_back(record.value);
    }
    std::vector<std::string> notes;
    for (const auto& [id, pair] : pairs) {
        if (pair.sides[0].processes.empty() || pair.sides[1].processes.empty()) continue;
        notes.push_back(fmt::format(
            "A/A pair at the begin of the run ({}): {:.4g} and {:.4g} ms. Changes of a time below "
            "{:.1f} % cannot be told from none.",
            pair.title, summarize(pair.sides[0], kMedian), summarize(pair.sides[1], kMedian),
            100.0 * largestChange(pair)));
    }
    return notes;
}

}  // namespace gfxrepro::report
