// Reads the file of a catalogued scene; private to this module.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/scene/catalog.h"

namespace gfxrepro::scene {

/// Throws Error, at its place, for anything that is wrong in the file, and for a scene of another
/// name than `expectedName`.
SceneEntry readEntry(const std::filesystem::path& path, const std::string& expectedName,
                     std::span<const GeneratorInfo> generators);

}  // namespace gfxrepro::scene
