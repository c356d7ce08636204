#include "runner/tables/cell.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::tables {

// From repeated measurements to one value with its bounds.

namespace {

using Units = std::map<int, std::vector<double>>;
using metrics::Statistic;

double summarizeUnits(const Units& units, Statistic statistic) {
    if (units.size() == 1) return metrics::summarize(units.begin()->second, statistic);
    std::vector<double> values;
    for (const auto& [unit, repeats] : units) {
        values.push_back(metrics::summarize(repeats, Statistic::Median));
    }
    return metrics::summarize(values, statistic);
}

Units pooled(const Samples& samples) {
    Units units;
    for (const auto& [process, own] : samples.processes) {
        for (const auto& [unit, repeats] : own) {
            std::vector<double>& all = units[unit];
            all.insert(all.end(), repeats.begin(), repeats.end());
        }
    }
    return units;
}

/// What the first repeat of every unit alone would give, then the second, …
std::vector<double> byRepeat(const Units& units, Statistic statistic) {
    std::size_t count = units.begin()->second.size();
    for (const auto& [unit, repeats] : units) count = std::min(count, repeats.size());
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        Units alone;
        for (const auto& [unit, repeats] : units) alone[unit] = {repeats[i]};
        values.push_back(summarizeUnits(alone, statistic));
    }
    return values;
}

metrics::Interval rangeOf(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return {low, high};
}

/// Value and bounds of what each process came to, at least one.
void fillFromRounds(const std::vector<double>& values, Summary& summary) {
    summary.value = metrics::summarize(values, Statistic::Median);
    summary.interval = rangeOf(values);
    if (values.size() > 1) summary.bounds = Bounds::Range;
    if (const auto interval = metrics::medianInterval(values)) {
        summary.bounds = Bounds::Interval;
        summary.interval = *interval;
    }
}

}  // namespace

std::string_view boundsName(Bounds bounds) {
    constexpr std::string_view kNames[] = {"", "range", "95 % interval"};
    return kNames[static_cast<std::size_t>(bounds)];
}

Summary summarize(const Samples& samples, Statistic statistic) {
    const Units all = pooled(samples);
    GFXREPRO_ASSERT(!all.empty());
    Summary summary;
    std::vector<double> values;
    for (const auto& [process, units] : samples.processes) {
        if (units.size() < all.size()) continue;
        values.push_back(summarizeUnits(units, statistic));
        summary.rounds[process] = values.back();
    }
    summary.value = summarizeUnits(all, statistic);
    summary.interval = {summary.value, summary.value};
    if (!values.empty()) fillFromRounds(values, summary);
    // A sum or a count of repeats is not what one of them gives.
    const bool isOfRepeats =
        all.size() == 1 && (statistic == Statistic::Sum || statistic == Statistic::Count);
    if (values.size() != 1 || isOfRepeats) return summary;
    const std::vector<double> repeats = byRepeat(all, statistic);
    if (repeats.size() < 2) return summary;
    summary.bounds = Bounds::Range;
    summary.interval = rangeOf(repeats);
    return summary;
}

Summary together(const Summary& a, const Summary& b, double (*of)(double, double)) {
    Summary both;
    std::vector<double> values;
    for (const auto& [process, value] : a.rounds) {
        const auto other = b.rounds.find(process);
        if (other == b.rounds.end()) continue;
        values.push_back(of(value, other->second));
        both.rounds[process] = values.back();
    }
    both.value = of(a.value, b.value);
    both.interval = {both.value, both.value};
    if (!values.empty()) fillFromRounds(values, both);
    return both;
}

// What a share that was counted once could be in truth.

namespace {

/// The ends of an interval lie within 0.05 standard deviations of where ever more would put them.
constexpr int kDraws = 4000;

/// FNV-1a: the same on every machine.
std::uint64_t seedOf(std::string_view name) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return hash;
}

}  // namespace

std::map<int, double> shareDraws(double percent, double count, std::string_view name) {
    const double successes = std::round(percent / 100.0 * count);
    std::mt19937_64 random(seedOf(name));
    std::gamma_distribution<double> in(successes + 0.5), out(count - successes + 0.5);
    std::map<int, double> draws;
    for (int i = 0; i < kDraws; ++i) {
        const double a = in(random), b = out(random);
        draws[i] = 100.0 * a / (a + b);
    }
    return draws;
}

