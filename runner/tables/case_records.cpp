#include "runner/tables/case_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>
#include <set>
#include <unordered_map>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/metrics/alike.h"
#include "runner/config/experiment.h"
#include "runner/config/external_program.h"
#include "runner/records/csv.h"

namespace gfxrepro::tables {

// The records of each case.

namespace {

std::string textOf(const Node& node) {
    const nlohmann::ordered_json value = node.toJson();
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return records::shortestText(value.get<double>());
    return value.dump();
}

/// "output.width": an entry of that name, or of the map within the map.
const Node* findPath(const Node& map, std::string_view path) {
    if (!map.isMap()) return nullptr;
    if (const Node* found = map.find(path)) return found;
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos) return nullptr;
    const Node* inner = map.find(path.substr(0, dot));
    return inner ? findPath(*inner, path.substr(dot + 1)) : nullptr;
}

std::optional<std::string> valueIn(const Node& params, const std::string& axis) {
    const Node* value = findPath(params, axis);
    if (!value || value->isNull()) return std::nullopt;
    return textOf(*value);
}

/// A case as its records say it.
struct Recorded {
    std::string scene;
    Node params;

    std::optional<std::string> value(const std::string& axis) const {
        if (axis == "scene") {
            if (const auto named = valueIn(params, config::kStandsFor)) return named;
            if (!scene.empty()) return scene;
        }
        return valueIn(params, axis);
    }
};

/// The axes that the sweep's `when` leaves out of the case: its parameters have them with their
/// defaults.
std::set<std::string> leftOut(const Recorded& item, const Node& when) {
    std::set<std::string> names, conditional;
    for (const auto& [axis, conditions] : when.entries()) {
        conditional.insert(axis);
        names.insert(axis);
        for (const auto& [name, value] : conditions.entries()) names.insert(name);
    }
    config::AxisPoint point;
    for (const std::string& name : names) {
        if (const auto value = item.value(name)) point.emplace_back(name, Node::scalar(*value));
    }
    config::applyWhen(when, point);
    for (const auto& [name, value] : point) conditional.erase(name);
    return conditional;
}

AxisValues axesOf(const Recorded& item, const std::vector<std::string>& axes, const Node* when) {
    const std::set<std::string> absent = when ? leftOut(item, *when) : std::set<std::string>();
    AxisValues values;
    for (const std::string& axis : axes) {
        values.push_back(absent.contains(axis) ? std::string(kLeftOut) : item.value(axis));
    }
    return values;
}

/// What of a case's identity stays when its scene is taken at another seed.
std::string familyOf(const Recorded& item) {
    Node params = item.params;
    params.erase(config::kSceneSample);
    params.erase(config::kStandsFor);
    return valueIn(item.params, config::kStandsFor).value_or(item.scene) + params.toJson().dump();
}

bool isOfSetup(const records::Record* record) {
    return record->frame == records::kSetup;
}

/// Sorts by place; of several rows of one place the last stays.
void keepLast(std::vector<const records::Record*>& rows) {
    std::ranges::stable_sort(rows, {}, CaseRecords::placeOf);
    const auto kept = std::unique(rows.rbegin(), rows.rend(), [](const auto* a, const auto* b) {
        return CaseRecords::placeOf(a) == CaseRecords::placeOf(b);
    });
    rows.erase(rows.begin(), kept.base());
    rows.shrink_to_fit();
}

}  // namespace

std::string canonicalText(const Node& value) {
    return value.isMap() ? value.toFlowText() : textOf(value);
}

std::vector<const records::Record*> CaseRecords::Attempt::values(std::string_view metric,
                                                                 std::string_view pass) const {
    std::vector<const records::Record*> values;
    const Place first{metric, pass, INT_MIN, INT_MIN};
    for (auto row = std::ranges::lower_bound(rows, first, {}, placeOf);
         row != rows.end() && (*row)->metric == metric && (*row)->pass == pass; ++row) {
        // In the order of frames: set-up's value comes first, and goes when a frame has one.
        if ((*row)->frame != records::kSetup) std::erase_if(values, isOfSetup);
        values.push_back(*row);
    }
    return values;
}

