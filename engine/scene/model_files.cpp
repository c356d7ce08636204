#include "engine/scene/model_files.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/foreign_text.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "engine/image/formats.h"
#include "engine/image/image.h"
#include "engine/image/png_io.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load_gltf_keys.h"
#include "engine/scene/load_obj.h"

namespace gfxrepro::scene {
namespace {

bool beginsWith(std::span<const std::byte> bytes, std::span<const unsigned char> magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

constexpr std::array<unsigned char, 4> kPng{0x89, 'P', 'N', 'G'};
constexpr std::array<unsigned char, 3> kJpeg{0xFF, 0xD8, 0xFF};

/// Grey becomes three equal channels; alpha stays.
image::Image8 asColour(const image::Image8& image) {
    if (image.channels() >= 3) return image;
    const bool hasAlpha = image.channels() == 2;
    image::Image8 result(image.width(), image.height(), hasAlpha ? 4 : 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < 3; ++c) result.at(x, y, c) = image.at(x, y);
            if (hasAlpha) result.at(x, y, 3) = image.at(x, y, 1);
        }
    }
    return result;
}

}  // namespace

image::Image8 decodeTexture(std::span<const std::byte> bytes, const std::string& name,
                            LeftOut& leftOut) {
    if (beginsWith(bytes, kPng)) {
        constexpr std::size_t kBitDepthAt = 24;  // signature, length, "IHDR", width, height
        const bool isDeep = bytes.size() > kBitDepthAt && bytes[kBitDepthAt] == std::byte{16};
        if (isDeep) return asColour(image::decodeByStb(bytes, name));
        image::Image8 decoded = asColour(image::decodePng8(bytes, name));
        leftOut.add("a colour that a texture's palette has not: its pixel is black",
                    image::pngColours(bytes, name).beyondPalette);
        return decoded;
    }
    if (beginsWith(bytes, kJpeg)) return asColour(image::decodeByStb(bytes, name));
    throw Error(name + ": neither a PNG nor a JPEG image");
}

bool isPlainSrgb(std::span<const std::byte> bytes, const std::string& name) {
    if (!beginsWith(bytes, kPng)) return image::notesOfJpeg(bytes).empty();
    const image::PngColours colours = image::pngColours(bytes, name);
    return colours.gamma == 0.0 && !colours.primaries && colours.notes.empty();
}

bool isPngOrJpeg(std::span<const std::byte> bytes) {
    return beginsWith(bytes, kPng) || beginsWith(bytes, kJpeg);
}

std::string lowerCaseExtension(const std::filesystem::path& path) {
    return lowerCase(path.extension().string());
}

std::string_view jsonOfGlb(std::string_view file) {
    constexpr std::size_t kHead = 20;
    std::uint32_t length = 0;
    if (file.size() < kHead) return {};
    std::memcpy(&length, file.data() + 12, sizeof(length));
    return file.substr(kHead, length);
}

std::optional<std::filesystem::path> pathInside(const std::filesystem::path& folder,
                                                const std::filesystem::path& name) {
    const std::filesystem::path relative = name.lexically_normal();
    if (name.empty() || name.is_absolute() || *relative.begin() == "..") return std::nullopt;
    return folder / relative;
}

namespace fs = std::filesystem;

std::optional<fs::path> fileInside(const fs::path& folder, std::string name) {
    std::ranges::replace(name, '\\', '/');
    for (const std::string& each : {name, asUtf8(name)}) {
        const auto path = pathInside(folder, each);
        std::error_code ignored;  // of a name that no file can have, such as one of 5,000 letters
        if (path && fs::is_regular_file(*path, ignored)) return path;
    }
    return std::nullopt;
}

std::vector<fs::path> filesBeside(const fs::path& model) {
    const std::string extension = lowerCaseExtension(model);
    const fs::path folder = model.parent_path();
    std::set<fs::path> files;
    try {
        const MappedFile file(model);
        if (extension == ".gltf") files = filesOfGltf(file.text(), folder);
        if (extension == ".glb") files = filesOfGltf(jsonOfGlb(file.text()), folder);
        if (extension == ".obj") files = filesOfObj(file.text(), folder);
    } catch (const Error&) {
        return {};
    }
    for (const fs::path& file : files) requireReadAtOnce(file);
    return {files.begin(), files.end()};
}

void requireReadAtOnce(const fs::path& file) {
    std::error_code isAbsent;
    const std::uintmax_t bytes = fs::file_size(file, isAbsent);
    if (isAbsent || bytes < kMostBytesAtOnce) return;
    throw Error(file.string() + ": has " + std::to_string(bytes) +
                " bytes; a file of a scene has less than 4 GiB");
}

std::string sha256OfModel(const fs::path& model, const std::vector<fs::path>& opened) {
    const std::vector<fs::path> beside = filesBeside(model);
    for (const fs::path& file : opened) {
        if (std::ranges::find(beside, file) != beside.end()) continue;
        throw Error(file.string() + ": belongs to " + model.string() +
                    ", but is not part of the model's identity");
    }
    std::string all = sha256OfFile(model);
    if (beside.empty()) return all;
    for (const fs::path& file : beside) all += sha256OfFile(file);
    return sha256(all);
}

}  // namespace gfxrepro::scene
