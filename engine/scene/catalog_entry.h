// An entry of the catalogue: its keys, and how they are read.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/key_schema.h"
#include "engine/scene/catalog.h"

namespace gfxrepro::scene {

inline constexpr std::array<std::string_view, 2> kUps = {"y", "z"};
/// Throws Error for a number that is no distance.
float readMetres(const Node& node, const std::string& key);

/// Throws Error, at its place, for anything that is wrong in the file, and for a scene of another
/// name than `expectedName`.
SceneEntry readEntry(const std::filesystem::path& path, const std::string& expectedName,
                     std::span<const GeneratorInfo> generators);

SchemaFile sceneSchema();

}  // namespace gfxrepro::scene
