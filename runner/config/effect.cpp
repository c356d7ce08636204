// Keys of which nothing would follow.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/experiment.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

/// Scenes that cases have, by the names that configs give them.
void addScenes(const Experiment& experiment, std::set<std::string>& scenes) {
    for (const AxisPoint& point : expandSweep(experiment.sweep)) {
        const auto swept = std::ranges::find(point, "scene", &Node::Entry::key);
        const Node& scene = swept == point.end() ? experiment.scene : swept->value;
        if (!scene.isScalar()) continue;
        scenes.insert(scene.text());
        scenes.insert(scene::sceneName(scene.text()));
    }
}

/// Scenes of the cases in whose place an assumption has others, also of profile `paper` alone.
void addRanges(const Experiment& experiment, std::set<std::string> scenes,
               std::vector<NoEffect>& found) {
    if (!experiment.paperDocument.isNull()) {
        addScenes(experimentFromDocument(experiment.paperDocument, experiment.file), scenes);
    }
    for (const Assumption& assumption : experiment.assumptions) {
        if (assumption.name != kSceneAssumption || !assumption.range.isMap()) continue;
        for (const auto& [scene, others] : assumption.range.entries()) {
            if (scenes.contains(scene)) continue;
            found.push_back(
                {assumption.range.keyLocation(scene),
                 fmt::format("assumption '{}': range: '{}' is no scene of {}; it has {}",
                             assumption.name, scene, experiment.id,
                             joined(Names(scenes.begin(), scenes.end())))});
        }
    }
}

}  // namespace

bool showsTimes(const Layout& layout) {
    const auto isOfTime = [](const Selection& selection) {
        return (selection.metric && isTimeMetric(*selection.metric)) ||
               (selection.equal && isTimeMetric(selection.equal->metric));
    };
    const auto hasTime = [&](const LayoutAxis& axis) {
        return std::ranges::any_of(axis.labels,
                                   [&](const auto& label) { return isOfTime(label.second); });
    };
    return isOfTime(layout.cell) || std::ranges::any_of(layout.rows, hasTime) ||
           std::ranges::any_of(layout.columns, hasTime);
}

std::vector<NoEffect> keysInVain(const Experiment& experiment) {
    if (!isMeasuredHere(experiment)) return {};
    std::vector<NoEffect> found;
    const Node& document = experiment.document;
    const auto require = [&](const Node* map, const char* key, bool hasEffect,
                             const std::string& why) {
        if (!map || !map->isMap() || !map->find(key) || hasEffect) return;
        found.push_back({map->keyLocation(key), fmt::format("'{}': {}", key, why)});
    };
    // A document's profiles share what a file says of rounds.
    const bool isSweep = experiment.kind == Experiment::Kind::Sweep;
    const Node* measure = isSweep ? document.find("measure") : nullptr;
    const Measure& own = experiment.measure;
    const bool isTimed = own.lane == Measure::Lane::Timing;
    for (const char* key : {"relative_error", "time_budget_s", "processes_at_most"}) {
        require(measure, key, isTimed,
                "in the quality lane no rounds are timed; allowed: lane: timing");
    }
    require(measure, "processes_at_most", own.mayContinue(),
            "no more rounds follow than 'processes' asks for; allowed: with 'relative_error', and "
            "more than 'processes', of which there are 6 or more");
    std::set<std::string> scenes;
    addScenes(experiment, scenes);
    require(&document, "scene_params", !scenes.empty(), "no case has a scene");
    for (const auto& [scene, params] : experiment.paramsByScene.entries()) {
        const std::vector<std::string> known(scenes.begin(), scenes.end());
        require(&experiment.paramsByScene, scene.c_str(), scenes.contains(scene),
                "no case has the scene of params_by_scene" + suggestion(scene, known));
    }
    for (const char* name : {kSceneAssumption, kSceneSeedAssumption}) {
        require(document.find("assumptions"), name, !scenes.empty(), "no case has a scene");
    }
    addRanges(experiment, scenes, found);
    std::ranges::move(excludedInVain(experiment), std::back_inserter(found));
    return found;
}

void requireEffect(const Experiment& experiment) {
    for (const auto& [where, why] : keysInVain(experiment)) {
        if (where.file.text() == experiment.file) throw Error(where, why);
    }
}

void requireTimed(const Experiment& experiment) {
    if (!isMeasuredHere(experiment) || experiment.measure.lane == Measure::Lane::Timing) return;
    const Node* measure = experiment.document.find("measure");
    const Node* lane = measure && measure->isMap() ? measure->find("lane") : nullptr;
    const bool isOwn = lane && lane->location().file.text() == experiment.file;
    const auto refuse = [&](const SourceLocation& where, const std::string& what) {
        throw Error(
            where,
            fmt::format("'lane: quality' takes no times, and {}; allowed: lane: timing", what));
    };
    if (isOwn && showsTimes(experiment.layout)) refuse(lane->location(), "the layout shows some");
    if (!experiment.hasDefaultLayout()) return;
    for (const ClaimSpec& claim : experiment.claims) {
        for (const std::string& operand : claim.operands) {
            std::string name;
            for (const char c : operand + ' ') {
                if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
                    name += c;
                    continue;
                }
                if (isTimeMetric(name)) {
                    refuse(claim.location, fmt::format("claim '{}' reads '{}'", claim.id, name));
                }
                name.clear();
            }
        }
    }
}

}  // namespace gfxrepro::config
