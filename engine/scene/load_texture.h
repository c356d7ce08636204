// Textures and other files that a scene file names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "engine/image/image.h"

namespace gfxrepro::scene {

/// A PNG or JPEG file in memory as 3 or 4 channels of 8 bits. Throws Error; `name` stands in the
/// message. Memory is bounded as in engine/image/png_io.h.
image::Image8 decodeTexture(std::span<const std::byte> bytes, const std::string& name);

/// folder/name; empty when `name` is absolute or leaves the folder.
std::optional<std::filesystem::path> pathInside(const std::filesystem::path& folder,
                                                const std::filesystem::path& name);

}  // namespace gfxrepro::scene
