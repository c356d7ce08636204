#include "runner/tables/cell.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "runner/tables/expression.h"

namespace gfxrepro::tables {

// Which records a cell takes, and what they come to.

namespace {

using metrics::Statistic;

void layOver(const config::Selection& part, config::Selection& selection, Where& where) {
    if (part.metric) selection.metric = part.metric;
    if (part.pass) selection.pass = part.pass;
    if (part.format) selection.format = part.format;
    if (part.scale) selection.scale = part.scale;
    if (part.of) selection.of = part.of;
    if (part.equal) selection.equal = part.equal;
    if (part.location.line > 0) selection.location = part.location;
    for (const auto& [axis, value] : part.where) {
        std::vector<std::string> allowed = {canonicalText(value)};
        if (value.isSequence()) {
            for (const Node& item : value.items()) allowed.push_back(canonicalText(item));
            // What draws nothing is the same whichever seeds are taken together.
            if (axis == kSeedAxis) allowed.emplace_back(kLeftOut);
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

/// The same place by the CPU time of the process, where such is recorded. What is shown at a time
/// by the clock has none: at as much CPU time it would be another number.
std::optional<CellQuery> byProcessTime(const CellQuery& query) {
    const bool isRate = query.metric == "frame_rate";
    const bool isTime = isRate || isFrameTime(query.metric);
    if (!isTime || (query.equal && isFrameTime(query.equal->metric))) return std::nullopt;
    CellQuery other = query;
    other.metric = "process_time_ms";
    other.isRateOfTime = isRate;
    return other;
}

struct Gathered {  // what the records of a cell came to
    Samples samples;
    records::Status worst = records::Status::Ok;
    std::string message;
    bool isUntimed = false;  // ambiguous for being a time of the quality lane
    std::set<std::string> units;
    std::vector<std::string> caseIds;
    std::set<std::uint64_t> seeds;  // of random numbers that the values hang on
    std::size_t fewestSeeds = 0;    // of a curve's cases
    bool isInDoubt = false;         // LayoutCases::isInDoubt
    bool isRunOnce = false;         // CaseRecords::isRunOnce, of what another run could change
    std::size_t notRun = 0;         // further cases
    std::set<int> frames;
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

/// Whether each value of a swept seed is a round of its own, as a process with its seed is; of a
/// time, where it is a process.
bool isRoundOfSeed(const CaseRecords& run, const CellQuery& query) {
    using Seeds = config::Measure::Seeds;
    if (!run.sweptSeed || run.sceneSeeds > 1) return false;
    if (!run.isOfItsSeed(query.metric)) return config::isTimeMetric(query.metric) && run.isSeedARun;
    return run.seeds == Seeds::None ? !run.scatters(query.metric, query.pass)
                                    : run.seeds == Seeds::Case;
}

void takeCase(const CaseRecords& run, const CellQuery& query, std::map<int, int>& unitOfFrame,
              int& unitCount, Gathered& gathered) {
    using Seeds = config::Measure::Seeds;
    const bool differs = run.scatters(query.metric, query.pass);
    const bool isOfSeed = isRoundOfSeed(run, query);
    gathered.isRunOnce |= run.isRunOnce && run.isOfItsSeed(query.metric);
    for (const auto& [number, attempt] : run.processes) {
        // What differs between processes is no new number for each seed of another scene.
        if (run.isRepeated && differs && number >= records::kMostProcesses) break;
        if (attempt.failure) {
            gathered.note(attempt.failure->status, attempt.failure->message);
            continue;
        }
        std::map<int, std::vector<double>> process;
        bool isRandom = run.isOfItsSeed(query.metric) && (isOfSeed || run.seeds != Seeds::None);
        for (const records::Record* record : attempt.values(query.metric, query.pass)) {
            if (!matchesFrame(query.where, record->frame)) continue;
            const auto [unit, isNew] = unitOfFrame.try_emplace(record->frame, unitCount);
            if (isNew) ++unitCount;
            gathered.frames.insert(record->frame);
            takeRow(*record, query, unit->second, process, gathered);
            isRandom &= record->frame != records::kSetup;
        }
        for (const records::Record* count :
             attempt.values(query.metric + std::string(config::kShareOf), query.pass)) {
            if (matchesFrame(query.where, count->frame))
                gathered.shareCounts.push_back(count->value);
        }
        if (isRandom && !process.empty()) gathered.seeds.insert(run.seedOf(number));
        // Process k of all cases is one round: what a cell of several cases shows is of rounds. Of
        // several scenes each is one, however many processes it has.
        const int round =
            isOfSeed ? *run.sweptSeed
                     : number - (run.sceneSeeds > 1 ? number % records::kMostProcesses : 0);
        for (const auto& [unit, values] : process) {
            std::vector<double>& all = gathered.samples.processes[round][unit];
            all.insert(all.end(), values.begin(), values.end());
        }
    }
}

bool isInDoubt(const CellQuery& query, const LayoutCases& cases, const Gathered& gathered) {
    const auto isMachine = [&](const std::string& unit) { return isOfMachine(query.metric, unit); };
    const bool isSetup = gathered.frames == std::set<int>{records::kSetup};
    return (gathered.isRunOnce && !isSetup) ||
           cases.isInDoubt(query.metric, isSetup, std::ranges::any_of(gathered.units, isMachine));
}

/// Where the matching cases recorded the metric: at other frames of its pass, else for which
/// passes.
struct ThereIs {
    std::set<std::string> passes;
    std::set<int> frames;
};

ThereIs whatIsThere(const CellQuery& query, const LayoutCases& cases) {
    ThereIs there;
    for (const CaseRecords* run : casesAt(query.where, cases)) {
        for (const auto& [number, attempt] : run->processes) {
            for (const records::Record* record : attempt.rows) {
                if (record->metric != query.metric) continue;
                there.passes.insert(record->pass.empty() ? "(no 'pass')" : record->pass);
                if (record->pass == query.pass) there.frames.insert(record->frame);
            }
        }
    }
    if (!there.frames.empty()) there.passes.clear();
    return there;
}

/// What else the cell takes together: seeds of scenes, and frames, as the config asks for.
void addSampled(const CellQuery& query, const LayoutCases& cases, std::size_t frames, Cell& cell) {
    std::size_t seeds = 1;
    for (const CaseRecords* one : casesAt(query.where, cases)) {
        seeds = std::max(seeds, static_cast<std::size_t>(one->sceneSeeds));
    }
    for (const auto& [axis, count] : {std::pair("scene_seed", seeds), std::pair("frame", frames)}) {
        if (count > 1) cell.pooled.push_back({axis, {fmt::format("{} of them", count)}, true});
    }
    cell.onceAlong = onceAlong(query, cases, cell.pooled);
}

std::string whyNothing(const CellQuery& query, const LayoutCases& cases) {
    const auto [passes, frames] = whatIsThere(query, cases);
    const auto frame = query.where.find("frame");
    return fmt::format(
        "no '{}'{}{} was recorded{}", query.metric,
        query.pass.empty() ? "" : " of pass '" + query.pass + "'",
        frame == query.where.end() ? "" : " of frame " + frame->second.front(),
        !frames.empty()   ? fmt::format("; it is there for frame: {}", fmt::join(frames, ", "))
        : !passes.empty() ? fmt::format("; it is there for pass: {}", fmt::join(passes, ", "))
                          : cases.recordedInstead(query.metric));
}

Gathered gather(const CellQuery& query, const LayoutCases& cases) {
    Gathered gathered;
    int unitCount = 0;
    std::map<AxisValues, std::map<int, int>> unitOfFrame;
    for (const CaseRecords* run : casesAt(query.where, cases)) {
        if (run->processes.empty()) {
            ++gathered.notRun;
            continue;
        }
        gathered.caseIds.push_back(run->id);
        AxisValues unit = run->axes;  // draws of one number share theirs
        if (isRoundOfSeed(*run, query)) unit[cases.indexOf(std::string(kSeedAxis))].reset();
        takeCase(*run, query, unitOfFrame[unit], unitCount, gathered);
    }
    gathered.isInDoubt = isInDoubt(query, cases, gathered);
    return gathered;
}

std::vector<Measured> measuredOf(const CellQuery& query, const Gathered& gathered) {
    std::vector<Measured> values;
    for (const auto& placeholder : query.format.placeholders()) {
        Measured& measured = values.emplace_back();
        static_cast<Summary&>(measured) = summarize(gathered.samples, placeholder.statistic);
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
    if (!isCountedOnce) return;
    boundByDraws(measured, query.scale, gathered.shareCounts[0],
                 gathered.caseIds[0] + query.metric + query.pass);
}

/// Several processes of it are one sample.
void takeAsOne(Measured& measured) {
    measured.rounds.clear();
    measured.areDraws = false;
    measured.bounds = Bounds::None;
    measured.interval = {measured.value, measured.value};
}

/// Random numbers of one seed are one sample, however many processes drew them, and by how little
/// these differ. A share that was counted once has the bounds of its count, unless another count
/// would be another share.
void countSeeds(const Gathered& gathered, Cell& cell) {
    const bool areDraws = std::ranges::any_of(cell.values, &Measured::areDraws);
    cell.seedCount = areDraws ? 0 : gathered.seeds.size();
    cell.scatters = gathered.seeds.empty() && gathered.isInDoubt;
    cell.isRunOnce = cell.scatters && gathered.isRunOnce;
    if (cell.isOfOneSeed() || (areDraws && cell.scatters)) {
        std::ranges::for_each(cell.values, takeAsOne);
    }
}

void fillValues(const CellQuery& query, const Gathered& gathered, Cell& cell) {
    cell.values = measuredOf(query, gathered);
    const bool isOfOneSeed = gathered.seeds.size() == 1;
    const auto unknown = std::ranges::find_if(cell.values, [&](const Measured& measured) {
        const bool isOfSeeds = measured.isOverProcesses && measured.statistic == "stddev";
        return std::isnan(measured.value) || (isOfOneSeed && isOfSeeds);
    });
    if (unknown != cell.values.end()) {
        cell.status = records::Status::Missing;
        cell.message = fmt::format("'{}' needs two {} or more", unknown->statistic,
                                   isOfOneSeed ? "seeds" : "values");
        cell.seedCount = gathered.seeds.size();
        cell.values.clear();
        return;
    }
    for (Measured& measured : cell.values) boundShare(query, gathered, measured);
    countSeeds(gathered, cell);
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
}

// Equal time, equal error.

Sampled sampledOf(const Samples& samples, const CellFormat::Placeholder& placeholder) {
    Summary summary = summarize(samples, placeholder.statistic);
    if (summary.rounds.size() < 2) summary.rounds.clear();  // no more than the value
    Sampled sampled{summary.value, std::move(summary.rounds)};
    if (summary.isOverProcesses) sampled.overProcesses = placeholder.name;
    return sampled;
}

/// The axis of numbers along which the curve goes: the one of those that the cell takes together.
std::optional<std::size_t> curveAxis(const std::vector<Pooled>& pooled) {
    for (std::size_t i = 0; i < pooled.size(); ++i) {
        const bool isOfNumbers =
            pooled[i].axis != kSeedAxis &&
            std::ranges::all_of(pooled[i].values, [](const std::string& value) {
                return parseDouble(value).has_value();
            });
        if (isOfNumbers) return i;
    }
    return std::nullopt;
}

/// The cell's cases in the order of the curve's axis.
std::vector<const CaseRecords*> casesAlong(const std::string& axis, const CellQuery& query,
                                           const LayoutCases& cases) {
    std::vector<const CaseRecords*> along = casesAt(query.where, cases);
    const std::size_t place = cases.indexOf(axis);
    std::ranges::stable_sort(along, {}, [&](const CaseRecords* item) {
        return parseDouble(item->axes[place].value_or("")).value_or(0.0);
    });
    return along;
}

/// What a case has of the other metric, x, and of the cell's own, y.
struct CurveCase {
    Samples x, y;
};

/// The cases that have both; what is wrong with one is noted.
std::vector<CurveCase> curveCases(const CellQuery& query, std::span<const CaseRecords* const> along,
                                  const LayoutCases& layoutCases, Gathered& gathered) {
    CellQuery other = query;
    other.metric = query.equal->metric;
    other.scale = 1.0;
    other.isRateOfTime = false;
    std::vector<CurveCase> cases;
    for (const CaseRecords* run : along) {
        if (run->processes.empty()) gathered.note(records::Status::Missing, "a case was not run");
        other.pass = run->passOf(other.metric);
        Gathered x, y;
        std::map<int, int> unitsOfX, unitsOfY;
        int xCount = 0, yCount = 0;
        takeCase(*run, other, unitsOfX, xCount, x);
        takeCase(*run, query, unitsOfY, yCount, y);
        for (const Gathered* one : {&x, &y}) {
            gathered.note(one->worst, one->message);
            gathered.isRunOnce |= one->isRunOnce;
            gathered.fewestSeeds = fewerSeeds(gathered.fewestSeeds, one->seeds.size());
        }
        gathered.isInDoubt |= isInDoubt(other, layoutCases, x) || isInDoubt(query, layoutCases, y);
        gathered.units.merge(y.units);
        gathered.frames.merge(y.frames);
        if (x.samples.processes.empty() || y.samples.processes.empty()) continue;
        cases.push_back({std::move(x.samples), std::move(y.samples)});
    }
    return cases;
}

std::vector<Measured> equalValues(const CellQuery& query, std::span<const CaseRecords* const> along,
                                  const LayoutCases& layoutCases, Gathered& gathered) {
    const std::vector<CurveCase> cases = curveCases(query, along, layoutCases, gathered);
    if (cases.size() < 2) {
        gathered.note(records::Status::Missing,
                      fmt::format("equal needs two cases with '{}' and '{}'", query.equal->metric,
                                  query.metric));
        return {};
    }
    // Of what differs between processes one of them is one sample.
    const bool isOnce = std::ranges::any_of(cases, [&](const CurveCase& one) {
        const auto isOne = [&](const Samples& samples, const std::string& metric) {
            const bool differs = gathered.isInDoubt || config::isTimeMetric(metric);
            return differs && samples.processes.size() < 2;
        };
        return isOne(one.x, query.equal->metric) || isOne(one.y, query.metric);
    });
    std::vector<Measured> values;
    for (const auto& placeholder : query.format.placeholders()) {
        std::vector<CurvePoint> curve;
        for (const CurveCase& one : cases) {
            curve.push_back({sampledOf(one.x, placeholder), sampledOf(one.y, placeholder)});
        }
        Measured& measured = values.emplace_back();
        static_cast<Summary&>(measured) = readCurve(curve, query.equal->is);
        if (isOnce) takeAsOne(measured);
        measured.statistic = placeholder.name;
        if (std::isfinite(measured.value)) continue;
        gathered.note(records::Status::Missing,
                      whyNoValue(curve, query.equal->metric, query.equal->is));
        return {};
    }
    return values;
}

void fillEqual(const CellQuery& query, const LayoutCases& cases, Cell& cell) {
    for (const CaseRecords* run : casesAt(query.where, cases)) cell.caseIds.push_back(run->id);
    cell.isPlanned = !cell.caseIds.empty();
    const bool isOfTime = config::isTimeMetric(query.equal->metric);
    if (isOfTime && !cell.isTime) cell.timePower = 1;  // a budget in ms
    cell.isTime |= isOfTime;
    Gathered gathered;
    std::vector<const CaseRecords*> along;
    if (const auto axis = curveAxis(cell.pooled)) {
        along = casesAlong(cell.pooled[*axis].axis, query, cases);
        cell.pooled.erase(cell.pooled.begin() + static_cast<std::ptrdiff_t>(*axis));
    } else if (cell.isPlanned) {
        cell.lacksCurve = true;
        gathered.note(records::Status::Missing, "equal needs a swept axis of numbers in the cell");
    }
    if (std::ranges::count(cell.pooled, kSeedAxis, &Pooled::axis) > 0) {
        along.clear();
        gathered.note(records::Status::Missing,
                      "equal takes no swept seed: each process of an unswept one has another");
    }
    for (const std::string& metric : {query.metric, query.equal->metric}) {
        if (!cell.isPlanned || cases.recordedInstead(metric).empty()) continue;
        CellQuery other = query;
        other.metric = metric;
        gathered.note(records::Status::Missing, whyNothing(other, cases));
        cell.isMisnamed = true;
        along.clear();
    }
    if (!along.empty()) cell.values = equalValues(query, along, cases, gathered);
    addSampled(query, cases, gathered.frames.size(), cell);
    cell.status = gathered.worst;
    cell.message = gathered.message;
    if (!query.isScaled && gathered.units.size() == 1) cell.unit = *gathered.units.begin();
    if (!cell.values.empty()) {
        if (const auto other = byProcessTime(query)) {
            Gathered beside;
            cell.byProcess = equalValues(*other, along, cases, beside);
        }
        cell.seedCount = gathered.fewestSeeds;
        cell.scatters = cell.seedCount == 0 && gathered.isInDoubt;
        cell.isRunOnce = cell.scatters && gathered.isRunOnce;
        for (Measured& measured : cell.values) {
            if (cell.seedCount > 0 && cell.seedCount < measured.rounds.size()) takeAsOne(measured);
        }
        writeValues(query.format, cell);
    }
    writeStatus(records::statusName(cell.status), cell);
}

}  // namespace

std::size_t fewerSeeds(std::size_t a, std::size_t b) {
    return a == 0 || b == 0 ? std::max(a, b) : std::min(a, b);
}

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
    if (!selection.metric && !selection.of) {
        throw Error(selection.location, "no metric is given for the cell of row '" +
                                            joined(row, "_") + "', column '" + joined(column, "_") +
                                            "'; add `metric:` to its column, its row or `cell`");
    }
    return {selection.metric.value_or(""),
            selection.pass.value_or(""),
            CellFormat(selection.format.value_or(config::kDefaultCellFormat), selection.location),
            selection.scale.value_or(1.0),
            selection.scale.has_value(),
            selection.equal,
            false,
            std::move(where),
            selection.location};
}

Cell buildCell(const CellQuery& query, const LayoutCases& cases) {
    Cell cell;
    cell.isTime = config::isTimeMetric(query.metric);
    cell.timePower = config::timePower(query.metric);
    cell.pooled = pooledAt(query, cases);
    if (query.equal) {
        fillEqual(query, cases, cell);
        return cell;
    }
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
        const bool mayBeOfOthers = query.pass.empty() || cases.isOfProgram;
        cell.isMisnamed = !cases.recordedInstead(query.metric).empty() ||
                          (mayBeOfOthers && !whatIsThere(query, cases).passes.empty());
    }
    cell.status = gathered.worst;
    cell.message = gathered.message;
    cell.caseIds = gathered.caseIds;
    cell.isOwnTruth = config::isPictureError(query.metric) &&
                      std::ranges::any_of(cell.caseIds, [&](const std::string& id) {
                          return cases.ownTruths.contains({id, query.pass});
                      });
    if (!query.isScaled) {
        cell.metric = query.metric;
        if (gathered.units.size() == 1) cell.unit = *gathered.units.begin();
    }
    addSampled(query, cases, gathered.frames.size(), cell);
    if (hasSamples) {
        fillValues(query, gathered, cell);
        fillProcessTimes(query, cases, gathered.samples, cell);
        writeValues(query.format, cell);
    }
    const bool isTimed = !gathered.isUntimed || cell.status != records::Status::Ambiguous;
    const bool lacksSeeds = cell.values.empty() && cell.isOfOneSeed();
    const std::string_view word = isTimed ? records::statusName(cell.status) : "not timed";
    writeStatus(lacksSeeds ? "one seed" : word, cell);
    return cell;
}

SceneSource sceneSourceOf(const config::Layout& layout, const Key& row, const LayoutCases& cases) {
    config::Selection selection;
    Where where;
    layKeyOver(layout.rows, row, selection, where);
    SceneSource source = SceneSource::Unknown;
    for (const CaseRecords* run : casesAt(where, cases)) {
        for (const auto& [number, attempt] : run->processes) {
            const auto found = attempt.values("scene_source", "");
            if (found.empty()) continue;
            const double value = found.front()->value;
            const SceneSource here = value == 1.0   ? SceneSource::StandIn
                                     : value == 2.0 ? SceneSource::Generated
                                                    : SceneSource::Real;
            source = std::max(source, here);
        }
    }
    return source;
}

}  // namespace gfxrepro::tables
