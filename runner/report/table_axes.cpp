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

}  // namespace

std::size_t LayoutCases::indexOf(const std::string& axis) const {
    const auto found = std::find(axes.begin(), axes.end(), axis);
    GFXREPRO_ASSERT(found != axes.end());
    return static_cast<std::size_t>(found - axes.begin());
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
