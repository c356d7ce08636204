#include "runner/tables/layout_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <regex>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "runner/config/external_program.h"

namespace gfxrepro::tables {

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
    if (program.isNull()) return;
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
                    isSeeded && attempt.values(metric, row->pass).front()->frame != records::kSetup;
                if (isDeclared || !item.scatters(metric, row->pass)) continue;
                if (!item.isOfItsSeed(metric)) continue;
                cases.doubt.differing.insert(metric);
                if (cases.isOfProgram) cases.doubt.note(metric, row->unit);
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

void Doubt::note(const std::string& metric, std::string_view unit) {
    differing.insert(metric);
    // The order of parallel work moves what a device counts, and says nothing else.
    if (config::isOfDevice(metric)) return;
    (tables::isOfMachine(metric, unit) ? isOfMachine : isOfAll) = true;
}

bool Doubt::reaches(const std::string& metric, bool isMachine, bool isSetup,
                    bool isOfElsewhere) const {
    const bool isOfDevice = !isOfElsewhere && config::isOfDevice(metric);
    if (config::isTimeMetric(metric) || isOfDevice) return false;
    if (differing.contains(metric)) return true;
    const bool isKnown =
        !isOfElsewhere && (config::isTestOfMeans(metric) || config::isPictureError(metric));
    return !isSetup && !isKnown && (isOfAll || (isMachine && isOfMachine));
}

bool LayoutCases::isInDoubt(const std::string& metric, bool isSetup, bool isMachine) const {
    return doubt.reaches(metric, isMachine, isSetup, isOfElsewhere);
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
    cases.cases =
        groupByCase(planned, records, experiment.id, cases.axes, config::whenOf(experiment.sweep));
    cases.frameCount = experiment.measure.frames;
    cases.isOfElsewhere = !config::isMeasuredHere(experiment);
    cases.isOfProgram = config::goesByClock(experiment);
    for (CaseRecords& item : cases.cases) item.isOfElsewhere = cases.isOfElsewhere;
    if (cases.isOfProgram) countSweptSeeds(cases);
    for (CaseRecords& item : cases.cases) {
        const bool isSeeded = item.seeds != config::Measure::Seeds::None || item.sweptSeed;
        item.isRunOnce =
            cases.isOfProgram && !isSeeded && item.processes.size() == 1 && item.processesAsked > 1;
    }
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

std::map<std::string, Doubt> doubtsOf(std::span<const config::Experiment> experiments,
                                      std::span<const config::Case> planned,
                                      const std::vector<records::Record>& records) {
    std::map<std::string, std::vector<const config::Experiment*>> programs;
    for (const config::Experiment& experiment : experiments) {
        const bool isProgram = config::goesByClock(experiment);
        if (!isProgram || !config::isMeasuredHere(experiment)) continue;
        programs[config::programText(experiment)].push_back(&experiment);
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
