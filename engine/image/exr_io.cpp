#include "engine/image/exr_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "engine/image/formats.h"
#include "engine/image/image.h"

namespace gfxrepro::image {
namespace {

/// OpenEXR's view of a mapped file.
class MemoryStream : public Imf::IStream {
  public:
    MemoryStream(std::span<const std::byte> bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}

    /// False at the end of the file; throws when it ends before `count`.
    bool read(char to[], int count) override {
        const auto wanted = static_cast<std::uint64_t>(count);
        if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_) {
            const std::uint64_t there = bytes_.size() - std::min(position_, bytes_.size());
            throw std::runtime_error(endsEarly("", position_, wanted, there));
        }
        std::memcpy(to, bytes_.data() + position_, wanted);
        position_ += wanted;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t position_ = 0;
};

/// Little-endian, of 4 bytes.
std::size_t wordAt(std::span<const std::byte> bytes, std::size_t at) {
    return numberAt(bytes, at, 4, true);
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
        const std::uint64_t pixels = wordAt(value, 0) * wordAt(value, 4);
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
        if (!end) throw Error(name + ": " + endsEarly("its header", bytes.size(), 1, 0));
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
        const std::size_t size = wordAt(bytes, at);
        constexpr std::size_t kSizeBytes = 4;
        if (at + kSizeBytes > bytes.size() || size > bytes.size() - at - kSizeBytes) {
            throw Error(name + ": an attribute reaches beyond the end of the file");
        }
        if (!hasItsSize(type, bytes.subspan(at + kSizeBytes, size))) {
            throw Error(name + ": attribute '" + std::string(attribute) + "' has " +
                        std::to_string(size) + " bytes, which no '" + std::string(type) + "' has");
        }
        at += kSizeBytes + size;
    }
}

std::string channelNames(const Imf::Header& header) {
    std::string names;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        names += (names.empty() ? "" : ", ") + std::string(i.name());
    }
    return names;
}

/// Checks what the headers declare before the library allocates for it. Throws Error, which begins
/// with `name`, for what is no OpenEXR image, has several parts, is deep, or declares more than
/// checkDeclaredSize() allows.
void checkExrHeader(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t kStartBytes = 8;  // magic number and version
    if (bytes.size() < kStartBytes || wordAt(bytes, 0) != Imf::MAGIC) {
        throw Error(name + ": not an OpenEXR file");
    }
    auto version = static_cast<int>(wordAt(bytes, 4));
    if (Imf::getVersion(version) != Imf::EXR_VERSION ||
        !Imf::supportsFlags(Imf::getFlags(version))) {
        throw Error(name + ": OpenEXR version " + std::to_string(Imf::getVersion(version)) +
                    " with flags that are not supported; 2 is read");
    }
    checkAttributeSizes(bytes, Imf::isMultiPart(version), name);
    MemoryStream stream(bytes, name);
    stream.seekg(kStartBytes);
    std::vector<Imf::Header> parts;
    bool isLast = false;
    while (!isLast) {
        parts.emplace_back().readFrom(stream, version);
        isLast = !Imf::isMultiPart(version) || stream.tellg() >= bytes.size() ||
                 bytes[stream.tellg()] == std::byte{0};
    }
    if (parts.size() > 1) {
        std::string names;
        for (const Imf::Header& part : parts) {
            names += (names.empty() ? "'" : ", '") + (part.hasName() ? part.name() : "") +
                     "' with " + channelNames(part);
        }
        throw Error(name + ": has " + std::to_string(parts.size()) + " parts: " + names +
                    "; one is allowed, which 'exrmultipart -separate' makes of each");
    }
    const Imf::Header& header = parts.front();
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

constexpr int kCallingThreadOnly = 0;
constexpr int kZipLevel = 1;  // of 1 … 9: a run writes hundreds of images, and waits for each

int sampledCount(int count, int sampling) {
    return (count + sampling - 1) / sampling;
}

/// Values of a channel that is stored at every (x, y) sampling-th pixel, repeated over the pixels.
ImageF repeated(const ImageF& sampled, int width, int height, int xSampling, int ySampling) {
    ImageF result(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            result.at(x, y) = sampled.at(x / xSampling, y / ySampling);
        }
    }
    return result;
}

ExrPixelType pixelTypeOf(Imf::PixelType type) {
    return type == Imf::HALF    ? ExrPixelType::Half
           : type == Imf::FLOAT ? ExrPixelType::Float
                                : ExrPixelType::Uint;
}