void boundByDraws(Summary& share, double scale, double count, std::string_view name) {
    share.rounds = shareDraws(share.value / scale, count, name);
    std::vector<double> draws;
    for (auto& [number, value] : share.rounds) draws.push_back(value *= scale);
    share.areDraws = true;
    share.bounds = Bounds::Interval;
    share.interval = drawsInterval(std::move(draws));
}

metrics::Interval drawsInterval(std::vector<double> draws) {
    std::ranges::sort(draws);
    const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws.size()));
    return {draws[tail], draws[draws.size() - 1 - tail]};
}

// Which records a cell takes, and what they come to.

namespace {

constexpr std::string_view kDefaultFormat = "{median:.4g}";

void layOver(const config::Selection& part, config::Selection& selection, Where& where) {
    if (part.metric) selection.metric = part.metric;
    if (part.pass) selection.pass = part.pass;
    if (part.format) selection.format = part.format;
    if (part.scale) selection.scale = part.scale;
    if (part.against) selection.against = part.against;
    if (part.location.line > 0) selection.location = part.location;
    for (const auto& [axis, value] : part.where) {
        std::vector<std::string> allowed = {canonicalText(value)};
        if (value.isSequence()) {
            for (const Node& item : value.items()) allowed.push_back(canonicalText(item));
        }
        where[axis] = std::move(allowed);
    }
}

/// Lays the parts of the labels of one dimension; a sweep axis asks for its own value.
void layKeyOver(const std::vector<config::LayoutAxis>& axes, const Key& key,
                config::Selection& selection, Where& where) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].isSweepAxis()) {
            where[axes[i].name] = {key[i]};
            continue;
        }
        for (const auto& [label, part] : axes[i].labels) {
            if (label == key[i]) layOver(part, selection, where);
        }
    }
}

struct Laid {
    config::Selection selection;
    Where where;
};

/// The parts of `cell`, the row and the column, laid over one another.
Laid partsOver(const config::Layout& layout, const Key& row, const Key& column) {
    Laid laid;
    layOver(layout.cell, laid.selection, laid.where);
    layKeyOver(layout.rows, row, laid.selection, laid.where);
    layKeyOver(layout.columns, column, laid.selection, laid.where);
    return laid;
}

bool matchesFrame(const Where& where, int frame) {
    const auto found = where.find("frame");
    if (found == where.end()) return true;
    const std::string text = std::to_string(frame);
    return std::find(found->second.begin(), found->second.end(), text) != found->second.end();
}

bool isFrameTime(const std::string& metric) {
    return metric == "wall_time_ms" || metric == "gpu_time_ms" || metric == "cpu_time_ms";
}

/// The same place by the CPU time of the process, where such is recorded.
std::optional<CellQuery> byProcessTime(const CellQuery& query) {
    const bool isRate = query.metric == "frame_rate";
    if (!isRate && !isFrameTime(query.metric)) return std::nullopt;
    CellQuery other = query;
    other.metric = "process_time_ms";
    if (other.against) {
        if (isRate || !isFrameTime(other.against->metric)) return std::nullopt;
        other.against->metric = "process_time_ms";
    }
    other.isRateOfTime = isRate;
    return other;
}

/// What a share is of, or what is taken away.
std::optional<CellQuery> otherOf(const CellQuery& query) {
    if (!query.against) return std::nullopt;
    CellQuery other = query;
    other.metric = query.against->metric;
    other.pass = query.against->pass;
    other.against.reset();
    return other;
}

bool isShare(const CellQuery& query) {
    return query.against && query.against->as == config::Against::As::Whole;
}

double sharePct(double part, double whole) {
    return 100.0 * part / whole;
}

double difference(double whole, double part) {
    return whole - part;
}

struct Gathered {  // what the records of a cell came to
    Samples samples;
    std::optional<Samples> other;  // of `against`
    records::Status worst = records::Status::Ok;
    std::string message;
    bool isUntimed = false;  // ambiguous for being a time of the quality lane
    std::set<std::string> units;
    std::vector<std::string> caseIds;
    std::set<std::uint64_t> seeds;    // of random numbers that the values hang on
    std::size_t notRun = 0;           // further cases
    std::vector<double> shareCounts;  // of shares that say so: how many samples each is a share of

    void note(records::Status status, const std::string& why) {
        if (status > worst) {
            worst = status;
            message = why;
        }
    }
};

