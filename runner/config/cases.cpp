// The points of a sweep as cases: parameters with those of the scene and the axes laid over.
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

std::vector<CaseSpec> expandCases(const Experiment& experiment) {
    std::vector<CaseSpec> cases;
    if (experiment.technique.empty()) return cases;
    for (AxisPoint& point : expandSweep(experiment.sweep)) {
        CaseSpec spec{{},
                      {},
                      sceneAt(point, experiment),
                      experiment.sceneParams,
                      experiment.outputWidthPx,
                      experiment.outputHeightPx};
        spec.params = paramsOf(spec.scene, experiment);
        for (const auto& [axis, value] : point) {
            if (axis == "scene") continue;
            if (axis.starts_with(kSceneAxisPrefix)) {
                spec.sceneParams.set(axis.substr(kSceneAxisPrefix.size()), value, value.location());
            } else if (axis == "output.width") {
                spec.outputWidthPx = outputSize(value, axis);
            } else if (axis == "output.height") {
                spec.outputHeightPx = outputSize(value, axis);
            } else {
                spec.params.set(axis, value);
            }
        }
        spec.axes = std::move(point);
        cases.push_back(std::move(spec));
    }
    return cases;
}

}  // namespace gfxrepro::config
