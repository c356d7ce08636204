// The ledger: a config's `assumptions`, bound to the cases that are measured.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runner/run/plan.h"

namespace gfxrepro::run {

/// Fills in value and unit of every assumption that names a parameter of the technique, `output`,
/// `scene` or `scene_seed`: what `cases`, which are the experiment's, take. Throws Error, at its
/// place, for a bound one that gives them itself, and for free text without a value, with a range
/// of numbers or a list, or which is a number under nearly a parameter's name.
void bindAssumptions(config::Experiment& experiment, const std::vector<Case>& cases,
                     const scene::Catalog& catalog,
                     std::span<const technique::TechniqueInfo> techniques);

/// Throws Error at the first value of a bound assumption's range that a case cannot take: every
/// case is made with it. A range of numbers holds what `cases`, the experiment's, measure; one of
/// `view` has paths and cameras of their scenes, which are loaded; one of `scene` has catalogued
/// scenes, at hand or not, of the kind of the scene whose place they take.
void requireRanges(const config::Experiment& experiment, const std::vector<Case>& cases,
                   const scene::Catalog& catalog,
                   std::span<const technique::TechniqueInfo> techniques);

/// A scene of the config and those that may take its place, of a range of `scene`; `scenes` are
/// what the cases are called by.
std::vector<std::pair<std::string, Node>> alternativesOf(const config::Assumption& assumption,
                                                         const std::vector<std::string>& scenes);

/// What the config calls the scenes of the cases, each once.
std::vector<std::string> sceneNames(const std::vector<Case>& cases);

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
