// Which scenes a case takes: the config's, at another seed, or another in its place.
#pragma once

#include <vector>

#include "runner/batch/plan.h"

namespace gfxrepro::batch {

/// The case with its scene, which the config calls `reference` (null: none); of a generated one,
/// once for each of its seeds. Throws Error when the scene is not at hand.
std::vector<Case> withScenes(const Case& item, const config::Node& reference,
                             const config::Experiment& experiment, const scene::Catalog& catalog);

/// Throws Error for a `scene_seed` or an entry of `scene_instead` that no case takes: it would be
/// ignored. `cases` are the experiment's.
void requireTaken(const config::Experiment& experiment, const std::vector<Case>& cases,
                  const scene::Catalog& catalog);

}  // namespace gfxrepro::batch
