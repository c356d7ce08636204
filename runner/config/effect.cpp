// Keys of which nothing would follow, or that stand in the wrong place.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/scene/catalog_entry.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/experiment.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

/// Whether each case of the scene has the parameter from the sweep.
bool isSweptOver(const Experiment& experiment, const std::string& scene, const std::string& name) {
    bool isUsed = false;
    for (const AxisPoint& point : expandSweep(experiment.sweep)) {
        const Node& own = sceneAt(point, experiment);
        if (!own.isScalar() || scene::sceneName(own.text()) != scene) continue;
        if (std::ranges::find(point, name, &Node::Entry::key) == point.end()) return false;
        isUsed = true;
    }
    return isUsed;
}

/// Scenes that cases have, by the names that configs give them.
void addScenes(const Experiment& experiment, std::set<std::string>& scenes) {
    for (const AxisPoint& point : expandSweep(experiment.sweep)) {
        const Node& scene = sceneAt(point, experiment);
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

/// What was measured elsewhere has its parameters, scenes and rounds from its own file.
std::vector<NoEffect> keysOfMeasuring(const Node& document) {
    const ContentKeys given = contentOf(document);
    const GivenKey frames = outputOf(document).frames;
    std::vector<NoEffect> found;
    for (const GivenKey* key : {&given.program, &given.scene, &given.sceneSeeds, &given.sceneParams,
                                &given.sceneInstead, &given.params, &given.paramsByScene,
                                &given.paramsInstead, &given.measure, &frames, &given.shows}) {
        if (!*key) continue;
        found.push_back({key->where(), fmt::format("'{}': nothing is measured with technique {}; "
                                                   "allowed: columns of the file that is imported",
                                                   key->name(), kImported)});
    }
    return found;
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
    if (experiment.technique == kImported) return keysOfMeasuring(experiment.document);
    if (!isMeasuredHere(experiment)) return {};
    std::vector<NoEffect> found;
    const auto require = [&](const Node* map, const char* key, bool hasEffect,
                             const std::string& why) {
        if (!map || !map->isMap() || !map->find(key) || hasEffect) return;
        found.push_back({map->keyLocation(key), fmt::format("'{}': {}", key, why)});
    };
    // A document's profiles share what a file says of rounds.
    const bool isSweep = experiment.kind == ExperimentKind::Sweep;
    const ContentKeys content = contentOf(experiment.document);
    const MeasureKeys measure = isSweep ? measureOf(experiment.document) : MeasureKeys();
    const auto requireGiven = [&](const GivenKey& key, bool hasEffect, const std::string& why) {
        if (!key || hasEffect) return;
        found.push_back({key.where(), fmt::format("'{}': {}", key.name(), why)});
    };
    const Measure& own = experiment.measure;
    requireGiven(measure.timeBudgetS, own.lane == Measure::Lane::Timing,
                 "in the quality lane no rounds are timed; allowed: lane: timing");
    requireGiven(measure.timeBudgetS,
                 own.isWithinBudget || own.mayContinue() || own.timeBudgetS == 0.0,
                 fmt::format("no rounds follow; allowed: with {} to {} 'processes', or without",
                             kFewestRounds, kMostRounds - 1));
    std::ranges::move(printedInVain(experiment), std::back_inserter(found));
    std::set<std::string> scenes;
    addScenes(experiment, scenes);
    requireGiven(content.sceneParams, !scenes.empty(), "no case has a scene");
    for (const auto& [scene, params] : experiment.paramsByScene.entries()) {
        const std::vector<std::string> known(scenes.begin(), scenes.end());
        require(
            &experiment.paramsByScene, scene.c_str(), scenes.contains(scene),
            fmt::format("no case has the scene of {}{}", kParamsByScene, suggestion(scene, known)));
        for (const auto& [name, value] : params.entries()) {
            require(&params, name.c_str(), !isSweptOver(experiment, scene, name),
                    fmt::format("each case of the scene has it from the sweep, which wins over {}",
                                kParamsByScene));
        }
    }
    for (const char* name : {kSceneAssumption, kSceneSeedAssumption}) {
        require(content.assumptions, name, !scenes.empty(), "no case has a scene");
    }
    addRanges(experiment, scenes, found);
    std::ranges::move(excludedInVain(experiment), std::back_inserter(found));
    return found;
}

void requireEffect(const Experiment& experiment) {
    for (const auto& found : {keysInVain(experiment), whenInVain(experiment)}) {
        for (const auto& [where, why] : found) {
            if (where.file.text() == experiment.file) throw Error(where, why);
        }
    }
}

void requireInSections(const Node& document, const Names& allowed) {
    for (const auto& [key, value] : document.entries()) {
        if (contains(allowed, key)) continue;
        for (const char* section : {"measure", "output", "layout", "printed"}) {
            if (!contains(keysOf(section), key)) continue;
            throw Error(
                document.keyLocation(key),
                fmt::format("config: '{0}' is of '{1}'; allowed: {1}: {{{0}: …}}", key, section));
        }
        // Of a model or a height map beside the file.
        if (contains(scene::ownFileParams(false), key) ||
            contains(scene::ownFileParams(true), key)) {
            throw Error(document.keyLocation(key),
                        fmt::format("config: '{0}' is of 'scene_params'; allowed: scene_params: "
                                    "{{{0}: {1}}}",
                                    key, value.toFlowText()));
        }
    }
}

namespace {

[[noreturn]] void refuseTimes(const Experiment& experiment, const SourceLocation& where,
                              const std::string& what) {
    const bool hasSeeds = experiment.measure.sceneSeeds > 1;
    throw Error(where, fmt::format("'{}' takes no times, and {}; allowed: {}",
                                   hasSeeds ? "scene_seeds" : "lane: quality", what,
                                   hasSeeds ? "scene_seeds: 1" : "lane: timing"));
}

}  // namespace

bool isLaneGivenBeside(const Experiment& experiment) {
    const Node* lane = measureOf(experiment.document).lane;
    return lane && lane->location().file.text() != experiment.file;
}

void refuseTimes(const Experiment& experiment, const ClaimSpec& claim) {
    refuseTimes(experiment, claim.location,
                fmt::format("claim '{}' reads '{}'", claim.id, joined(claim.operands, "', '")));
}

void requireTimed(const Experiment& experiment) {
    if (!isMeasuredHere(experiment) || experiment.measure.lane == Measure::Lane::Timing) return;
    const Node* lane = measureOf(experiment.document).lane;
    if (lane && !isLaneGivenBeside(experiment) && showsTimes(experiment.layout)) {
        refuseTimes(experiment, lane->location(), "the layout shows some");
    }
    if (!experiment.hasDefaultLayout() || isLaneGivenBeside(experiment)) return;
    for (const ClaimSpec& claim : experiment.claims) {
        std::vector<std::string> read = claim.operands;
        if (claim.over) read.push_back(*claim.over);
        for (const auto& [axis, columns] : claim.at) {
            for (const Node& column : columns) {
                if (axis == claims::kColumnAxis) read.push_back(column.text());
            }
        }
        for (const std::string& operand : read) {
            std::string name;
            for (const char c : operand + ' ') {
                if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
                    name += c;
                    continue;
                }
                if (isTimeMetric(name)) {
                    refuseTimes(experiment, claim.location,
                                fmt::format("claim '{}' reads '{}'", claim.id, name));
                }
                name.clear();
            }
        }
    }
}

}  // namespace gfxrepro::config
