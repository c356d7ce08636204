// The files that a model's own file draws in: buffers, textures, material files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::scene {

class LeftOut;

/// A PNG or JPEG file in memory as 3 or 4 channels of 8 bits. Throws Error; `name` stands in the
/// message. Memory is bounded as in engine/image/png_io.h.
image::Image8 decodeTexture(std::span<const std::byte> bytes, const std::string& name,
                            LeftOut& leftOut);

/// Whether a PNG or JPEG file says no other colours than sRGB: decodeTexture() does not look, as
/// glTF wants it.
bool isPlainSrgb(std::span<const std::byte> bytes, const std::string& name);

/// Whether decodeTexture() knows the format by its first bytes.
bool isPngOrJpeg(std::span<const std::byte> bytes);

/// ".ply" of "A.PLY".
std::string lowerCaseExtension(const std::filesystem::path& path);

/// The JSON of a .glb: its first chunk, behind a head of 12 bytes and the chunk's own of 8. Empty
/// where the file is too short for any.
std::string_view jsonOfGlb(std::string_view file);

/// folder/name; empty when `name` is absolute or leaves the folder.
std::optional<std::filesystem::path> pathInside(const std::filesystem::path& folder,
                                                const std::filesystem::path& name);

/// The file of the folder, or below it, that a model's file calls `name`, with slashes of either
/// kind; where no file has these bytes, and they are Latin-1, the one of that name in UTF-8.
/// Nothing where it is not there or not inside. Loaders open, and filesBeside() lists, by this
/// function alone.
std::optional<std::filesystem::path> fileInside(const std::filesystem::path& folder,
                                                std::string name);

/// Those that are there, by their names: of a glTF its buffers and images, of an OBJ its material
/// files and their textures. A broken file draws in none here: its loader says what is wrong.
/// Throws Error for one that no loader would take, before anybody reads it through.
std::vector<std::filesystem::path> filesBeside(const std::filesystem::path& model);

/// Every file of a scene but a height map has less, as it is read at once: what a GLB's head can
/// say. A file of holes may say that it has more than the disk.
inline constexpr std::uintmax_t kMostBytesAtOnce = std::uintmax_t{4} << 30;
/// Throws Error for one that has not.
void requireReadAtOnce(const std::filesystem::path& file);

/// SHA-256 of a model: its file's, or, where others belong to it, that of all of theirs. Throws
/// Error where `opened`, which its loader read, has a file that is none of those.
std::string sha256OfModel(const std::filesystem::path& model,
                          const std::vector<std::filesystem::path>& opened = {});

}  // namespace gfxrepro::scene