void takeRow(const records::Record& record, const CellQuery& query, int unit,
             std::map<int, std::vector<double>>& process, Gathered& gathered) {
    if (config::isTimeMetric(query.metric) && record.lane == "quality") {
        if (gathered.worst < records::Status::Ambiguous) gathered.isUntimed = true;
        gathered.note(records::Status::Ambiguous,
                      "measured in the quality lane, where cases run side "
                      "by side; a time needs the timing lane");
        return;
    }
    if (record.status != records::Status::Ok) gathered.note(record.status, record.message);
    if (record.status != records::Status::Ok && record.status != records::Status::Flaky) return;
    if (std::isnan(record.value)) {
        gathered.note(records::Status::Error, "case " + record.caseId + " recorded not-a-number");
        return;
    }
    gathered.units.insert(record.unit);
    const double value = query.isRateOfTime ? 1000.0 / record.value : record.value;
    process[unit].push_back(value * query.scale);
}

/// Neither a time nor what the device counted.
bool isOfTechnique(const std::string& metric) {
    return !config::isTimeMetric(metric) && !metric.starts_with("work_");
}

void takeCase(const CaseRecords& run, const CellQuery& query, std::map<int, int>& unitOfFrame,
              int& unitCount, Gathered& gathered) {
    for (const auto& [number, attempt] : run.processes) {
        if (attempt.failure) {
            gathered.note(attempt.failure->status, attempt.failure->message);
            continue;
        }
        std::map<int, std::vector<double>> process;
        bool isRandom = run.seeds != config::Measure::Seeds::None && isOfTechnique(query.metric);
        for (const records::Record* record : attempt.values(query.metric, query.pass)) {
            if (!matchesFrame(query.where, record->frame)) continue;
            const auto [unit, isNew] = unitOfFrame.try_emplace(record->frame, unitCount);
            if (isNew) ++unitCount;
            takeRow(*record, query, unit->second, process, gathered);
            isRandom &= record->frame != records::kSetup;
        }
        for (const records::Record* count :
             attempt.values(query.metric + std::string(config::kShareOf), query.pass)) {
            if (matchesFrame(query.where, count->frame))
                gathered.shareCounts.push_back(count->value);
        }
        if (isRandom && !process.empty()) gathered.seeds.insert(run.seedOf(number));
        // Process k of all cases is one round: what a cell of several cases shows is of rounds.
        if (!process.empty()) gathered.samples.processes[number].merge(process);
    }
}

/// The passes for which the matching cases recorded the metric: for the message when the one that
/// was asked for is not among them.
std::string passesWith(const CellQuery& query, const LayoutCases& cases) {
    std::set<std::string> passes;
    for (const CaseRecords* run : casesAt(query.where, cases)) {
        for (const auto& [number, attempt] : run->processes) {
            for (const auto& [place, record] : attempt.rows) {
                if (place.metric == query.metric) {
                    passes.insert(place.pass.empty() ? "none" : std::string(place.pass));
                }
            }
        }
    }
    return joined(std::vector<std::string>(passes.begin(), passes.end()));
}

std::string whyNothing(const CellQuery& query, const LayoutCases& cases) {
    const std::string wanted =
        "'" + query.metric + "'" + (query.pass.empty() ? "" : " of pass '" + query.pass + "'");
    const std::string passes = passesWith(query, cases);
    return "no " + wanted + " was recorded" +
           (passes.empty() ? "" : "; it is there for pass: " + passes);
}

Gathered gather(const CellQuery& query, const LayoutCases& cases) {
    Gathered gathered;
    int unitCount = 0;
    for (const CaseRecords* run : casesAt(query.where, cases)) {
        if (run->processes.empty()) {
            ++gathered.notRun;
            continue;
        }
        gathered.caseIds.push_back(run->id);
        std::map<int, int> unitOfFrame;
        takeCase(*run, query, unitOfFrame, unitCount, gathered);
    }
    if (const std::optional<CellQuery> other = otherOf(query)) {
        Gathered beside = gather(*other, cases);
        if (gathered.worst < beside.worst) gathered.isUntimed = beside.isUntimed;
        gathered.note(beside.worst, beside.message);
        const bool isThere = !beside.samples.processes.empty();
        const bool doesFit = isThere && (isShare(query) || gathered.units == beside.units);
        if (!gathered.samples.processes.empty() && !doesFit) {
            gathered.note(isThere ? records::Status::Error : records::Status::Missing,
                          isThere ? "'" + other->metric + "' is of another unit than '" +
                                        query.metric + "' and cannot be taken away from it"
                                  : whyNothing(*other, cases));
        }
        if (!doesFit) gathered.samples = {};
        gathered.other = std::move(beside.samples);
        gathered.seeds.merge(beside.seeds);
    }
    return gathered;
}

