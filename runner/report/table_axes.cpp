#include "runner/report/table_axes.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "runner/core/error.h"

namespace gfxrepro::report {

namespace {

/// Each frame of a case is a point of its own where `frame` is an axis.
void addPoints(const AxisValues& values, const LayoutCases& cases,
               const std::vector<config::LayoutAxis>& layoutAxes, const std::vector<int>& frames,
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

std::vector<int> framesOf(const CaseRecords& run) {
    std::set<int> frames;
    for (const auto& [process, attempt] : run.processes) {
        for (const auto& [place, record] : attempt.rows) {
            if (place.frame != kSetup) frames.insert(place.frame);
        }
    }
    return {frames.begin(), frames.end()};
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

/// The places of the cases that may lie there: those that fit on the axis that leaves the fewest.
std::vector<std::size_t> candidates(const LayoutCases& cases, const CaseIndex& index,
                                    const Where& where) {
    std::optional<std::size_t> best;
    const std::vector<std::string>* values = nullptr;
    std::size_t fewest = 0;
    for (const auto& [name, allowed] : where) {
        if (name == "frame") continue;
        const std::size_t axis = cases.indexOf(name);
        const std::size_t count = index.countOf(axis, allowed);
        if (best && count >= fewest) continue;
        best = axis;
        fewest = count;
        values = &allowed;
    }
    if (best) return index.placesOf(*best, *values);
    std::vector<std::size_t> all(index.caseCount());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

}  // namespace

CaseIndex::CaseIndex(const std::vector<const AxisValues*>& cases) : caseCount_(cases.size()) {
    for (std::size_t place = 0; place < cases.size(); ++place) {
        const AxisValues& values = *cases[place];
        axes_.resize(std::max(axes_.size(), values.size()));
        for (std::size_t axis = 0; axis < values.size(); ++axis) {
            Axis& own = axes_[axis];
            (values[axis] ? own.places[*values[axis]] : own.unknown).push_back(place);
        }
    }
}

std::size_t CaseIndex::countOf(std::size_t axis, const std::vector<std::string>& values) const {
    if (axis >= axes_.size()) return 0;
    std::size_t count = axes_[axis].unknown.size();
    for (const std::string& value : values) {
        const auto found = axes_[axis].places.find(value);
        if (found != axes_[axis].places.end()) count += found->second.size();
    }
    return count;
}

std::vector<std::size_t> CaseIndex::placesOf(std::size_t axis,
                                             const std::vector<std::string>& values) const {
    if (axis >= axes_.size()) return {};
    std::vector<std::size_t> places = axes_[axis].unknown;
    for (const std::string& value : values) {
        const auto found = axes_[axis].places.find(value);
        if (found == axes_[axis].places.end()) continue;
        places.insert(places.end(), found->second.begin(), found->second.end());
    }
    std::ranges::sort(places);
    places.erase(std::ranges::unique(places).begin(), places.end());
    return places;
}

void LayoutCases::makeIndices() {
    std::vector<const AxisValues*> plannedAxes, runAxes;
    for (const PlannedCase& one : planned) plannedAxes.push_back(&one.axes);
    for (const CaseRecords& one : run) runAxes.push_back(&one.axes);
    plannedIndex = CaseIndex(plannedAxes);
    runIndex = CaseIndex(runAxes);
}

std::size_t LayoutCases::indexOf(const std::string& axis) const {
    const auto found = std::find(axes.begin(), axes.end(), axis);
    GFXREPRO_ASSERT(found != axes.end());
    return static_cast<std::size_t>(found - axes.begin());
}

bool matches(const AxisValues& values, const LayoutCases& cases, const Where& where,
             bool isUnknownMatching) {
    for (const auto& [axis, allowed] : where) {
        if (axis == "frame") continue;
        const auto& value = values[cases.indexOf(axis)];
        const bool isMatching =
            value ? std::find(allowed.begin(), allowed.end(), *value) != allowed.end()
                  : isUnknownMatching;
        if (!isMatching) return false;
    }
    return true;
}

std::vector<const CaseRecords*> casesAt(const Where& where, const LayoutCases& cases) {
    std::vector<const CaseRecords*> found;
    for (const std::size_t place : candidates(cases, cases.runIndex, where)) {
        const CaseRecords& run = cases.run[place];
        if (matches(run.axes, cases, where, false)) found.push_back(&run);
    }
    return found;
}

std::vector<const PlannedCase*> plannedAt(const Where& where, const LayoutCases& cases) {
    std::vector<const PlannedCase*> found;
    for (const std::size_t place : candidates(cases, cases.plannedIndex, where)) {
        const PlannedCase& planned = cases.planned[place];
        if (matches(planned.axes, cases, where, true)) found.push_back(&planned);
    }
    return found;
}

LayoutCases gatherCases(const config::Experiment& experiment, const std::vector<Record>& records) {
    LayoutCases cases;
    const config::Layout& layout = experiment.layout;
    for (const auto* axes : {&layout.rows, &layout.columns}) {
        for (const config::LayoutAxis& axis : *axes) {
            if (axis.isSweepAxis()) addAxis(cases.axes, axis.name);
            for (const auto& [label, selection] : axis.labels) addAxesOf(selection, cases.axes);
        }
    }
    addAxesOf(layout.cell, cases.axes);
    cases.planned = planCases(experiment, cases.axes);
    cases.run = groupByCase(records, experiment.id, cases.axes);
    cases.frameCount = experiment.measure.frames;
    cases.makeIndices();
    return cases;
}

std::vector<Key> collectKeys(const std::vector<config::LayoutAxis>& layoutAxes,
                             const LayoutCases& cases) {
    const bool hasFrames = std::any_of(layoutAxes.begin(), layoutAxes.end(), [](const auto& axis) {
        return axis.isSweepAxis() && axis.name == "frame";
    });
    std::vector<int> plannedFrames(hasFrames ? static_cast<std::size_t>(cases.frameCount) : 1);
    std::iota(plannedFrames.begin(), plannedFrames.end(), 0);
    std::vector<Key> points;
    for (const PlannedCase& planned : cases.planned) {
        addPoints(planned.axes, cases, layoutAxes, plannedFrames, points);
    }
    for (const CaseRecords& run : cases.run) {
        addPoints(run.axes, cases, layoutAxes, hasFrames ? framesOf(run) : plannedFrames, points);
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

}  // namespace gfxrepro::report
