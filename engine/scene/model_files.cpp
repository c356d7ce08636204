#include "engine/scene/model_files.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "engine/scene/load_mtl.h"
#include "engine/scene/load_texture.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

/// Nothing of a name that no file can have, such as one of 5,000 letters.
std::optional<fs::path> existing(const fs::path& folder, std::string name) {
    std::ranges::replace(name, '\\', '/');
    const auto path = pathInside(folder, name);
    std::error_code ignored;
    return path && fs::is_regular_file(*path, ignored) ? path : std::nullopt;
}

/// The JSON of a .glb: its first chunk, behind a head of 12 bytes and the chunk's own of 8.
std::string_view jsonOfGlb(std::string_view file) {
    constexpr std::size_t kHead = 20;
    std::uint32_t length = 0;
    if (file.size() < kHead) return {};
    std::memcpy(&length, file.data() + 12, sizeof(length));
    return file.substr(kHead, length);
}

std::vector<std::string> namesInGltf(std::string_view text) {
    const nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    std::vector<std::string> names;
    for (const char* member : {"buffers", "images"}) {
        if (!document.is_object() || !document.contains(member)) continue;
        for (const nlohmann::json& item : document[member]) {
            if (!item.is_object() || !item.contains("uri") || !item["uri"].is_string()) continue;
            const auto& uri = item["uri"].get_ref<const std::string&>();
            if (!uri.starts_with("data:")) names.push_back(uri);
        }
    }
    return names;
}

std::vector<std::string> namesInObj(std::string_view text, const fs::path& folder) {
    constexpr std::string_view kKey = "mtllib";
    constexpr std::size_t kMostNameBytes = 4096;  // no file has a longer one
    std::vector<std::string> names;
    std::set<std::string> libraries;
    for (std::size_t at = text.find(kKey); at != text.npos; at = text.find(kKey, at + 1)) {
        const std::size_t before = text.find_last_not_of(" \t", at - (at > 0 ? 1 : 0));
        const bool beginsLine = at == 0 || before == text.npos || text[before] == '\n';
        if (!beginsLine) continue;
        const std::string_view line = text.substr(at, text.find_first_of("\r\n", at) - at);
        const std::string name(trimmed(line.substr(kKey.size(), kMostNameBytes + 1)));
        if (name.size() > kMostNameBytes || !libraries.insert(name).second) continue;
        names.push_back(name);
        const auto path = existing(folder, name);
        if (!path) continue;
        try {
            for (const auto& [material, read] : loadMtl(*path)) names.push_back(read.colourFile);
        } catch (const Error&) {  // its loader says what is wrong
        }
    }
    return names;
}

}  // namespace

std::vector<fs::path> filesBeside(const fs::path& model) {
    std::string extension = model.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::vector<std::string> names;
    try {
        const MappedFile file(model);
        if (extension == ".gltf") names = namesInGltf(file.text());
        if (extension == ".glb") names = namesInGltf(jsonOfGlb(file.text()));
        if (extension == ".obj") names = namesInObj(file.text(), model.parent_path());
    } catch (const Error&) {
        return {};
    }
    std::set<fs::path> files;
    for (const std::string& name : names) {
        const auto path = existing(model.parent_path(), name);
        if (!path) continue;
        requireReadAtOnce(*path);
        files.insert(*path);
    }
    return {files.begin(), files.end()};
}

void requireReadAtOnce(const fs::path& file) {
    std::error_code isAbsent;
    const std::uintmax_t bytes = fs::file_size(file, isAbsent);
    if (isAbsent || bytes < kMostBytesAtOnce) return;
    throw Error(file.string() + ": has " + std::to_string(bytes) +
                " bytes; a file of a scene has less than 4 GiB");
}

std::string sha256OfModel(const fs::path& model) {
    const std::vector<fs::path> beside = filesBeside(model);
    std::string all = sha256OfFile(model);
    if (beside.empty()) return all;
    for (const fs::path& file : beside) all += sha256OfFile(file);
    return sha256(all);
}

}  // namespace gfxrepro::scene