std::string CaseRecords::passOf(std::string_view metric) const {
    for (const auto& [number, attempt] : processes) {
        const Place first{metric, "", INT_MIN, INT_MIN};
        const auto row = std::ranges::lower_bound(attempt.rows, first, {}, placeOf);
        if (row != attempt.rows.end() && (*row)->metric == metric) return (*row)->pass;
    }
    return "";
}

bool CaseRecords::scatters(std::string_view metric, std::string_view pass) const {
    std::map<std::pair<int, int>, double> first;  // by the scene's seed and the frame
    for (const auto& [number, attempt] : processes) {
        if (attempt.failure) continue;
        for (const records::Record* row : attempt.values(metric, pass)) {
            const auto [found, isNew] =
                first.try_emplace({number / records::kMostProcesses, row->frame}, row->value);
            if (!metrics::areAlike(found->second, row->value)) return true;
        }
    }
    return false;
}

bool CaseRecords::isTakenAgain(std::string_view metric, std::string_view pass) const {
    std::map<std::pair<int, int>, std::size_t> counts;  // by the scene's seed and the frame
    for (const auto& [number, attempt] : processes) {
        for (const records::Record* row : attempt.values(metric, pass)) {
            ++counts[{number / records::kMostProcesses, row->frame}];
        }
    }
    const bool isOfEach =
        std::ranges::all_of(counts, [](const auto& entry) { return entry.second > 1; });
    return isOfEach || (!isOfElsewhere && processes.size() > 1);
}

bool CaseRecords::isWithout(std::string_view metric, std::string_view pass) const {
    return !processes.empty() && std::ranges::all_of(processes, [&](const auto& process) {
        return !process.second.failure && process.second.values(metric, pass).empty();
    });
}

bool CaseRecords::isOfItsSeed(std::string_view metric) const {
    const bool isOurs = config::isOfDevice(metric) || config::isTestOfMeans(metric);
    return !config::isTimeMetric(metric) && (isOfElsewhere || !isOurs);
}

std::vector<CaseRecords> groupByCase(std::span<const config::Case> planned,
                                     const std::vector<records::Record>& records,
                                     std::string_view table, const std::vector<std::string>& axes,
                                     const Node* when) {
    struct Place {
        std::size_t index;  // in `cases`
        int sample;
    };
    std::vector<CaseRecords> cases;
    std::vector<bool> isSeeded;
    std::unordered_map<std::string_view, Place> places;  // by the case's id
    std::unordered_map<std::string, std::size_t> families;
    for (const config::Case& item : planned) {
        if (item.experiment != table) continue;
        const std::optional<int> sample = item.sceneSample;
        Recorded recorded{item.recordedScene(), item.recordedParams()};
        const std::size_t next = cases.size();
        const std::size_t index =
            sample ? families.try_emplace(familyOf(recorded), next).first->second : next;
        if (index == next) {
            AxisValues values = axesOf(recorded, axes, when);
            cases.push_back({item.id,
                             std::move(values),
                             {},
                             std::move(recorded.scene),
                             std::move(recorded.params),
                             item.measure.seeds,
                             item.seed});
            isSeeded.push_back(sample.has_value());
        }
        places[item.id] = {index, sample.value_or(0)};
        cases[index].sceneSeeds = std::max(cases[index].sceneSeeds, sample.value_or(0) + 1);
    }
    int seedCount = 1;
    for (const records::Record& record : records) {
        const auto found = places.find(record.caseId);
        if (found == places.end()) continue;  // of another table
        const auto [index, sample] = found->second;
        seedCount = std::max(seedCount, sample + 1);
        CaseRecords::Attempt& attempt =
            cases[index].processes[sample * records::kMostProcesses + record.process];
        if (record.status != records::Status::Ok && std::isnan(record.value)) {
            attempt.rows.clear();
            attempt.failure = &record;
        } else {
            attempt.failure = nullptr;
            attempt.rows.push_back(&record);
        }
    }
    for (CaseRecords& one : cases) {
        for (auto& [process, attempt] : one.processes) keepLast(attempt.rows);
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (isSeeded[i]) continue;
        const auto once = cases[i].processes;
        cases[i].isRepeated = seedCount > 1 && once.size() > 1;
        for (int seed = 1; seed < seedCount; ++seed) {
            for (const auto& [process, attempt] : once) {
                cases[i].processes[seed * records::kMostProcesses + process] = attempt;
            }
        }
    }
    return cases;
}

