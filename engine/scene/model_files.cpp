#include "engine/scene/model_files.h"

#include <stb/stb_image.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/image/image.h"
#include "engine/image/png_io.h"
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

/// Without the stuffed bytes (FF 00) that some programs leave between a scan and the next marker:
/// stb takes them for a marker.
std::vector<std::byte> withoutStuffedEnds(std::span<const std::byte> bytes) {
    std::vector<std::byte> kept;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto at = [&](std::size_t ahead) {
            return i + ahead < bytes.size() ? std::to_integer<int>(bytes[i + ahead]) : -1;
        };
        const bool isRestart = at(3) >= 0xD0 && at(3) <= 0xD7;
        const bool isMarker = at(2) == 0xFF && at(3) > 0 && at(3) < 0xFF && !isRestart;
        if (at(0) == 0xFF && at(1) == 0 && isMarker) {
            ++i;
        } else {
            kept.push_back(bytes[i]);
        }
    }
    return kept;
}

/// JPEG, and PNG with 16 bits a channel, which stb rounds to 8.
image::Image8 decodedByStb(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw Error(name + ": an image of more than 2 GiB");
    }
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const auto size = static_cast<int>(bytes.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
        throw Error(name + ": " + stbi_failure_reason());
    }
    image::checkDeclaredSize(width, height, 4, bytes.size(), name);
    const int wanted = channels % 2 == 0 ? 4 : 3;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, wanted), stbi_image_free);
    if (pixels == nullptr) {
        const std::string reason = stbi_failure_reason();
        if (reason == "unknown marker") {
            const std::vector<std::byte> mended = withoutStuffedEnds(bytes);
            if (mended.size() < bytes.size()) return decodedByStb(mended, name);
        }
        throw Error(name + ": " + reason);
    }
    image::Image8 image(width, height, wanted);
    std::copy_n(pixels.get(), image.values().size(), image.values().begin());
    return image;
}

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

image::Image8 decodeTexture(std::span<const std::byte> bytes, const std::string& name) {
    if (beginsWith(bytes, kPng)) {
        constexpr std::size_t kBitDepthAt = 24;  // signature, length, "IHDR", width, height
        const bool isDeep = bytes.size() > kBitDepthAt && bytes[kBitDepthAt] == std::byte{16};
        return isDeep ? decodedByStb(bytes, name) : asColour(image::decodePng8(bytes, name));
    }
    if (beginsWith(bytes, kJpeg)) return decodedByStb(bytes, name);
    throw Error(name + ": neither a PNG nor a JPEG image");
}

bool isPngOrJpeg(std::span<const std::byte> bytes) {
    return beginsWith(bytes, kPng) || beginsWith(bytes, kJpeg);
}

std::string lowerCaseExtension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
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
    const auto path = pathInside(folder, name);
    std::error_code ignored;  // of a name that no file can have, such as one of 5,000 letters
    return path && fs::is_regular_file(*path, ignored) ? path : std::nullopt;
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
