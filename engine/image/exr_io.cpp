#include "engine/image/exr_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <utility>

#include "engine/core/files.h"
#include "engine/image/exr_stream.h"

namespace gfxrepro::image {

namespace {

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

ExrImage decoded(std::span<const std::byte> bytes, const std::string& name) {
    checkExrHeader(bytes, name);
    MemoryStream stream(bytes, name);
    Imf::InputFile file(stream, kCallingThreadOnly);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    const int width = window.max.x - window.min.x + 1;
    const int height = window.max.y - window.min.y + 1;

    ExrImage image;
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
        const Imf::Channel& stored = header.channels()[channel.name.c_str()];
        if (stored.xSampling == 1 && stored.ySampling == 1) continue;
        channel.values =
            repeated(channel.values, width, height, stored.xSampling, stored.ySampling);
    }
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
    constexpr float kMost = 0x1p24F;
    for (const float value : channel.values.values()) {
        if (value >= 0.0F && value <= kMost && value == std::floor(value)) continue;
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
    Imf::Header header(image.width(), image.height());
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
        frameBuffer.insert(channel.name, Imf::Slice(to.type, to.bytes.data(), to.valueBytes,
                                                    width * to.valueBytes));
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

ImageF ExrImage::colour() const {
    std::vector<const ImageF*> planes{find("R"), find("G"), find("B")};
    if (planes[0] == nullptr || planes[1] == nullptr || planes[2] == nullptr) {
        const ImageF* single = find("Y") != nullptr ? find("Y") : find("Z");
        if (single != nullptr) return *single;
        std::string names;
        for (const Channel& channel : channels) names += " '" + channel.name + "'";
        throw Error("the image has the channels" + names + "; R, G, B or Y or Z are needed");
    }
    if (find("A") != nullptr) planes.push_back(find("A"));
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
