#include "runner/cli/forecast.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/text.h"
#include "runner/run/twins.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kRunsLookedAt = 5;

/// The rounds of a table's times: those beyond the least asked for only within the budget.
struct TimedRounds {
    const config::Measure* measure = nullptr;
    double roundS = 0.0;

    double totalS() const {
        int rounds = measure->certainRounds();
        while (rounds < measure->processes && measure->mayFollow(rounds, roundS)) ++rounds;
        return roundS * rounds;
    }
};

/// The newest runs that can be read.
History newestHistory(const std::string& deviceClass) {
    std::vector<cluster::PastCase> past;
    std::vector<std::string> sources;
    for (const fs::path& run : cluster::newestRuns("runs", deviceClass, kRunsLookedAt)) {
        // An old run of another version must not stop a new one: what cannot be read tells nothing.
        try {
            std::vector<cluster::PastCase> more = cluster::readPastCases(run);
            if (more.empty()) continue;
            std::ranges::move(more, std::back_inserter(past));
            sources.push_back(run.string());
        } catch (const std::exception&) {
        }
    }
    return {cluster::Predictor(std::move(past)), std::move(sources)};
}

}  // namespace

History openHistory(const std::vector<std::string>& from, const std::string& deviceClass) {
    if (from.empty()) return newestHistory(deviceClass);
    return {cluster::Predictor::from({from.begin(), from.end()}), from};
}

std::string durationText(double timeS) {
    if (timeS < 0.9995) return fmt::format("{:.0f} ms", 1e3 * timeS);
    if (timeS < 9.95) return fmt::format("{:.1f} s", timeS);
    const auto seconds = static_cast<long long>(std::lround(timeS));
    if (seconds < 120) return fmt::format("{} s", seconds);
    const long long minutes = (seconds + 30) / 60;
    if (minutes < 120) return fmt::format("{} min", minutes);
    return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

std::string memoryText(double bytes) {
    const double mib = bytes / (1 << 20);
    return mib < 1000.0 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.1f} GiB", mib / 1024.0);
}

std::string forecastText(const run::Plan& plan, const History& history, int jobs) {
    double timeS = 0.0;
    long long memoryBytes = 0;
    std::map<std::string_view, TimedRounds> timed;  // by experiment
    bool isAnyKnown = false;
    const std::vector<std::size_t> firsts = run::firstTwins(plan.cases);
    for (std::size_t i = 0; i < firsts.size(); ++i) {
        const config::Case& item = plan.cases[i];
        if (firsts[i] != i) continue;
        const std::optional<cluster::Prediction> known = history.predictor.predict(item);
        if (!known || !known->isTold) return "";
        isAnyKnown = true;
        memoryBytes = std::max(memoryBytes, known->memoryBytes);
        if (item.measure.lane == config::Measure::Lane::Timing) {
            TimedRounds& rounds = timed[item.experiment];
            rounds.measure = &item.measure;
            rounds.roundS += known->timeS;
        } else {
            timeS += known->timeS * item.measure.processes / jobs;
        }
    }
    if (!isAnyKnown) return "";
    for (const auto& [experiment, rounds] : timed) timeS += rounds.totalS();
    return fmt::format("expect about {} and at most {} a case, as {} tell{}", durationText(timeS),
                       memoryText(static_cast<double>(memoryBytes)), joined(history.sources),
                       history.sources.size() == 1 ? "s" : "");
}

}  // namespace gfxrepro::cli