/// Makes R, G and B those of Rec. 709's primaries, what a file without chromaticities has.
void takePrimaries(const Imf::Chromaticities& given, const std::string& name, ExrImage& image) {
    if (given == Imf::Chromaticities()) return;
    ImageF* planes[3] = {};
    for (ExrImage::Channel& channel : image.channels) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (channel.name == std::string(1, "RGB"[c])) planes[c] = &channel.values;
        }
    }
    if (planes[0] == nullptr || planes[1] == nullptr || planes[2] == nullptr) return;
    const ToRec709 toRec709({given.red.x, given.red.y, given.green.x, given.green.y, given.blue.x,
                             given.blue.y, given.white.x, given.white.y},
                            name);
    for (std::size_t i = 0; i < planes[0]->values().size(); ++i) {
        const auto colour =
            toRec709({planes[0]->values()[i], planes[1]->values()[i], planes[2]->values()[i]});
        for (std::size_t c = 0; c < 3; ++c) planes[c]->values()[i] = colour[c];
    }
    image.notes.emplace_back(kConvertedPrimaries);
}

/// Whether a text of this name says in which space the colours are, and another than Rec. 709's
/// light.
bool isOtherSpace(const std::string& name, const std::string& space) {
    static constexpr std::string_view kLinear[] = {"lin_rec709",
                                                   "lin_rec709_scene",
                                                   "lin_srgb",
                                                   "linear",
                                                   "linear srgb",
                                                   "linear rec.709",
                                                   "linear rec.709 (srgb)",
                                                   "utility - linear - srgb",
                                                   "scene_linear",
                                                   "data",
                                                   "raw"};
    if (name != "colorInteropID" && name != "oiio:ColorSpace" && name != "colorSpace") return false;
    return std::ranges::find(kLinear, lowerCase(space)) == std::end(kLinear);
}

/// Names what might change how the pixels are seen and is not used here.
void noteOthers(const Imf::Header& header, ExrImage& image) {
    static constexpr std::string_view kChangeNothing =
        " capDate channels chromaticities chunkCount compression dataWindow displayWindow "
        "dwaCompressionLevel lineOrder maxSamplesPerPixel name owner preview screenWindowCenter "
        "screenWindowWidth tiles type utcOffset version ";
    std::string others;
    for (auto i = header.begin(); i != header.end(); ++i) {
        const std::string name = i.name();
        const std::string type = i.attribute().typeName();
        if (kChangeNothing.find(' ' + name + ' ') != kChangeNothing.npos) continue;
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute())) {  // kept
            if (!isOtherSpace(name, text->value())) continue;
            others += fmt::format("{}{} ('{}')", others.empty() ? "" : ", ", name, text->value());
            continue;
        }
        if (type == "m44f") continue;  // kept
        if (name == "pixelAspectRatio" && header.pixelAspectRatio() == 1.0F) continue;
        others += (others.empty() ? "" : ", ") + name;
    }
    if (!others.empty()) image.notes.push_back("not used of its attributes: " + others);
}

constexpr float kMostWhole = 0x1p24F;  // from there on floats pass over whole numbers

/// Before its values are repeated where the file has fewer.
void noteRounding(const ExrImage::Channel& channel, Imf::InputFile& file,
                  std::vector<std::string>& notes) {
    if (std::ranges::max(channel.values.values()) < kMostWhole) return;
    const Imf::Channel& stored = file.header().channels()[channel.name.c_str()];
    const Imath::Box2i window = file.header().dataWindow();
    std::vector<std::uint32_t> values(channel.values.values().size());  // as the file has them
    Imf::FrameBuffer frameBuffer;
    frameBuffer.insert(
        channel.name,
        Imf::Slice::Make(Imf::UINT, values.data(), window, sizeof(std::uint32_t),
                         static_cast<std::size_t>(channel.values.width()) * sizeof(std::uint32_t),
                         stored.xSampling, stored.ySampling));
    file.setFrameBuffer(frameBuffer);
    file.readPixels(window.min.y, window.max.y);
    const std::uint32_t largest = std::ranges::max(values);
    if (largest <= std::uint32_t{1} << 24) return;
    notes.push_back(
        fmt::format("channel '{}' holds whole numbers up to {}; above {:.0f} they are rounded",
                    channel.name, largest, kMostWhole));
}

