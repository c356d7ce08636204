#include "runner/run/case_variation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"

namespace gfxrepro::run {

void takeInstead(const Node& instead, Case& item) {
    for (const auto& [name, value] : instead.entries()) {
        if (item.axes.find(name)) {
            throw Error(instead.keyLocation(name),
                        "'params_instead': '" + name + "' is swept here");
        }
        Node& map = item.given.find(name) ? item.given : item.offered;
        map.set(name, value, instead.keyLocation(name));
    }
}

std::vector<Case> withScenes(const Case& item, const config::Experiment& experiment,
                             const scene::Catalog& catalog) {
    if (item.scene.isNull()) return {item};
    Case first = item;
    if (const Node* other = experiment.sceneInstead.find(item.scene.text())) first.scene = *other;
    scene::SceneSource source = catalog.resolve(first.scene);
    const Node params = item.sceneParams();
    if (!params.entries().empty()) {
        scene::takeParams(scene::sceneName(first.scene.text()), params, source);
        first.scene = scene::withSceneParams(first.scene, params);
    }
    const int count = source.isSeeded() ? experiment.measure.sceneSeeds : 1;
    std::vector<Case> cases;
    for (int i = 0; i < count; ++i) {
        Case& taken = cases.emplace_back(first);
        if (count > 1) taken.sceneSample = i;
        if (i > 0)
            taken.scene = scene::withSeed(first.scene, source.seed + static_cast<std::uint64_t>(i));
        if (taken.scene.text() != item.scene.text()) taken.standsFor = item.scene;
    }
    return cases;
}

void requireTaken(const config::Experiment& experiment, const std::vector<Case>& cases) {
    for (const auto& [name, other] : experiment.sceneInstead.entries()) {
        const auto isTaken = [&name = name](const Case& item) {
            return !item.standsFor.isNull() && item.standsFor.text() == name;
        };
        if (std::ranges::any_of(cases, isTaken)) continue;
        throw Error(
            experiment.sceneInstead.keyLocation(name),
            "'scene_instead': no case of " + experiment.id + " has the scene '" + name + "'");
    }
}

void requireSceneNames(const config::Experiment& experiment, const std::vector<Case>& cases,
                       const scene::Catalog& catalog) {
    std::set<std::string> known, scenes;
    for (const auto& [name, entry] : catalog.entries()) scenes.insert(name);
    for (const Case& item : cases) {
        for (const auto& [name, value] : item.params.entries()) known.insert(name);
        const Node& scene = item.standsFor.isNull() ? item.scene : item.standsFor;
        if (!scene.isNull()) scenes.insert(scene::sceneName(scene.text()));
    }
    const auto require = [](const std::set<std::string>& names, const std::string& name,
                            const SourceLocation& where, const std::string& what) {
        if (names.contains(name)) return;
        const std::vector<std::string> all(names.begin(), names.end());
        throw Error(where,
                    fmt::format("params_by_scene: {} '{}'{}", what, name, suggestion(name, all)));
    };
    for (const auto& [scene, params] : experiment.paramsByScene.entries()) {
        require(scenes, scene, experiment.paramsByScene.keyLocation(scene), "unknown scene");
        for (const auto& [name, value] : params.entries()) {
            require(known, name, params.keyLocation(name), "unknown parameter");
        }
    }
}

}  // namespace gfxrepro::run
