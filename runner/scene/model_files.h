// The files that a model's own file draws in: buffers, textures, material files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gfxrepro::scene {

/// Those that are there, by their names: of a glTF its buffers and images, of an OBJ its material
/// files and their textures. A broken file draws in none here: its loader says what is wrong.
/// Throws Error for one that no loader would take, before anybody reads it through.
std::vector<std::filesystem::path> filesBeside(const std::filesystem::path& model);

/// Throws Error for a file of 4 GiB or more, as glTF and material files are read at once.
void requireReadAtOnce(const std::filesystem::path& file);

/// SHA-256 of a model: its file's, or, where others belong to it, that of all of theirs.
std::string sha256OfModel(const std::filesystem::path& model);

}  // namespace gfxrepro::scene
