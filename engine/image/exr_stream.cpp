#include "engine/image/exr_stream.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/image/limits.h"

namespace gfxrepro::image {

namespace {

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < sizeof(word) && at + i < bytes.size(); ++i) {
        word |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    }
    return word;
}

/// Where the text that begins at `at` ends, behind its zero; empty when it has none.
std::optional<std::size_t> endOfText(std::span<const std::byte> bytes, std::size_t at) {
    while (at < bytes.size() && bytes[at] != std::byte{0}) ++at;
    return at < bytes.size() ? std::optional(at + 1) : std::nullopt;
}

/// Channels (a name, then 16 bytes each) and a zero.
bool isChannelList(std::span<const std::byte> value) {
    constexpr std::size_t kChannelBytes = 16;
    std::size_t at = 0;
    while (at < value.size() && value[at] != std::byte{0}) {
        const auto end = endOfText(value, at);
        if (!end || value.size() - *end < kChannelBytes) return false;
        at = *end + kChannelBytes;
    }
    return at + 1 == value.size();
}

/// Texts, each behind its length.
bool isTextList(std::span<const std::byte> value) {
    while (!value.empty()) {
        const std::size_t length = wordAt(value, 0);
        if (value.size() < sizeof(std::uint32_t) + length) return false;
        value = value.subspan(sizeof(std::uint32_t) + length);
    }
    return true;
}

/// Whether a value ends where its type says. The library reads on behind one that does not, takes
/// what follows for the next attribute, and allocates what that seems to declare.
bool hasItsSize(std::string_view type, std::span<const std::byte> value) {
    static constexpr std::pair<std::string_view, std::size_t> kSizesBytes[] = {
        {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
        {"compression", 1}, {"double", 8},   {"envmap", 1},
        {"float", 4},       {"int", 4},      {"keycode", 28},
        {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
        {"m44d", 128},      {"m44f", 64},    {"rational", 8},
        {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
        {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
        {"v3f", 12},        {"v3i", 12},
    };
    for (const auto& [name, sizeBytes] : kSizesBytes) {
        if (name == type) return value.size() == sizeBytes;
    }
    if (type == "chlist") return isChannelList(value);
    if (type == "stringvector") return isTextList(value);
    if (type == "preview") {
        const std::uint64_t pixels = std::uint64_t{wordAt(value, 0)} * wordAt(value, 4);
        return value.size() >= 8 && pixels == (value.size() - 8) / 4;
    }
    return true;  // a text, or what the library keeps as it is
}

/// Walks over the attributes of all headers: the library allocates what an attribute declares
/// before it reads it.
void checkAttributeSizes(std::span<const std::byte> bytes, bool isMultiPart,
                         const std::string& name) {
    std::size_t at = 8;  // magic number and version
    const auto readText = [&] {
        const auto end = endOfText(bytes, at);
        if (!end) throw Error(name + ": the file ends early");
        const std::string_view text(reinterpret_cast<const char*>(&bytes[at]), *end - 1 - at);
        at = *end;
        return text;
    };
    while (true) {
        if (at < bytes.size() && bytes[at] == std::byte{0}) {  // the end of a header
            ++at;
            if (!isMultiPart || (at < bytes.size() && bytes[at] == std::byte{0})) return;
        }
        const std::string_view attribute = readText();
        const std::string_view type = readText();
        const std::uint32_t size = wordAt(bytes, at);
        if (at + sizeof(size) > bytes.size() || size > bytes.size() - at - sizeof(size)) {
            throw Error(name + ": an attribute reaches beyond the end of the file");
        }
        if (!hasItsSize(type, bytes.subspan(at + sizeof(size), size))) {
            throw Error(name + ": attribute '" + std::string(attribute) + "' has " +
                        std::to_string(size) + " bytes, which no '" + std::string(type) + "' has");
        }
        at += sizeof(size) + size;
    }
}

}  // namespace

void checkExrHeader(std::span<const std::byte> bytes, const std::string& name) {
    unsigned char start[8];  // magic number and version, little-endian
    if (bytes.size() < sizeof(start)) throw Error(name + ": not an OpenEXR file");
    std::memcpy(start, bytes.data(), sizeof(start));
    const auto word = [&start](int at) {
        return start[at] | start[at + 1] << 8 | start[at + 2] << 16 |
               static_cast<int>(static_cast<unsigned>(start[at + 3]) << 24);
    };
    if (word(0) != Imf::MAGIC) throw Error(name + ": not an OpenEXR file");
    int version = word(4);
    if (Imf::getVersion(version) != Imf::EXR_VERSION ||
        !Imf::supportsFlags(Imf::getFlags(version))) {
        throw Error(name + ": OpenEXR version " + std::to_string(Imf::getVersion(version)) +
                    " with flags that are not supported; 2 is read");
    }
    checkAttributeSizes(bytes, Imf::isMultiPart(version), name);
    MemoryStream stream(bytes, name);
    stream.seekg(sizeof(start));
    Imf::Header header;
    header.readFrom(stream, version);
    if (Imf::isNonImage(version) || (header.hasType() && Imf::isDeepData(header.type()))) {
        throw Error(name + ": deep images are not supported");
    }
    std::size_t channels = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) ++channels;
    const Imath::Box2i& window = header.dataWindow();
    checkDeclaredSize(std::int64_t{window.max.x} - window.min.x + 1,
                      std::int64_t{window.max.y} - window.min.y + 1, channels * sizeof(float),
                      bytes.size(), name);
    if (header.hasTileDescription()) {  // the library holds a tile, and a whole row of them
        const Imf::TileDescription& tile = header.tileDescription();
        const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
        checkDeclaredSize(std::max<std::int64_t>(tile.xSize, width), tile.ySize,
                          channels * sizeof(float), bytes.size(), name + ": tiles");
    }
}

}  // namespace gfxrepro::image
