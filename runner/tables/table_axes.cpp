#include "runner/tables/table_axes.h"

#include <algorithm>
#include <numeric>

#include "engine/core/error.h"

namespace gfxrepro::tables {

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

}  // namespace

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
    const Node& sweep = experiment.sweep;
    cases.cases = groupByCase(planned, records, experiment.id, cases.axes,
                              sweep.isMap() ? sweep.find("when") : nullptr);
    cases.frameCount = experiment.measure.frames;
    std::vector<const AxisValues*> values;
    for (const CaseRecords& item : cases.cases) values.push_back(&item.axes);
    cases.index = CaseIndex(values);
    return cases;
}

std::vector<Key> collectKeys(const std::vector<config::LayoutAxis>& layoutAxes,
                             const LayoutCases& cases) {
    const bool hasFrames = std::any_of(layoutAxes.begin(), layoutAxes.end(), [](const auto& axis) {
        return axis.isSweepAxis() && axis.name == "frame";
    });
    std::vector<int> frames(hasFrames ? static_cast<std::size_t>(cases.frameCount) : 1);
    std::iota(frames.begin(), frames.end(), 0);
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
