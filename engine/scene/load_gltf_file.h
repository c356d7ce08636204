// A glTF file and its buffers in memory, as tinygltf parses them.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <string>

namespace gfxrepro::scene::gltf {

/// Of a camera's node, among its extras: how far its target is, which glTF itself does not say.
inline constexpr const char* kTargetM = "target_m";

/// Nothing in `model` has been checked against anything else: indices and ranges are as written.
/// Images that lie in the file's buffers have no content of their own; others hold the bytes of
/// their file, not decoded.
struct File {
    std::string name;  // for messages
    tinygltf::Model model;
    std::size_t sizeBytes = 0;  // of the file and its buffers
};

/// Reads text or binary glTF with its buffers; URIs must stay inside the file's folder. Throws
/// Error for what is not glTF 2.0 or requires an extension that the loader does not know.
File readFile(const std::filesystem::path& path);

}  // namespace gfxrepro::scene::gltf
