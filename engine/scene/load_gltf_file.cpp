#include "engine/scene/load_gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"
#include "engine/scene/load_gltf_keys.h"
#include "engine/scene/load_text.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene::gltf {
namespace {

constexpr std::array<std::string_view, 9> kSupportedExtensions{
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_mesh_quantization",   "KHR_node_visibility",        "KHR_texture_transform"};

/// What the callbacks of tinygltf may open. It decodes URIs itself, some versions '+' to a blank,
/// too, and gives them what comes out: they look up what the file has.
struct Folder {
    std::filesystem::path path;
    std::map<std::string, std::string> names;  // by their URIs, as tinygltf decodes them
    std::string refused;                       // the first name that leaves the folder
    std::string absent;                        // the first one that is not there
    std::set<std::filesystem::path> opened;

    Folder(std::filesystem::path folder, std::string_view json) : path(std::move(folder)) {
        for (const std::string& uri : urisOfGltf(json)) {
            names.emplace(decodedUri(uri, true), decodedUri(uri));
            std::string spaced = uri;
            std::ranges::replace(spaced, '+', ' ');
            names.emplace(decodedUri(spaced, true), decodedUri(uri));
        }
    }

    std::optional<std::filesystem::path> find(const std::string& uri) {
        const auto found = names.find(uri);
        const std::string& name = found != names.end() ? found->second : uri;
        const auto file = found != names.end() ? fileInside(path, name) : std::nullopt;
        if (!file && absent.empty()) absent = name;
        if (!file && refused.empty() && !pathInside(path, name)) refused = name;
        return file;
    }
};

constexpr std::string_view kBase64 = ";base64,";

/// Of a media type that tinygltf does not know, as image/jpg: it takes the others for itself.
bool isData(const std::string& uri) {
    return uri.starts_with("data:") && uri.find(kBase64) != uri.npos;
}

std::vector<unsigned char> dataOf(std::string uri) {
    std::ranges::replace(uri, ' ', '+');  // some versions have decoded it
    std::vector<unsigned char> data;
    std::string type;
    const std::string known = "data:application/octet-stream" + uri.substr(uri.find(kBase64));
    tinygltf::DecodeDataURI(&data, type, known, 0, false);
    return data;
}

bool fileExists(const std::string& uri, void* folder) {
    return isData(uri) || static_cast<Folder*>(folder)->find(uri).has_value();
}

std::string sameUri(const std::string& uri, void*) {
    return uri;
}

bool readWholeFile(std::vector<unsigned char>* content, std::string*, const std::string& uri,
                   void* folder) {
    if (isData(uri)) {
        *content = dataOf(uri);
        return true;
    }
    const auto path = static_cast<Folder*>(folder)->find(uri);
    if (!path) return false;
    requireReadAtOnce(*path);
    static_cast<Folder*>(folder)->opened.insert(*path);
    const MappedFile file(*path);
    const auto* begin = reinterpret_cast<const unsigned char*>(file.bytes().data());
    content->assign(begin, begin + file.bytes().size());
    return true;
}

[[maybe_unused]]  // before tinygltf 2.9
bool fileSize(std::size_t* sizeBytes, std::string*, const std::string& uri, void* folder) {
    if (isData(uri)) {
        *sizeBytes = dataOf(uri).size();
        return true;
    }
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

/// Behind the length that its header says.
std::size_t bytesBehindGlb(std::string_view content) {
    constexpr std::size_t kLengthAt = 8;
    std::uint32_t length = 0;
    if (content.size() < kLengthAt + sizeof(length)) return 0;
    std::memcpy(&length, content.data() + kLengthAt, sizeof(length));
    return content.size() - std::min<std::size_t>(length, content.size());
}

/// A JSON object, perhaps behind a byte order mark.
bool beginsAsJson(std::string_view content) {
    content = withoutByteOrderMark(content);
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

/// The JSON library says "[json.exception.parse_error.101] parse error at line 3, column 5: …".
[[noreturn]] void failOfParser(const std::string& file, const std::string& reason, bool isBinary) {
    constexpr std::string_view kException = "[json.exception.";
    int line = 0, column = 0, end = 0;
    std::sscanf(reason.c_str(), "[%*[^]]] parse error at line %d, column %d: %n", &line, &column,
                &end);
    if (!reason.starts_with(kException)) throw Error(fmt::format("{}: {}", file, reason));
    if (end == 0) throw Error(fmt::format("{}: {}", file, reason.substr(reason.find(']') + 2)));
    const std::string found = reason.substr(static_cast<std::size_t>(end));
    if (!isBinary) throw Error({file, line, column}, found);
    throw Error(fmt::format("{}: line {}, column {} of its JSON: {}", file, line, column, found));
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
    const std::string_view json = isBinary ? jsonOfGlb(content) : content;
    requireShallowJson(json, {file.name, 0, 0});  // tinygltf recurses
    const std::string wrong = checkedKeys(json, file.leftOut);
    if (isBinary) file.leftOut.add("a byte behind the file's length", bytesBehindGlb(content));

    Folder folder(path.parent_path(), json);
    std::string message;
    const bool isParsed = parse(content, isBinary, folder, file.model, message);
    checkExtensions(file.model, file.name);  // the better reason, when it is one
    if (!folder.refused.empty()) {
        throw Error(fmt::format("{}: the URI {} leaves the file's folder", file.name,
                                inQuotes(folder.refused)));
    }
    const tinygltf::Asset& asset = file.model.asset;
    if (!asset.version.starts_with("2.")) {
        throw Error(fmt::format("{}: glTF version '{}'; 2.0 is read", file.name, asset.version));
    }
    // The parser passes over most of this as if it was not there.
    if (!wrong.empty()) throw Error(fmt::format("{}: {}", file.name, wrong));
    if (!isParsed) {
        const std::string_view reason = trimmed(message);
        if (reason.starts_with("File not found")) {
            throw Error(fmt::format("{}: the file {} is not beside it", file.name,
                                    inQuotes(folder.absent)));
        }
        failOfParser(file.name, std::string(reason.substr(0, reason.find('\n'))), isBinary);
    }
    if (!asset.minVersion.empty() && asset.minVersion != "2.0") {
        throw Error(fmt::format("{}: needs glTF version '{}' at least; 2.0 is read", file.name,
                                asset.minVersion));
    }
    file.opened.assign(folder.opened.begin(), folder.opened.end());
    file.sizeBytes = content.size();
    for (const tinygltf::Buffer& buffer : file.model.buffers) file.sizeBytes += buffer.data.size();
    return file;
}

namespace {

template <class T>
T load(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

/// glTF 2.0, Sec. 3.6.2.2: integers as parts of their maximum, never below −1.
template <class T>
float converted(const unsigned char* from, bool isNormalized) {
    const auto value = static_cast<float>(load<T>(from));
    if (!isNormalized) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

float component(const unsigned char* from, int type, bool isNormalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return converted<std::int8_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return converted<std::uint8_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return converted<std::int16_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return converted<std::uint16_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return converted<std::uint32_t>(from, isNormalized);
        default:
            return load<float>(from);
    }
}

std::uint32_t unsignedInteger(const unsigned char* from, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(from);
        default:
            return load<std::uint32_t>(from);
    }
}

/// 0 for types that an accessor may not have.
std::size_t componentBytes(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

bool isUnsigned(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// `count` elements of `bytes`, `stride` apart.
struct Rows {
    const unsigned char* begin = nullptr;
    std::size_t stride = 0;
};

/// One accessor after its checks.
class Elements {
  public:
    Elements(const Accessors& accessors, const File& file, int index)
        : accessors_(accessors),
          where_(fmt::format("{}: accessor {}", file.name, index)),
          model_(file.model),
          accessor_(&elementOf(model_.accessors, index, "{}", where_)) {
        components_ = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
        if (componentBytes(accessor_->componentType) == 0) {
            fail(fmt::format("has the unknown component type {}", accessor_->componentType));
        }
    }

    int components() const { return components_; }
    std::size_t count() const { return accessor_->count; }
    int componentType() const { return accessor_->componentType; }
    bool isNormalized() const { return accessor_->normalized; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(where_ + ' ' + message);
    }

    /// Calls visit(i, bytes of element i), in order, then again for the elements that sparse values
    /// replace. Without a buffer view the elements are zero and only the replaced ones visited.
    template <class Visit>
    void forEach(Visit&& visit) const {
        const std::size_t bytes =
            componentBytes(accessor_->componentType) * static_cast<std::size_t>(components_);
        if (accessor_->bufferView >= 0) {
            const Rows rows = rowsOf(accessor_->bufferView, accessor_->byteOffset, count(), bytes);
            for (std::size_t i = 0; i < count(); ++i) visit(i, rows.begin + i * rows.stride);
        }
        if (!accessor_->sparse.isSparse) return;
        const auto& sparse = accessor_->sparse;
        const int indexType = sparse.indices.componentType;
        if (sparse.count < 0 || !isUnsigned(indexType)) fail("has sparse values without indices");
        const auto sparseCount = static_cast<std::size_t>(sparse.count);
        const Rows indices = rowsOf(sparse.indices.bufferView, offset(sparse.indices.byteOffset),
                                    sparseCount, componentBytes(indexType));
        const Rows values =
            rowsOf(sparse.values.bufferView, offset(sparse.values.byteOffset), sparseCount, bytes);
        for (std::size_t i = 0; i < sparseCount; ++i) {
            const auto index = unsignedInteger(indices.begin + i * indices.stride, indexType);
            if (index >= count()) {
                fail(fmt::format("replaces element {} of {}", index, count()));
            }
            visit(index, values.begin + i * values.stride);
        }
    }

  private:
    /// tinygltf's offsets are int before 2.9, std::size_t from there on.
    template <class Integer>
    std::size_t offset(Integer bytes) const {
        if (!std::in_range<std::size_t>(bytes)) fail("has a negative offset");
        return static_cast<std::size_t>(bytes);
    }

    Rows rowsOf(int viewIndex, std::size_t offset, std::size_t count, std::size_t bytes) const {
        const std::span<const unsigned char> view = accessors_.view(viewIndex);
        const std::size_t given =
            model_.bufferViews[static_cast<std::size_t>(viewIndex)].byteStride;
        const std::size_t stride = given != 0 ? given : bytes;
        if (stride < bytes)
            fail(fmt::format("has a stride of {} bytes; {} are needed", stride, bytes));
        if (count == 0) return {};
        if (offset > view.size() || view.size() - offset < bytes ||
            (view.size() - offset - bytes) / stride < count - 1) {
            fail(fmt::format("reaches beyond its buffer view of {} bytes", view.size()));
        }
        return {view.data() + offset, stride};
    }

    const Accessors& accessors_;
    std::string where_;
    const tinygltf::Model& model_;
    const tinygltf::Accessor* accessor_;
    int components_ = 0;
};

}  // namespace

Accessors::Accessors(const File& file) : file_(file) {
    constexpr std::uint64_t kAlwaysAllowedBytes = std::uint64_t{64} << 20;
    constexpr std::uint64_t kMaxExpansion = 64;
    budgetBytes_ = kAlwaysAllowedBytes + kMaxExpansion * file.sizeBytes;
}

void Accessors::charge(std::uint64_t count, std::size_t bytesEach) {
    if (count > budgetBytes_ / bytesEach) {
        throw Error(fmt::format("{}: the scene is too large for a file of {} bytes", file_.name,
                                file_.sizeBytes));
    }
    budgetBytes_ -= count * bytesEach;
}

std::span<const unsigned char> Accessors::view(int bufferView) const {
    const std::string where = fmt::format("{}: buffer view {}", file_.name, bufferView);
    const tinygltf::BufferView& view = elementOf(file_.model.bufferViews, bufferView, "{}", where);
    const std::span<const unsigned char> data =
        elementOf(file_.model.buffers, view.buffer, "{}: buffer {}", where, view.buffer).data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        throw Error(fmt::format("{} reaches beyond its buffer of {} bytes", where, data.size()));
    }
    return data.subspan(view.byteOffset, view.byteLength);
}

template <class T>
const std::vector<T>& Accessors::values(int accessor, bool mayHaveAlpha) {
    constexpr int kCount = sizeof(T) / sizeof(float);
    const Elements elements(*this, file_, accessor);
    if (elements.components() != kCount && !(mayHaveAlpha && elements.components() == kCount + 1)) {
        elements.fail(
            fmt::format("has {} components; {} are needed", elements.components(), kCount));
    }
    const auto [found, isNew] = std::get<Decoded<T>>(decoded_).try_emplace(accessor);
    if (!isNew) return found->second;
    charge(elements.count(), sizeof(T));
    std::vector<T>& values = found->second;
    values.assign(elements.count(), T(0.0F));
    const std::size_t bytes = componentBytes(elements.componentType());
    elements.forEach([&](std::size_t i, const unsigned char* from) {
        float* to = glm::value_ptr(values[i]);
        for (int c = 0; c < kCount; ++c) {
            to[c] = component(from + static_cast<std::size_t>(c) * bytes, elements.componentType(),
                              elements.isNormalized());
            if (!std::isfinite(to[c])) elements.fail(fmt::format("element {} is not finite", i));
        }
    });
    return values;
}

template const std::vector<glm::vec2>& Accessors::values<glm::vec2>(int, bool);
template const std::vector<glm::vec3>& Accessors::values<glm::vec3>(int, bool);
template const std::vector<glm::vec4>& Accessors::values<glm::vec4>(int, bool);
template const std::vector<glm::mat4>& Accessors::values<glm::mat4>(int, bool);

std::vector<std::uint32_t> Accessors::indices(int accessor) {
    const Elements elements(*this, file_, accessor);
    if (elements.components() != 1 || !isUnsigned(elements.componentType())) {
        elements.fail("does not hold indices; unsigned integers of type SCALAR are needed");
    }
    charge(elements.count(), sizeof(std::uint32_t));
    std::vector<std::uint32_t> values(elements.count(), 0);
    elements.forEach([&](std::size_t i, const unsigned char* from) {
        values[i] = unsignedInteger(from, elements.componentType());
    });
    return values;
}

}  // namespace gfxrepro::scene::gltf