std::vector<Measured> measuredOf(const CellQuery& query, const Gathered& gathered) {
    std::vector<Measured> values;
    for (const auto& placeholder : query.format.placeholders()) {
        Summary summary = summarize(gathered.samples, placeholder.statistic);
        if (gathered.other) {
            summary = together(summary, summarize(*gathered.other, placeholder.statistic),
                               isShare(query) ? sharePct : difference);
        }
        Measured& measured = values.emplace_back();
        static_cast<Summary&>(measured) = std::move(summary);
        measured.statistic = placeholder.name;
    }
    return values;
}

/// A share that was counted once, in one case: its bounds are those of the count.
void boundShare(const CellQuery& query, const Gathered& gathered, Measured& measured) {
    const auto& processes = gathered.samples.processes;
    const bool isCountedOnce = gathered.shareCounts.size() == 1 && processes.size() == 1 &&
                               processes.begin()->second.size() == 1 &&
                               processes.begin()->second.begin()->second.size() == 1;
    if (!isCountedOnce || query.against) return;
    boundByDraws(measured, query.scale, gathered.shareCounts[0],
                 gathered.caseIds[0] + query.metric + query.pass);
}

/// The texts of these numbers, and of them together.
void writeTexts(const CellFormat& format, std::vector<Measured>& numbers, std::string& whole,
                std::string& low, std::string& high) {
    std::vector<double> values, lows, highs;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        Measured& measured = numbers[i];
        measured.text = format.formatOne(i, measured.value);
        if (measured.bounds != Bounds::None) {
            measured.low = format.formatOne(i, measured.interval.low);
            measured.high = format.formatOne(i, measured.interval.high);
        }
        values.push_back(measured.value);
        lows.push_back(measured.interval.low);
        highs.push_back(measured.interval.high);
    }
    whole = format.format(values);
    if (numbers.front().bounds == Bounds::None) return;
    low = format.format(lows);
    high = format.format(highs);
}

/// Equal values of several processes of one seed are one sample. A share that was counted once has
/// the bounds of its count.
void countSeeds(const Gathered& gathered, Cell& cell) {
    const auto isEven = [](const Measured& measured) {
        return std::ranges::all_of(measured.rounds, [&](const auto& round) {
            return round.second == measured.rounds.begin()->second;
        });
    };
    const bool isOne = gathered.seeds.size() == 1;
    if (std::ranges::any_of(cell.values, &Measured::areDraws)) return;
    if (isOne && !std::ranges::all_of(cell.values, isEven)) return;
    cell.seedCount = gathered.seeds.size();
    if (!isOne) return;
    for (Measured& measured : cell.values) {
        measured.rounds.clear();
        measured.bounds = Bounds::None;
        measured.interval = {measured.value, measured.value};
    }
}

void fillValues(const CellQuery& query, const Gathered& gathered, Cell& cell) {
    cell.values = measuredOf(query, gathered);
    for (Measured& measured : cell.values) boundShare(query, gathered, measured);
    countSeeds(gathered, cell);
    writeTexts(query.format, cell.values, cell.measured, cell.low, cell.high);
}

/// Only where every measurement has its CPU time beside it.
void fillProcessTimes(const CellQuery& query, const LayoutCases& cases, const Samples& samples,
                      Cell& cell) {
    const std::optional<CellQuery> other = byProcessTime(query);
    if (!other) return;
    const Gathered gathered = gather(*other, cases);
    if (gathered.samples.processes.size() != samples.processes.size()) return;
    for (const auto& [number, units] : samples.processes) {
        const auto own = gathered.samples.processes.find(number);
        if (own == gathered.samples.processes.end() || own->second.size() != units.size()) return;
    }
    cell.byProcess = measuredOf(*other, gathered);
    writeTexts(query.format, cell.byProcess, cell.measuredByProcess, cell.lowByProcess,
               cell.highByProcess);
}

}  // namespace

const Measured* Cell::find(const std::string& statistic, Clock clock) const {
    for (const Measured& candidate : clock == Clock::Wall ? values : byProcess) {
        if (statistic.empty() || candidate.statistic == statistic) return &candidate;
    }
    return nullptr;
}

