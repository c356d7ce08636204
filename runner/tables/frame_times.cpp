#include "runner/tables/frame_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "engine/core/text.h"

namespace gfxrepro::tables {

namespace {

static_assert(config::kFewestRounds == metrics::kFewestForInterval);

/// Values that an interval has beyond those by which it was found to be narrow.
constexpr std::size_t kNewRounds = 2;
/// Fewer rounds do not end by a relative error.
constexpr std::size_t kFewestByError = 14;
constexpr const char* kEndedByError = "relative_error";

std::vector<double> roundValues(const std::map<int, double>& rounds) {
    std::vector<double> values;
    for (const auto& [process, value] : rounds) values.push_back(value);
    return values;
}

/// log(b / a) in each round that has both.
std::vector<double> logRatios(const std::map<int, double>& a, const std::map<int, double>& b) {
    std::vector<double> ratios;
    for (const auto& [process, value] : a) {
        const auto other = b.find(process);
        if (other != b.end()) ratios.push_back(std::log(other->second / value));
    }
    return ratios;
}

double halfWidth(const metrics::Interval& interval) {
    return 0.5 * (interval.high - interval.low);
}

/// Half the intervals of what neighbours differ by, as logarithms.
std::vector<double> noiseWidths(const std::vector<std::map<int, double>>& cases) {
    std::vector<double> widths;
    for (std::size_t i = 1; i < cases.size(); ++i) {
        const auto interval = metrics::medianInterval(logRatios(cases[i - 1], cases[i]));
        if (interval) widths.push_back(halfWidth(*interval));
    }
    if (cases.size() == 1) {
        std::vector<double> logs = roundValues(cases[0]);
        for (double& value : logs) value = std::log(value);
        const auto interval = metrics::medianInterval(logs);
        if (interval) widths.push_back(std::numbers::sqrt2 * halfWidth(*interval));
    }
    return widths;
}

std::optional<double> noiseOf(const std::vector<double>& widths) {
    if (widths.empty()) return std::nullopt;
    return std::expm1(metrics::median(widths));
}

std::string percentText(double share) {
    return fmt::format("{:.3g} %", 100.0 * share);
}

}  // namespace

std::vector<double> FrameTimes::CaseTimes::fellowsOf(int frame) const {
    std::vector<double> same, others;
    for (const auto& [process, frames] : wall) {
        for (const auto& [one, repeats] : frames) {
            for (const auto& [repeat, value] : repeats) {
                (one == frame ? same : others).push_back(value);
            }
        }
    }
    return same.size() > kFewestFellows ? same : others;
}

FrameTimes::CaseTimes& FrameTimes::caseOf(const records::Record& record) {
    const auto [found, isNew] = indices_.try_emplace(record.caseId, cases_.size());
    if (isNew) {
        std::vector<std::string> parts;
        for (const std::string* part : {&record.scene, &record.method}) {
            if (!part->empty()) parts.push_back(*part);
        }
        cases_.push_back(
            {record.caseId, parts.empty() ? record.caseId : joined(parts, " "), {}, {}});
    }
    return cases_[found->second];
}

void FrameTimes::add(const records::Record& record) {
    const bool isWall = record.metric == "wall_time_ms";
    if (!isWall && record.metric != "process_time_ms") return;
    if (!record.pass.empty() || record.lane != "timing") return;
    if (record.status != records::Status::Ok && record.status != records::Status::Flaky) return;
    if (!(record.value > 0.0)) return;
    CaseTimes& times = caseOf(record);
    (isWall ? times.wall : times.cpu)[record.process][record.frame][record.repeat] = record.value;
}

std::vector<std::map<int, double>> FrameTimes::times(Clock clock) const {
    std::vector<std::map<int, double>> result;
    for (const CaseTimes& times : cases_) {
        const auto& processes = clock == Clock::Wall ? times.wall : times.cpu;
        std::size_t frameCount = 0;
        for (const auto& [process, frames] : processes) {
            frameCount = std::max(frameCount, frames.size());
        }
        std::map<int, double>& sums = result.emplace_back();
        for (const auto& [process, frames] : processes) {
            if (frames.size() < frameCount) continue;
            for (const auto& [frame, repeats] : frames) {
                sums[process] += metrics::median(roundValues(repeats));
            }
        }
    }
    return result;
}

std::size_t FrameTimes::roundCount() const {
    std::size_t count = 0;
    for (const CaseTimes& times : cases_) count = std::max(count, times.wall.size());
    return count;
}

bool FrameTimes::hasRounds(const std::string& caseId, int rounds) const {
    const auto found = indices_.find(caseId);
    if (found == indices_.end()) return false;
    const auto& processes = cases_[found->second].wall;
    for (int process = 0; process < rounds; ++process) {
        if (!processes.contains(process)) return false;
    }
    return true;
}

Clock FrameTimes::judgedClock() const {
    const bool hasAll = std::ranges::all_of(
        cases_, [](const CaseTimes& times) { return times.cpu.size() == times.wall.size(); });
    return hasAll && !goesByClock_ ? Clock::Process : Clock::Wall;
}

std::optional<double> FrameTimes::relativeErrorOf(std::size_t rounds) const {
    std::optional<double> largest;
    for (const std::map<int, double>& processes : times(judgedClock())) {
        std::vector<double> values = roundValues(processes);
        if (values.size() < rounds) continue;
        values.resize(rounds);
        const auto interval = metrics::medianInterval(values);
        if (!interval) continue;
        largest = std::max(largest.value_or(0.0), halfWidth(*interval) / metrics::median(values));
    }
    return largest;
}

bool FrameTimes::isKnownTo(double relativeError, int asked) const {
    const std::size_t rounds = roundCount();
    if (rounds < kFewestByError) return false;
    const std::size_t first = std::max<std::size_t>(asked, metrics::kFewestForInterval);
    if (metrics::medianIntervalDepth(rounds + 1) == metrics::medianIntervalDepth(rounds)) {
        return false;
    }
    for (std::size_t look = first; look + kNewRounds <= rounds; ++look) {
        const std::optional<double> measured = relativeErrorOf(look);
        if (measured && *measured <= relativeError) return true;
    }
    return false;
}

std::optional<double> FrameTimes::noise(Clock clock) const {
    if (clock == Clock::Process && goesByClock_) return std::nullopt;
    return noiseOf(noiseWidths(times(clock)));
}

std::optional<double> columnNoise(const Table& table, const std::vector<std::string>& labels,
                                  Clock clock) {
    std::vector<double> widths;
    for (const std::string& label : labels) {
        const auto column = table.findColumn(label);
        std::vector<std::map<int, double>> rows, certain;
        for (const TableRow& row : table.rows) {
            const Measured* time = column ? row.cells[*column].find("", clock) : nullptr;
            if (!time || time->areDraws || time->rounds.size() < metrics::kFewestForInterval)
                continue;
            const std::vector<double> values = roundValues(time->rounds);
            if (std::ranges::min(values) <= 0.0) continue;
            const bool isCertain = std::ranges::min(values) == std::ranges::max(values);
            (isCertain ? certain : rows).push_back(time->rounds);
        }
        // What is divided by itself tells nothing of its noise.
        std::ranges::copy(noiseWidths(rows.empty() ? certain : rows), std::back_inserter(widths));
    }
    if (labels.empty()) return std::nullopt;
    const std::optional<double> noise = noiseOf(widths);
    return noise ? noise : table.noise(clock);
}

std::vector<Outlier> FrameTimes::outliers() const {
    std::vector<Outlier> outliers;
    for (const CaseTimes& times : cases_) {
        for (const auto& [process, frames] : times.wall) {
            for (const auto& [frame, repeats] : frames) {
                const std::vector<double> fellows = times.fellowsOf(frame);
                if (fellows.size() < kFewestFellows) continue;
                const double usual = metrics::median(fellows);
                for (const auto& [repeat, value] : repeats) {
                    if (value < kOutlierFactor * usual) continue;
                    outliers.push_back(
                        {times.id, times.name, frame, process, repeat, value, value / usual});
                }
            }
        }
    }
    return outliers;
}

std::vector<std::string> outlierTexts(const FrameTimes& times, const LabelsOfCases& names) {
    constexpr std::size_t kMostNamed = 5;
    const std::vector<Outlier> outliers = times.outliers();
    std::vector<std::string> texts;
    for (const Outlier& outlier : outliers) {
        if (texts.size() == kMostNamed) {
            texts.push_back(fmt::format("{} more such frames.", outliers.size() - kMostNamed));
            break;
        }
        const auto known = names.find(outlier.caseId);
        const std::string& name = known == names.end() ? outlier.caseName : known->second;
        texts.push_back(fmt::format(
            "Outlier: frame {} of {} took {:.4g} ms in process {}, {:.3g} times its fellows.",
            outlier.frame, name, outlier.timeMs, outlier.process + 1, outlier.factor));
    }
    return texts;
}

namespace {

std::string_view judgedName(const FrameTimes& times) {
    return times.judgedClock() == Clock::Process ? "the CPU time of a frame"
                                                 : "the time of a frame";
}

}  // namespace

std::string_view endOfRounds(const config::Measure& measure, const FrameTimes& times) {
    const bool hasAsked = times.roundCount() >= static_cast<std::size_t>(measure.processes);
    if (!hasAsked && measure.certainRounds() < measure.processes) return config::kTimeBudget;
    if (!measure.mayContinue()) return "processes";
    if (times.isKnownTo(config::kKnownTo, measure.processes)) return kEndedByError;
    const bool isMost = times.roundCount() >= static_cast<std::size_t>(config::kMostRounds);
    return isMost ? "most_rounds" : config::kTimeBudget;
}

namespace {

/// What a reader is told of `endOfRounds`.
std::string_view endInWords(std::string_view end) {
    if (end == config::kTimeBudget) return "as many as the time allowed";
    if (end == kEndedByError) return "until the times were known";
    return end == "most_rounds" ? "the most that are allowed" : "as many as asked for";
}

}  // namespace

std::vector<std::string> timeNotes(const FrameTimes& times, const config::Measure& measure,
                                   const LabelsOfCases& names) {
    const std::size_t rounds = times.roundCount();
    if (rounds == 0) return {};
    std::vector<std::string> notes;
    const std::optional<double> error = times.relativeError();
    if (rounds < metrics::kFewestForInterval) {
        notes.push_back(fmt::format(
            "Times of {} process{}: bounds are a range, no interval (which takes {}), and no claim "
            "about a time is decided.{}",
            rounds, rounds == 1 ? "" : "es", metrics::kFewestForInterval,
            endOfRounds(measure, times) == config::kTimeBudget
                ? fmt::format(" All rounds together have {:g} s; `--set "
                              "measure.time_budget_s=…` allows more.",
                              measure.timeBudgetS)
                : ""));
    } else if (error) {
        const std::string target =
            measure.mayContinue() ? fmt::format(" (asked for: {})", percentText(config::kKnownTo))
                                  : "";
        notes.push_back(fmt::format("Times of {} rounds, {}; {} is known to ±{} or better{}.",
                                    rounds, endInWords(endOfRounds(measure, times)),
                                    judgedName(times), percentText(*error), target));
    }
    if (const auto noise = times.noise(Clock::Wall)) {
        const auto own = times.noise(Clock::Process);
        notes.push_back(fmt::format(
            "Noise of this table: two equal cases would differ by up to {}{}. Claims about a "
            "smaller difference of a frame's time are not decided.",
            percentText(*noise), own ? fmt::format(", by CPU time {}", percentText(*own)) : ""));
    }
    const std::vector<std::string> outliers = outlierTexts(times, names);
    notes.insert(notes.end(), outliers.begin(), outliers.end());
    return notes;
}

}  // namespace gfxrepro::tables
