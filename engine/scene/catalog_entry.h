// An entry of the catalogue: its keys, and how they are read.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/core/key_schema.h"
#include "engine/scene/catalog.h"

namespace gfxrepro::scene {

/// What `scene_params` may have of a height map, or a model, beside the file that names it.
std::span<const std::string> ownFileParams(bool isHeightMap);
/// How the values of such a file become metres, and where up is.
void takeFileParams(const std::string& name, const Node& params, SceneSource& source);

/// Throws Error, at its place, for anything that is wrong in the file, and for a scene of another
/// name than `expectedName`.
SceneEntry readEntry(const std::filesystem::path& path, const std::string& expectedName,
                     std::span<const GeneratorInfo> generators);

SchemaFile sceneSchema();

}  // namespace gfxrepro::scene