Rectangle rectangleOf(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

ExrImage decoded(std::span<const std::byte> bytes, const std::string& name) {
    checkExrHeader(bytes, name);
    MemoryStream stream(bytes, name);
    Imf::InputFile file(stream, kCallingThreadOnly);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    const auto [left, top, width, height] = rectangleOf(window);

    ExrImage image;
    image.left = left;
    image.top = top;
    if (header.displayWindow() != window) {
        image.displayWindow = rectangleOf(header.displayWindow());
    }
    Imf::FrameBuffer frameBuffer;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        const Imf::Channel& channel = i.channel();
        image.channels.push_back({i.name(), pixelTypeOf(channel.type),
                                  ImageF(sampledCount(width, channel.xSampling),
                                         sampledCount(height, channel.ySampling), 1)});
        ImageF& values = image.channels.back().values;
        frameBuffer.insert(
            i.name(), Imf::Slice::Make(Imf::FLOAT, values.values().data(), window, sizeof(float),
                                       static_cast<std::size_t>(values.width()) * sizeof(float),
                                       channel.xSampling, channel.ySampling));
    }
    file.setFrameBuffer(frameBuffer);
    file.readPixels(window.min.y, window.max.y);

    for (ExrImage::Channel& channel : image.channels) {
        if (channel.type == ExrPixelType::Uint) noteRounding(channel, file, image.notes);
        const Imf::Channel& stored = header.channels()[channel.name.c_str()];
        if (stored.xSampling == 1 && stored.ySampling == 1) continue;
        channel.values =
            repeated(channel.values, width, height, stored.xSampling, stored.ySampling);
    }
    if (Imf::hasChromaticities(header)) takePrimaries(Imf::chromaticities(header), name, image);
    noteOthers(header, image);
    for (auto i = header.begin(); i != header.end(); ++i) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute());
        if (text != nullptr) image.attributes[i.name()] = text->value();
        const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&i.attribute());
        if (matrix != nullptr) {
            std::copy_n(&matrix->value()[0][0], 16, image.matrices[i.name()].begin());
        }
    }
    return image;
}

void checkWhole(const ExrImage::Channel& channel) {
    for (const float value : channel.values.values()) {
        if (value >= 0.0F && value <= kMostWhole && value == std::floor(value)) continue;
        throw Error("channel '" + channel.name + "' holds " + std::to_string(value) +
                    "; whole numbers from 0 to 16777216 are allowed");
    }
}

/// Refuses what a file cannot hold; OpenEXR itself would keep the last of two equal names.
void checkWritable(const ExrImage& image) {
    if (image.width() == 0 || image.height() == 0) throw Error("the image has no pixels");
    for (auto channel = image.channels.begin(); channel != image.channels.end(); ++channel) {
        if (channel->values.width() != image.width() ||
            channel->values.height() != image.height() || channel->values.channels() != 1) {
            throw Error("channel '" + channel->name + "' differs in size from the first");
        }
        const auto sameName = [&](const auto& other) { return other.name == channel->name; };
        if (std::any_of(image.channels.begin(), channel, sameName)) {
            throw Error("channel '" + channel->name + "' is there twice");
        }
        if (channel->type == ExrPixelType::Uint) checkWhole(*channel);
    }
}

/// The values of a channel as a file holds them.
struct StoredChannel {
    Imf::PixelType type = Imf::HALF;
    std::size_t valueBytes = 0;
    std::vector<char> bytes = {};

    explicit StoredChannel(const ExrImage::Channel& channel) {
        const std::span<const float> values = channel.values.values();
        switch (channel.type) {
            case ExrPixelType::Half:
                store<half>(Imf::HALF, values);
                break;
            case ExrPixelType::Float:
                store<float>(Imf::FLOAT, values);
                break;
            case ExrPixelType::Uint:
                store<std::uint32_t>(Imf::UINT, values);
                break;
        }
    }

  private:
    template <class T>
    void store(Imf::PixelType asType, std::span<const float> values) {
        type = asType;
        valueBytes = sizeof(T);
        bytes.resize(values.size() * sizeof(T));
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto value = static_cast<T>(values[i]);
            std::memcpy(&bytes[i * sizeof(T)], &value, sizeof(T));
        }
    }
};

std::string encoded(const ExrImage& image) {
    checkWritable(image);
    const auto boxOf = [](const Rectangle& r) {
        return Imath::Box2i({r.left, r.top}, {r.left + r.width - 1, r.top + r.height - 1});
    };
    Imf::Header header(boxOf(image.shownWindow()), boxOf(image.dataWindow()));
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = kZipLevel;
    for (const auto& [key, value] : image.attributes) {
        header.insert(key, Imf::StringAttribute(value));
    }
    for (const auto& [key, value] : image.matrices) {
        Imath::M44f matrix;
        std::copy(value.begin(), value.end(), &matrix[0][0]);
        header.insert(key, Imf::M44fAttribute(matrix));
    }
    Imf::FrameBuffer frameBuffer;
    std::vector<StoredChannel> stored;  // keeps what the frame buffer points to
    const auto width = static_cast<std::size_t>(image.width());
    for (const ExrImage::Channel& channel : image.channels) {
        StoredChannel& to = stored.emplace_back(channel);
        header.channels().insert(channel.name, Imf::Channel(to.type));
        frameBuffer.insert(channel.name,
                           Imf::Slice::Make(to.type, to.bytes.data(), header.dataWindow(),
                                            to.valueBytes, width * to.valueBytes));
    }
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header, kCallingThreadOnly);
        file.setFrameBuffer(frameBuffer);
        file.writePixels(image.height());
    }  // the end writes the table of offsets
    return stream.str();
}

}  // namespace

