#include "runner/config/case.h"

#include <algorithm>

#include "engine/core/checks.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/experiment.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

const Node& sceneAt(const AxisPoint& point, const Experiment& experiment) {
    const auto swept = std::ranges::find(point, "scene", &Node::Entry::key);
    return swept == point.end() ? experiment.scene : swept->value;
}

/// `params` with those of the scene laid over.
Node paramsOf(const Node& scene, const Experiment& experiment) {
    Node params = experiment.params;
    const Node* own =
        scene.isScalar() ? experiment.paramsByScene.find(scene::sceneName(scene.text())) : nullptr;
    if (!own) return params;
    for (const auto& [name, value] : own->entries()) {
        params.set(name, value, own->keyLocation(name));
    }
    return params;
}

}  // namespace

int outputSize(const Node& value, std::string_view axis) {
    const auto size = value.tryInteger();
    if (!size || *size < 1 || *size > kMaxOutputPx) {
        throwNotAllowed(value, axis, "a whole number, 1 … 16384 pixels");
    }
    return static_cast<int>(*size);
}

std::vector<Case> expandCases(const Experiment& experiment) {
    std::vector<Case> cases;
    if (experiment.technique.empty()) return cases;
    for (AxisPoint& point : expandSweep(experiment.sweep)) {
        Case item;
        item.experiment = experiment.id;
        item.technique = experiment.technique;
        item.measure = experiment.measure;
        item.scene = sceneAt(point, experiment);
        item.given = paramsOf(item.scene, experiment);
        item.params = Node::map({});
        for (const auto& [name, value] : experiment.sceneParams.entries()) {
            item.params.set(std::string(kSceneAxisPrefix) + name, value,
                            experiment.sceneParams.keyLocation(name));
        }
        item.outputWidthPx = experiment.outputWidthPx;
        item.outputHeightPx = experiment.outputHeightPx;
        for (const auto& [axis, value] : point) {
            if (axis == "scene") continue;
            if (axis.starts_with(kSceneAxisPrefix)) {
                item.params.set(axis, value, value.location());
            } else if (axis == "output.width") {
                item.outputWidthPx = outputSize(value, axis);
            } else if (axis == "output.height") {
                item.outputHeightPx = outputSize(value, axis);
            } else {
                item.given.set(axis, value);
            }
        }
        item.axes = Node::map(std::move(point));
        cases.push_back(std::move(item));
    }
    return cases;
}

std::string Case::title() const {
    std::string title = experiment;
    if (!axes.isMap()) return title;
    for (const auto& [name, value] : axes.entries()) {
        title += ' ' + name + '=' + (value.isScalar() ? value.text() : value.toFlowText());
    }
    // A file with its units is no other scene.
    const bool isOther = !standsFor.isNull() && !scene::isSceneFile(scene.text());
    if (isOther) title += " (" + scene.text() + ")";
    return title;
}

std::string Case::slug() const {
    std::string slug = experiment;
    std::replace(slug.begin(), slug.end(), '/', '-');
    return slug;
}

std::string Case::method() const {
    const Node* method = params.find("method");
    return method ? method->text() : "";
}

std::string Case::recordedScene() const {
    const Node* swept = axes.find("scene");
    const Node& shown = swept && standsFor.isNull() ? *swept : scene;
    return shown.isNull() ? "" : shown.text();
}

Node Case::recordedParams() const {
    Node recorded = params;
    recorded.set("output", Node::map({{"width", Node::number(outputWidthPx)},
                                      {"height", Node::number(outputHeightPx)}}));
    if (!standsFor.isNull()) recorded.set(kStandsFor, standsFor);
    if (sceneSample) recorded.set(kSceneSample, Node::number(*sceneSample));
    return recorded;
}

Node Case::sceneParams() const {
    Node own = Node::map({});
    for (const auto& [name, value] : params.entries()) {
        if (!name.starts_with(kSceneAxisPrefix)) continue;
        own.set(name.substr(kSceneAxisPrefix.size()), value, params.keyLocation(name));
    }
    return own;
}

}  // namespace gfxrepro::config
