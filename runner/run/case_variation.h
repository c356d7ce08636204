// What a case takes instead of what its config says: other parameters and scenes.
#pragma once

#include <vector>

#include "runner/run/plan.h"

namespace gfxrepro::run {

/// Fills in what a technique is made from: the parameters that `spec` gives with those of `instead`
/// in their place; what it does not give is offered, so that a case which does not read the
/// parameter refuses nothing. Throws Error for one that is swept.
void takeInstead(const Node& instead, Case& item);

/// The case, whose scene is the config's, with what takes its place; with a generated one, once for
/// each of its seeds. Throws Error when the scene is not found.
std::vector<Case> withScenes(const Case& item, const config::Experiment& experiment,
                             const scene::Catalog& catalog);

/// Throws Error for an entry of `scene_instead` that no case takes: it would be ignored. `cases`
/// are the experiment's.
void requireTaken(const config::Experiment& experiment, const std::vector<Case>& cases);

/// Throws Error for an entry of `params_by_scene` whose scene neither the catalogue nor a case has,
/// or whose parameter no case has.
void requireSceneNames(const config::Experiment& experiment, const std::vector<Case>& cases,
                       const scene::Catalog& catalog);

}  // namespace gfxrepro::run