ToRec709::ToRec709(const Chromaticities& given, const std::string& name) : rows_{} {
    const Imf::Chromaticities from({given[0], given[1]}, {given[2], given[3]}, {given[4], given[5]},
                                   {given[6], given[7]});
    const Imath::M44f matrix =
        Imf::RGBtoXYZ(from, 1.0F) * Imf::XYZtoRGB(Imf::Chromaticities(), 1.0F);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        rows_[i] = matrix[static_cast<int>(i / 3)][i % 3];
        if (std::isfinite(rows_[i])) continue;
        throw Error(name + ": its chromaticities are those of no colours");
    }
}

std::array<float, 3> ToRec709::operator()(const std::array<float, 3>& rgb) const {
    std::array<float, 3> result{};
    for (std::size_t c = 0; c < 3; ++c) {
        result[c] = rgb[0] * rows_[c] + rgb[1] * rows_[3 + c] + rgb[2] * rows_[6 + c];
    }
    return result;
}

const ImageF* ExrImage::find(const std::string& name) const {
    const auto channel = std::find_if(channels.begin(), channels.end(),
                                      [&](const Channel& each) { return each.name == name; });
    return channel == channels.end() ? nullptr : &channel->values;
}

void ExrImage::add(const ImageF& image, const std::vector<std::string>& names, ExrPixelType type) {
    GFXREPRO_ASSERT_EQ(static_cast<std::size_t>(image.channels()), names.size());
    for (int channel = 0; channel < image.channels(); ++channel) {
        ImageF plane(image.width(), image.height(), 1);
        for (int y = 0; y < image.height(); ++y) {
            for (int x = 0; x < image.width(); ++x) plane.at(x, y) = image.at(x, y, channel);
        }
        channels.push_back({names[static_cast<std::size_t>(channel)], type, std::move(plane)});
    }
}

std::vector<std::string> ExrImage::colourNames() const {
    std::vector<std::string> used{"R", "G", "B"};
    const auto isThere = [this](const std::string& name) { return find(name) != nullptr; };
    if (!std::ranges::all_of(used, isThere)) {
        // Beside these Y and Z are no luminance and no depth: a colour (CIE XYZ, with chroma), a
        // place.
        const bool isPart = std::ranges::any_of(channels, [](const Channel& channel) {
            return channel.name == "RY" || channel.name == "BY" ||
                   (channel.name.size() == 1 && std::strchr("XRGB", channel.name[0]) != nullptr);
        });
        if (!isPart && !isThere("Y") && isThere("Z")) return {"Z"};
        if (isPart || !isThere("Y")) {
            std::string names;
            for (const Channel& channel : channels) names += " '" + channel.name + "'";
            throw Error("the image has the channels" + names + "; R, G, B or Y or Z are needed");
        }
        used = {"Y"};
    }
    if (isThere("A")) used.emplace_back("A");
    return used;
}

ImageF ExrImage::colour() const {
    std::vector<const ImageF*> planes;
    for (const std::string& name : colourNames()) planes.push_back(find(name));
    ImageF result(width(), height(), static_cast<int>(planes.size()));
    for (int y = 0; y < height(); ++y) {
        for (int x = 0; x < width(); ++x) {
            for (std::size_t c = 0; c < planes.size(); ++c) {
                result.at(x, y, static_cast<int>(c)) = planes[c]->at(x, y);
            }
        }
    }
    return result;
}

ExrImage readExr(const std::filesystem::path& path) {
    const MappedFile file(path);
    try {
        return decoded(file.bytes(), path.string());
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

void writeExr(const std::filesystem::path& path, const ExrImage& image) {
    std::string content;
    try {
        content = encoded(image);
    } catch (const std::exception& error) {
        throw Error("cannot write " + path.string() + ": " + error.what());
    }
    writeFileAtomic(path, content);
}

}  // namespace gfxrepro::image
