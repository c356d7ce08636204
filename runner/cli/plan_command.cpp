#include <fmt/core.h>

#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/forecast.h"
#include "runner/run/twins.h"

namespace gfxrepro::cli {

namespace {

long long iterationsOf(const config::Measure& measure) {
    return static_cast<long long>(measure.processes) *
           (measure.warmup() + static_cast<long long>(measure.repeats) * measure.frames);
}

/// Time of all processes of a case, its memory, and how they are known. `first` is its first twin.
std::vector<std::string> predictionTexts(const config::Case& item, const config::Case& first,
                                         const cluster::Predictor& predictor) {
    if (&item != &first) return {"-", "-", "as " + first.id};
    const std::optional<cluster::Prediction> known = predictor.predict(item);
    if (!known || !known->isTold) return {"-", "-", "-"};
    std::string source(cluster::sourceName(known->source));
    return {durationText(known->timeS * item.measure.processes),
            memoryText(static_cast<double>(known->memoryBytes)), source};
}

/// A case of the listing.
std::vector<std::string> rowTexts(const config::Case& item, const config::Case& first,
                                  const cluster::Predictor& predictor) {
    const config::Measure& measure = item.measure;
    std::vector<std::string> row = {
        item.id, measure.lane == config::Measure::Lane::Timing ? "timing" : "quality",
        fmt::format("{}x{}", item.outputWidthPx, item.outputHeightPx),
        fmt::format("{}x{}x{}", measure.processes, measure.frames, measure.repeats),
        fmt::format("{:g} s", measure.timeLimitS)};
    for (std::string& text : predictionTexts(item, first, predictor)) {
        row.push_back(std::move(text));
    }
    row.push_back(item.title());
    return row;
}

}  // namespace

int plan(const Context& context, const Chosen& selection, const std::vector<std::string>& from,
         bool asJson) {
    const run::Plan plan = planFor(context, requestOf(selection, findPaperConfigs(selection.names)),
                                   selection.profile, selection.assets, deviceClassFor(selection));
    if (asJson) {
        plan.write([](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); });
        return kExitOk;
    }
    const History history = openHistory(from, plan.deviceClass);
    const std::vector<std::string> head = {"case", "lane",   "output",   "runs", "limit",
                                           "time", "memory", "known by", "title"};
    const std::vector<std::size_t> firsts = run::firstTwins(plan.cases);
    const auto rowOf = [&](std::size_t i) {
        return rowTexts(plan.cases[i], plan.cases[firsts[i]], history.predictor);
    };
    Columns columns;
    columns.fit(head);
    long long iterations = 0;
    std::size_t twins = 0;
    for (std::size_t i = 0; i < firsts.size(); ++i) {
        if (firsts[i] == i) iterations += iterationsOf(plan.cases[i].measure);
        if (firsts[i] != i) ++twins;
        columns.fit(rowOf(i));
    }
    fmt::print("{}", columns.line(head));
    for (std::size_t i = 0; i < firsts.size(); ++i) fmt::print("{}", columns.line(rowOf(i)));
    fmt::print(
        "{} case{}{}, {} iterations, for a {} device; runs are processes x frames x repeats\n",
        plan.cases.size(), plan.cases.size() == 1 ? "" : "s",
        twins > 0 ? fmt::format(" ({} measured as another's twin)", twins) : "", iterations,
        plan.deviceClass);
    const std::string forecast = forecastText(plan, history, 1);
    say("{}\n",
        forecast.empty() ? "no earlier run tells the time; --from RUN names one" : forecast);
    return kExitOk;
}

}  // namespace gfxrepro::cli