// Rows and columns, and the cases at each.

namespace {

/// Each frame of a case is a point of its own where `frame` is an axis.
void addPoints(const AxisValues& values, const LayoutCases& cases,
               const std::vector<config::LayoutAxis>& layoutAxes, const std::set<int>& frames,
               std::vector<Key>& points) {
    for (const int frame : frames) {
        Key point;
        for (const config::LayoutAxis& axis : layoutAxes) {
            if (!axis.isSweepAxis()) continue;
            if (axis.name == "frame") {
                point.push_back(std::to_string(frame));
            } else if (const auto& value = values[cases.indexOf(axis.name)]) {
                point.push_back(*value);
            } else {
                return;
            }
        }
        points.push_back(std::move(point));
    }
}

/// Lays the labels of labelled axes between the values of the sweep axes: every combination.
std::vector<Key> withLabels(const std::vector<Key>& points,
                            const std::vector<config::LayoutAxis>& layoutAxes) {
    std::vector<Key> keys;
    for (const Key& point : points) {
        std::vector<Key> partial = {{}};
        std::size_t next = 0;
        for (const config::LayoutAxis& axis : layoutAxes) {
            Key choices;
            if (axis.isSweepAxis()) {
                choices.push_back(point[next++]);
            } else {
                for (const auto& [label, selection] : axis.labels) choices.push_back(label);
            }
            std::vector<Key> longer;
            for (const Key& key : partial) {
                for (const std::string& choice : choices) {
                    longer.push_back(key);
                    longer.back().push_back(choice);
                }
            }
            partial = std::move(longer);
        }
        keys.insert(keys.end(), partial.begin(), partial.end());
    }
    return keys;
}

void addAxis(std::vector<std::string>& axes, const std::string& name) {
    if (name == "frame" || std::find(axes.begin(), axes.end(), name) != axes.end()) return;
    axes.push_back(name);
}

void addAxesOf(const config::Selection& selection, std::vector<std::string>& axes) {
    for (const auto& [axis, value] : selection.where) addAxis(axes, axis);
}

bool matches(const AxisValues& values, const LayoutCases& cases, const Where& where) {
    for (const auto& [axis, allowed] : where) {
        if (axis == "frame") continue;
        const auto& value = values[cases.indexOf(axis)];
        if (!value || std::ranges::find(allowed, *value) == allowed.end()) return false;
    }
    return true;
}

/// The places of the cases that may lie there: those that fit on the axis that leaves the fewest.
std::vector<std::size_t> candidates(const LayoutCases& cases, const Where& where) {
    std::optional<std::size_t> best;
    const std::vector<std::string>* values = nullptr;
    std::size_t fewest = 0;
    for (const auto& [name, allowed] : where) {
        if (name == "frame") continue;
        const std::size_t axis = cases.indexOf(name);
        const std::size_t count = cases.index.countOf(axis, allowed);
        if (best && count >= fewest) continue;
        best = axis;
        fewest = count;
        values = &allowed;
    }
    if (best) return cases.index.placesOf(*best, *values);
    std::vector<std::size_t> all(cases.index.caseCount());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

/// Counts the values of a swept seed: all together where some are shared, but from 0 among cases
/// that share none with others. These are independent, and stand beside each other in any order. A
/// case that the sweep leaves without a seed draws nothing.
void countSweptSeeds(LayoutCases& cases) {
    const auto axis = std::ranges::find(cases.axes, kSeedAxis) - cases.axes.begin();
    if (axis == std::ssize(cases.axes)) return;
    const auto seedOf = [axis](CaseRecords& item) -> std::optional<std::string>& {
        return item.axes[static_cast<std::size_t>(axis)];
    };
    std::map<AxisValues, std::vector<CaseRecords*>> alike;  // but for the seed
    for (CaseRecords& item : cases.cases) {
        if (seedOf(item) == kLeftOut) item.seeds = config::Measure::Seeds::None;
        if (item.processes.empty() || !seedOf(item) || seedOf(item) == kLeftOut) continue;
        AxisValues others = item.axes;
        others[static_cast<std::size_t>(axis)].reset();
        alike[others].push_back(&item);
    }
    std::map<std::string, int> families;  // of each seed
    int next = 0;
    bool isTakenOnce = true;
    for (const auto& [others, items] : alike) {
        const int own = next++;
        for (CaseRecords* item : items) {
            isTakenOnce &= item->processes.size() == 1;
            const int family = families.try_emplace(*seedOf(*item), own).first->second;
            if (family == own) continue;
            for (auto& [seed, one] : families) one = one == family ? own : one;
        }
    }
    std::map<int, std::map<std::string, int>> places;
    for (CaseRecords& item : cases.cases) {
        const auto family = families.find(seedOf(item).value_or(""));
        if (family == families.end() || item.processes.empty()) continue;
        std::map<std::string, int>& own = places[family->second];
        item.sweptSeed = own.try_emplace(family->first, static_cast<int>(own.size())).first->second;
        item.isSeedARun = isTakenOnce;
    }
}

void findOwnTruths(const config::Experiment& experiment, std::span<const config::Case> planned,
                   LayoutCases& cases) {
    const Node& program = config::programOf(experiment);
    if (!program.isMap() || !program.find("images")) return;
    for (const config::ProgramPicture& picture : config::readProgram(program).pictures) {
        if (picture.truthParams.isNull()) continue;
        for (const config::Case& item : planned) {
            const bool isOwn =
                item.experiment == experiment.id && config::isOwnTruth(item, picture.truthParams);
            if (isOwn) cases.ownTruths.emplace(item.id, picture.name);
        }
    }
}

/// Which metrics there are, and which came to other values when they were taken again, with no
/// seed declared.
void lookAtMetrics(LayoutCases& cases) {
    for (const CaseRecords& item : cases.cases) {
        std::set<std::pair<std::string_view, std::string_view>> seen;
        for (const auto& [number, attempt] : item.processes) {
            const records::Record* last = nullptr;
            for (const records::Record* row : attempt.rows) {
                const bool isAgain = last && last->metric == row->metric && last->pass == row->pass;
                last = row;
                if (row->frame != records::kSetup) cases.frames.insert(row->frame);
                if (isAgain || !seen.emplace(row->metric, row->pass).second) continue;
                const std::string& metric = row->metric;
                cases.recorded.insert(metric);
                const bool isSeeded = item.seeds != config::Measure::Seeds::None;
                const bool isDeclared =
                    isSeeded && !isOfSetup(attempt.values(metric, row->pass).front());
                if (isDeclared || !item.scatters(metric, row->pass)) continue;
                if (!item.isOfItsSeed(metric)) continue;
                cases.doubt.differing.insert(metric);
                // The order of parallel work moves what a device counts, and says nothing else.
                if (!cases.isOfProgram || config::isOfDevice(metric)) continue;
                (isOfMachine(metric, row->unit) ? cases.doubt.isOfMachine : cases.doubt.isOfAll) =
                    true;
            }
        }
    }
}

}  // namespace

bool isOfMachine(std::string_view metric, std::string_view unit) {
    static const std::regex kUnits(
        "([kmgt]i?)?(b|bytes?)|(kilo|mega|giga|tera|kibi|mebi|gibi|tebi)bytes?|[kmgt]i"
        "|([numkg]|µ)?(j|w|wh|hz)|joules?|watts?|°c|degc|celsius",
        std::regex::icase);
    return metric.find("memory") != metric.npos ||
           std::regex_match(unit.begin(), unit.end(), kUnits);
}

void Doubt::add(const Doubt& other) {
    differing.insert(other.differing.begin(), other.differing.end());
    isOfAll |= other.isOfAll;
    isOfMachine |= other.isOfMachine;
}

bool LayoutCases::isInDoubt(const std::string& metric, bool isSetup, bool isMachine) const {
    const bool isOfDevice = !isOfElsewhere && config::isOfDevice(metric);
    if (config::isTimeMetric(metric) || isOfDevice) return false;
    if (doubt.differing.contains(metric)) return true;
    const bool isKnown =
        !isOfElsewhere && (config::isTestOfMeans(metric) || config::isPictureError(metric));
    if (!isOfProgram || isSetup || isKnown) return false;
    return doubt.isOfAll || (isMachine && doubt.isOfMachine);
}

std::string LayoutCases::recordedInstead(const std::string& metric) const {
    if (!isOfElsewhere || recorded.empty() || recorded.contains(metric)) return "";
    const std::vector<std::string> names(recorded.begin(), recorded.end());
    return fmt::format("{} (recorded: {})", suggestion(metric, names), joined(names));
}

CaseIndex::CaseIndex(const std::vector<const AxisValues*>& cases) : caseCount_(cases.size()) {
    for (std::size_t place = 0; place < cases.size(); ++place) {
        const AxisValues& values = *cases[place];
        axes_.resize(std::max(axes_.size(), values.size()));
        for (std::size_t axis = 0; axis < values.size(); ++axis) {
            if (values[axis]) axes_[axis][*values[axis]].push_back(place);
        }
    }
}

std::size_t CaseIndex::countOf(std::size_t axis, const std::vector<std::string>& values) const {
    if (axis >= axes_.size()) return 0;
    std::size_t count = 0;
    for (const std::string& value : values) {
        const auto found = axes_[axis].find(value);
        if (found != axes_[axis].end()) count += found->second.size();
    }
    return count;
}

std::vector<std::size_t> CaseIndex::placesOf(std::size_t axis,
                                             const std::vector<std::string>& values) const {
    if (axis >= axes_.size()) return {};
    std::vector<std::size_t> places;
    for (const std::string& value : values) {
        const auto found = axes_[axis].find(value);
        if (found == axes_[axis].end()) continue;
        places.insert(places.end(), found->second.begin(), found->second.end());
    }
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

std::size_t LayoutCases::indexOf(const std::string& axis) const {
    const auto found = std::find(axes.begin(), axes.end(), axis);
    GFXREPRO_ASSERT(found != axes.end());
    return static_cast<std::size_t>(found - axes.begin());
}

std::vector<const CaseRecords*> casesAt(const Where& where, const LayoutCases& cases) {
    std::vector<const CaseRecords*> found;
    for (const std::size_t place : candidates(cases, where)) {
        const CaseRecords& item = cases.cases[place];
        if (matches(item.axes, cases, where)) found.push_back(&item);
    }
    return found;
}

LayoutCases gatherCases(const config::Experiment& experiment, std::span<const config::Case> planned,
                        const std::vector<records::Record>& records) {
    LayoutCases cases;
    const config::Layout& layout = experiment.layout;
    for (const auto* axes : {&layout.rows, &layout.columns}) {
        for (const config::LayoutAxis& axis : *axes) {
            if (axis.isSweepAxis()) addAxis(cases.axes, axis.name);
            for (const auto& [label, selection] : axis.labels) addAxesOf(selection, cases.axes);
        }
    }
    addAxesOf(layout.cell, cases.axes);
    cases.namedAxes = cases.axes.size();
    for (const config::Case& item : planned) {
        if (item.experiment != experiment.id || !item.axes.isMap()) continue;
        for (const auto& [axis, value] : item.axes.entries()) addAxis(cases.axes, axis);
    }
    const Node& sweep = experiment.sweep;
    cases.cases = groupByCase(planned, records, experiment.id, cases.axes,
                              sweep.isMap() ? sweep.find("when") : nullptr);
    cases.frameCount = experiment.measure.frames;
    cases.isOfElsewhere = !config::isMeasuredHere(experiment);
    cases.isOfProgram = config::goesByClock(experiment);
    for (CaseRecords& item : cases.cases) item.isOfElsewhere = cases.isOfElsewhere;
    if (cases.isOfProgram) countSweptSeeds(cases);
    lookAtMetrics(cases);
    for (int frame = 0; frame < cases.frameCount; ++frame) {
        if (!cases.isOfElsewhere || cases.recorded.empty()) cases.frames.insert(frame);
    }
    findOwnTruths(experiment, planned, cases);
    std::vector<const AxisValues*> values;
    for (const CaseRecords& item : cases.cases) values.push_back(&item.axes);
    cases.index = CaseIndex(values);
    return cases;
}

namespace {

/// What tells a program from another: how it is started, and what prints its version.
std::string programText(const config::Experiment& experiment) {
    const Node& program = config::programOf(experiment);
    std::string text;
    const auto add = [&](const char* key) {
        const Node* value = program.isMap() ? program.find(key) : nullptr;
        if (value) text += value->toJson().dump() + '\n';
    };
    add("command");
    add("version");
    if (text.find("{here}") != text.npos) add("here");
    return text;
}

}  // namespace

std::map<std::string, Doubt> doubtsOf(std::span<const config::Experiment> experiments,
                                      std::span<const config::Case> planned,
                                      const std::vector<records::Record>& records) {
    std::map<std::string, std::vector<const config::Experiment*>> programs;
    for (const config::Experiment& experiment : experiments) {
        const bool isProgram = config::goesByClock(experiment);
        if (!isProgram || !config::isMeasuredHere(experiment)) continue;
        programs[programText(experiment)].push_back(&experiment);
    }
    std::map<std::string, Doubt> doubts;
    for (const auto& [text, own] : programs) {
        if (own.size() < 2) continue;  // each table knows its own
        Doubt all;
        for (const auto* one : own) all.add(gatherCases(*one, planned, records).doubt);
        for (const auto* one : own) doubts[one->id] = all;
    }
    return doubts;
}

std::vector<Key> collectKeys(const std::vector<config::LayoutAxis>& layoutAxes,
                             const LayoutCases& cases) {
    const bool hasFrames = std::any_of(layoutAxes.begin(), layoutAxes.end(), [](const auto& axis) {
        return axis.isSweepAxis() && axis.name == "frame";
    });
    const std::set<int> frames = hasFrames ? cases.frames : std::set<int>{0};
    std::vector<Key> points;
    for (const CaseRecords& item : cases.cases) {
        addPoints(item.axes, cases, layoutAxes, frames, points);
    }
    const bool hasSweepAxis = std::any_of(layoutAxes.begin(), layoutAxes.end(),
                                          [](const auto& axis) { return axis.isSweepAxis(); });
    if (!hasSweepAxis) points = {{}};

    // The rank of a value on its axis is the order in which it first occurred.
    std::vector<std::map<std::string, std::size_t>> ranks(layoutAxes.size());
    std::map<std::vector<std::size_t>, Key> sorted;
    for (Key& key : withLabels(points, layoutAxes)) {
        std::vector<std::size_t> rank;
        for (std::size_t i = 0; i < key.size(); ++i) {
            rank.push_back(ranks[i].try_emplace(key[i], ranks[i].size()).first->second);
        }
        sorted.try_emplace(std::move(rank), std::move(key));
    }
    std::vector<Key> keys;
    for (auto& [rank, key] : sorted) keys.push_back(std::move(key));
    return keys;
}

}  // namespace gfxrepro::tables
