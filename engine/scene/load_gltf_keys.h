// What the JSON of a glTF file names, read without tinygltf, which skips what it does not know.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/left_out.h"

namespace gfxrepro::scene {

/// Adds every key that the loader neither uses nor knows to change nothing here: "the key
/// 'materials.occlusionTexture'". Returns the first value that is not of its key's shape,
/// "nodes[3].scale is a list of 2; allowed: a list of 3 numbers", or key that is there twice; else
/// nothing. JSON that is broken is read as far as it goes.
std::string checkedKeys(std::string_view json, LeftOut& leftOut);

/// The URIs of buffers and images as they are written, without those that hold the data.
std::vector<std::string> urisOfGltf(std::string_view json);

/// %20 becomes a blank. What stands behind another '%' than that of two digits stays, or is lost
/// (`takesAny`), as tinygltf has it.
std::string decodedUri(std::string_view uri, bool takesAny = false);

/// The files that a glTF file names (fileInside()), where they are there.
std::set<std::filesystem::path> filesOfGltf(std::string_view json,
                                            const std::filesystem::path& folder);

}  // namespace gfxrepro::scene
