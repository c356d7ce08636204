// plan.json, and what identifies a plan and its cases.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "runner/run/plan.h"

namespace gfxrepro::run {

/// A case as plan.json and a worker have it.
nlohmann::ordered_json toJson(const Case& item);
/// Throws Error(where, …) for what is missing or of another kind; `prefix` stands before its place.
Case caseFromJson(const nlohmann::ordered_json& json, const SourceLocation& where,
                  const std::string& prefix);

/// The same as Plan::fromJsonFile(), also where it throws for a change, but of the experiments only
/// where they stand and their documents, unread: a sweep is expanded when it is read, which would
/// take most of the time of a thousand shards' plans.
Plan planWithUnreadExperiments(const std::filesystem::path& path);

/// References to the scenes that a case loads: `scene`, and its parameters that are references
/// (scene::isSceneKey), by their names; none that is empty.
std::map<std::string, Node> scenesOf(const Case& item);

/// "c", and the first 12 digits of the hash of everything that the case's results depend on:
/// `written` is the case as plan.json has it, whatever its id.
std::string caseId(const Case& item, nlohmann::ordered_json written, const Plan& plan);

/// The hash of a plan whose experiments have these documents.
std::string planHash(const Plan& plan, const std::vector<nlohmann::ordered_json>& documents);

/// The hash of a plan as it is written: `head` is all of plan.json but its cases and this hash. The
/// plan's own hash is another: that of what results depend on, which shards on several machines
/// have in common.
std::string frozenHash(const nlohmann::ordered_json& head, const std::vector<Case>& cases);

}  // namespace gfxrepro::run
