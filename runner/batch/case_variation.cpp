#include "runner/batch/case_variation.h"

#include <algorithm>

namespace gfxrepro::batch {

namespace fs = std::filesystem;

namespace {

/// A user's own scene file is named relative to the config; a worker gets the absolute path.
config::Node absoluteReference(const config::Node& reference, const scene::Catalog& catalog) {
    if (!reference.isScalar() || catalog.entries().contains(reference.text())) return reference;
    const fs::path path = reference.text();
    if (!path.has_extension() || path.is_absolute()) return reference;
    const fs::path folder = fs::path(reference.location().file).parent_path();
    return config::Node::scalar(fs::absolute(folder / path).lexically_normal().string(),
                                reference.location());
}

/// The scene that takes the place of `reference`, which may be none.
config::Node insteadOf(const config::Node& reference, const config::Experiment& experiment,
                       const scene::Catalog& catalog) {
    if (!reference.isScalar() || experiment.sceneInstead.isNull()) {
        return absoluteReference(reference, catalog);
    }
    const config::Node* other = experiment.sceneInstead.find(reference.text());
    return absoluteReference(other ? *other : reference, catalog);
}

}  // namespace

void takeInstead(const config::CaseSpec& spec, const config::Node& instead, Case& item) {
    item.given = spec.params;
    for (const auto& [name, value] : instead.entries()) {
        for (const auto& [axis, swept] : spec.axes) {
            if (axis != name) continue;
            throw Error(instead.keyLocation(name),
                        "'params_instead': '" + name + "' is swept here");
        }
        config::Node& map = item.given.find(name) ? item.given : item.offered;
        map.set(name, value, instead.keyLocation(name));
    }
}

std::vector<Case> withScenes(const Case& item, const config::Node& reference,
                             const config::Experiment& experiment, const scene::Catalog& catalog) {
    Case first = item;
    first.scene = insteadOf(reference, experiment, catalog);
    if (first.scene.isNull()) return {first};
    const scene::SceneSource source = catalog.resolve(first.scene);
    const std::uint64_t seed =
        experiment.sceneSeed ? static_cast<std::uint64_t>(*experiment.sceneSeed) : source.seed;
    const int count = source.isSeeded() ? experiment.measure.sceneSeeds : 1;
    std::vector<Case> cases;
    for (int i = 0; i < count; ++i) {
        Case& taken = cases.emplace_back(first);
        if (count > 1) taken.sceneSample = i;
        if (source.isSeeded() && (i > 0 || experiment.sceneSeed)) {
            taken.scene = scene::withSeed(first.scene, seed + static_cast<std::uint64_t>(i));
        }
        const bool isOther = taken.scene.text() != absoluteReference(reference, catalog).text();
        if (isOther) taken.standsFor = reference;
    }
    return cases;
}

void requireTaken(const config::Experiment& experiment, const std::vector<Case>& cases,
                  const scene::Catalog& catalog) {
    const auto isSeeded = [&](const Case& item) {
        return !item.scene.isNull() && catalog.resolve(item.scene).isSeeded();
    };
    if (experiment.sceneSeed && std::ranges::none_of(cases, isSeeded)) {
        throw Error(experiment.document.find("scene_seed")->location(),
                    "'scene_seed': no scene of " + experiment.id + " is generated");
    }
    if (experiment.sceneInstead.isNull()) return;
    for (const auto& [name, other] : experiment.sceneInstead.entries()) {
        const auto isTaken = [&](const Case& item) {
            return !item.standsFor.isNull() && item.standsFor.text() == name;
        };
        if (std::ranges::any_of(cases, isTaken)) continue;
        throw Error(
            experiment.sceneInstead.keyLocation(name),
            "'scene_instead': no case of " + experiment.id + " has the scene '" + name + "'");
    }
}

}  // namespace gfxrepro::batch