std::string_view sceneSourceName(SceneSource source) {
    constexpr std::string_view kNames[] = {"", "real", "generated", "stand-in"};
    return kNames[static_cast<std::size_t>(source)];
}

Where whereOf(const config::Layout& layout, const Key& row, const Key& column) {
    return partsOver(layout, row, column).where;
}

CellQuery makeQuery(const config::Layout& layout, const Key& row, const Key& column) {
    auto [selection, where] = partsOver(layout, row, column);
    if (!selection.metric) {
        throw Error(selection.location, "no metric is given for the cell of row '" +
                                            joined(row, "_") + "', column '" + joined(column, "_") +
                                            "'; add `metric:` to its column, its row or `cell`");
    }
    return {*selection.metric,
            selection.pass.value_or(""),
            CellFormat(selection.format.value_or(std::string(kDefaultFormat)), selection.location),
            selection.scale.value_or(1.0),
            selection.scale.has_value(),
            selection.against,
            false,
            std::move(where)};
}

Cell buildCell(const CellQuery& query, const LayoutCases& cases) {
    Cell cell;
    cell.isTime = config::isTimeMetric(query.metric) ||
                  (query.against && config::isTimeMetric(query.against->metric));
    cell.timePower = config::timePower(query.metric) -
                     (isShare(query) ? config::timePower(query.against->metric) : 0);
    Gathered gathered = gather(query, cases);
    const bool hasSamples = !gathered.samples.processes.empty();
    const std::size_t notRun = gathered.notRun, planned = gathered.caseIds.size() + notRun;
    if (notRun == planned) {
        cell.isPlanned = planned > 0;
        gathered.note(records::Status::Missing, "not run");
    } else if (notRun > 0) {
        gathered.note(
            records::Status::Missing,
            std::to_string(notRun) + " of " + std::to_string(planned) + " cases were not run");
    }
    if (!hasSamples && gathered.worst == records::Status::Ok) {
        gathered.note(records::Status::Missing, whyNothing(query, cases));
        cell.isUnrecorded = true;
    }
    cell.status = gathered.worst;
    cell.message = gathered.message;
    cell.caseIds = gathered.caseIds;
    if (isShare(query)) {
        cell.unit = "%";
    } else if (!query.isScaled) {
        cell.metric = query.metric;
        if (gathered.units.size() == 1) cell.unit = *gathered.units.begin();
    }
    if (hasSamples) {
        fillValues(query, gathered, cell);
        fillProcessTimes(query, cases, gathered.samples, cell);
    }
    const bool isTimed = !gathered.isUntimed || cell.status != records::Status::Ambiguous;
    const std::string word(isTimed ? records::statusName(cell.status) : "not timed");
    const bool isFlaky = hasSamples && cell.status == records::Status::Flaky;
    cell.isPartial = hasSamples && cell.status != records::Status::Ok && !isFlaky;
    if (isFlaky) cell.measured += " (flaky)";
    if (cell.isPartial) cell.measured += " (partial: " + word + ")";
    if (!hasSamples) cell.measured = cell.isPlanned ? word : "";
    return cell;
}

Cell processCell(const Cell& cell) {
    Cell own;
    own.isPlanned = !cell.byProcess.empty();
    if (!own.isPlanned) return own;
    own.status = cell.status;
    own.message = cell.message;
    own.values = cell.byProcess;
    own.measured = cell.measuredByProcess;
    own.low = cell.lowByProcess;
    own.high = cell.highByProcess;
    own.caseIds = cell.caseIds;
    own.isTime = true;
    own.timePower = cell.timePower;
    own.unit = cell.unit;
    return own;
}

SceneSource sceneSourceOf(const config::Layout& layout, const Key& row, const LayoutCases& cases) {
    config::Selection selection;
    Where where;
    layKeyOver(layout.rows, row, selection, where);
    SceneSource source = SceneSource::Unknown;
    for (const CaseRecords* run : casesAt(where, cases)) {
        for (const auto& [number, attempt] : run->processes) {
            const CaseRecords::Place first{"scene_source", "", INT_MIN, INT_MIN};
            const auto found = attempt.rows.lower_bound(first);
            if (found == attempt.rows.end() || found->first.metric != "scene_source") continue;
            const double value = found->second->value;
            const SceneSource here = value == 1.0   ? SceneSource::StandIn
                                     : value == 2.0 ? SceneSource::Generated
                                                    : SceneSource::Real;
            source = std::max(source, here);
        }
    }
    return source;
}

}  // namespace gfxrepro::tables
