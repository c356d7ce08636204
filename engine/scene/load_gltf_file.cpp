#include "engine/scene/load_gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>
#include <type_traits>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "engine/scene/load_texture.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene::gltf {

namespace {

constexpr std::array<std::string_view, 8> kSupportedExtensions{
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_mesh_quantization",   "KHR_texture_transform"};

/// tinygltf gives URIs, percent signs decoded, to these callbacks; they resolve them in the file's
/// folder only.
struct Folder {
    std::filesystem::path path;
    std::string refused;  // the first URI that leaves the folder

    std::optional<std::filesystem::path> find(const std::string& uri) {
        const auto inside = pathInside(path, uri);
        if (!inside && refused.empty()) refused = uri;
        std::error_code ignored;
        return inside && std::filesystem::is_regular_file(*inside, ignored) ? inside : std::nullopt;
    }
};

bool fileExists(const std::string& uri, void* folder) {
    return static_cast<Folder*>(folder)->find(uri).has_value();
}

std::string sameUri(const std::string& uri, void*) {
    return uri;
}

bool readWholeFile(std::vector<unsigned char>* content, std::string*, const std::string& uri,
                   void* folder) {
    const auto path = static_cast<Folder*>(folder)->find(uri);
    if (!path) return false;
    requireReadAtOnce(*path);
    const MappedFile file(*path);
    const auto* begin = reinterpret_cast<const unsigned char*>(file.bytes().data());
    content->assign(begin, begin + file.bytes().size());
    return true;
}

[[maybe_unused]]  // before tinygltf 2.9
bool fileSize(std::size_t* sizeBytes, std::string*, const std::string& uri, void* folder) {
    const auto path = static_cast<Folder*>(folder)->find(uri);
    if (!path) return false;
    requireReadAtOnce(*path);
    *sizeBytes = std::filesystem::file_size(*path);
    return true;
}

bool writeNothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

/// Lets the parser at files by these callbacks only. From 2.9 on tinygltf asks for sizes, too, and
/// refuses callbacks of which one is missing: it would go on with its own, which read any path.
template <class Parser, class Callbacks = tinygltf::FsCallbacks>
void readThrough(Folder& folder, Parser& parser) {
    Callbacks callbacks{};
    callbacks.FileExists = fileExists;
    callbacks.ExpandFilePath = sameUri;
    callbacks.ReadWholeFile = readWholeFile;
    callbacks.WriteWholeFile = writeNothing;
    callbacks.user_data = &folder;
    if constexpr (requires { callbacks.GetFileSizeInBytes; }) {
        callbacks.GetFileSizeInBytes = fileSize;
    }
    if constexpr (std::is_void_v<decltype(parser.SetFsCallbacks(callbacks))>) {
        parser.SetFsCallbacks(callbacks);
    } else {
        const bool isTaken = parser.SetFsCallbacks(callbacks);
        GFXREPRO_ASSERT(isTaken);
    }
}

/// Keeps the encoded bytes of images with a URI. The range of one in a buffer has not been checked
/// when tinygltf calls, so it is not touched here.
bool keepEncoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

/// The JSON of either kind of file; empty when a binary file is too short for any.
std::string_view jsonText(std::string_view content, bool isBinary) {
    if (!isBinary) return content;
    constexpr std::size_t kHeaderBytes = 20;
    std::uint32_t length = 0;
    if (content.size() < kHeaderBytes) return {};
    std::memcpy(&length, content.data() + 12, sizeof(length));
    return content.substr(kHeaderBytes, length);
}

/// The parser recurses over nested values; a deep enough file would overflow its stack.
void checkNesting(std::string_view json, const std::string& name) {
    constexpr int kMaxDepth = 256;
    int depth = 0;
    bool isString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (isString) {
            if (c == '\\') ++i;
            if (c == '"') isString = false;
        } else if (c == '"') {
            isString = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kMaxDepth) {
                throw Error(fmt::format("{}: JSON nested deeper than {}", name, kMaxDepth));
            }
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

void checkExtensions(const tinygltf::Model& model, const std::string& name) {
    std::vector<std::string> missing;
    for (const std::string& extension : model.extensionsRequired) {
        const bool isSupported = std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(),
                                           extension) != kSupportedExtensions.end();
        if (!isSupported) missing.push_back(extension);
    }
    if (missing.empty()) return;
    throw Error(fmt::format("{}: requires the extension {}; supported are {}", name,
                            joined(missing), fmt::join(kSupportedExtensions, ", ")));
}

/// A JSON object, perhaps behind a byte order mark.
bool beginsAsJson(std::string_view content) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
    const std::size_t begin = content.find_first_not_of(" \t\r\n");
    return begin != content.npos && content[begin] == '{';
}

bool parse(std::string_view content, bool isBinary, Folder& folder, tinygltf::Model& model,
           std::string& message) {
    tinygltf::TinyGLTF parser;
    readThrough(folder, parser);
    parser.SetImageLoader(keepEncoded, nullptr);
    std::string ignoredWarnings;
    const auto size = static_cast<unsigned int>(content.size());
    const std::string noBaseFolder;  // so that the callbacks get URIs as they are
    try {
        return isBinary
                   ? parser.LoadBinaryFromMemory(
                         &model, &message, &ignoredWarnings,
                         reinterpret_cast<const unsigned char*>(content.data()), size, noBaseFolder)
                   : parser.LoadASCIIFromString(&model, &message, &ignoredWarnings, content.data(),
                                                size, noBaseFolder);
    } catch (const std::exception& error) {  // wrong JSON types, among others
        message = error.what();
        return false;
    }
}

}  // namespace

File readFile(const std::filesystem::path& path) {
    requireReadAtOnce(path);
    const MappedFile mapped(path);
    const std::string_view content = mapped.text();
    File file;
    file.name = path.string();
    constexpr std::size_t kLeastBytes = 4;  // of what tinygltf parses
    const bool isBinary = content.starts_with("glTF");
    const bool isLongEnough = content.size() >= kLeastBytes;
    if (!isLongEnough || (!isBinary && !beginsAsJson(content))) {
        throw Error(
            fmt::format("{}: {}; a .gltf file is a JSON object, a .glb file begins with "
                        "'glTF'",
                        file.name, content.empty() ? "is empty" : "is no glTF"));
    }
    checkNesting(jsonText(content, isBinary), file.name);

    Folder folder{path.parent_path(), ""};
    std::string message;
    const bool isParsed = parse(content, isBinary, folder, file.model, message);
    checkExtensions(file.model, file.name);  // the better reason, when it is one
    if (!folder.refused.empty()) {
        throw Error(
            fmt::format("{}: the URI '{}' leaves the file's folder", file.name, folder.refused));
    }
    if (!isParsed) {
        const std::string_view reason = trimmed(message);
        throw Error(fmt::format("{}: {}", file.name, reason.substr(0, reason.find('\n'))));
    }
    if (!file.model.asset.version.starts_with("2.")) {
        throw Error(
            fmt::format("{}: glTF version '{}'; 2.0 is read", file.name, file.model.asset.version));
    }
    file.sizeBytes = content.size();
    for (const tinygltf::Buffer& buffer : file.model.buffers) file.sizeBytes += buffer.data.size();
    return file;
}

}  // namespace gfxrepro::scene::gltf
