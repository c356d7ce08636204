#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/image/colour_map.h"
#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/image_commands.h"

namespace gfxrepro::cli {

using image::ExrImage;
using image::Image8;
using image::ImageF;

namespace {

image::ToneMap toneMapOf(const std::string& name) {
    if (name == "reinhard") return image::ToneMap::Reinhard;
    return name == "aces" ? image::ToneMap::Aces : image::ToneMap::None;
}

image::ColourMap colourMapOf(const std::string& name) {
    if (name == "grey") return image::ColourMap::Grey;
    return name == "cool_warm" ? image::ColourMap::CoolWarm : image::ColourMap::Magma;
}

/// The channels that are named, in that order, with all attributes.
ExrImage picked(const ExrImage& image, const std::string& names, const std::string& file) {
    ExrImage result;
    result.attributes = image.attributes;
    result.matrices = image.matrices;
    std::vector<std::string> known;
    for (const ExrImage::Channel& channel : image.channels) known.push_back(channel.name);
    for (const std::string& name : split(names, ',')) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            throw UsageError(fmt::format("{}: no channel '{}'{}; it has {}", file, name,
                                         suggestion(name, known), joined(known)));
        }
        result.channels.push_back(image.channels[static_cast<std::size_t>(found - known.begin())]);
    }
    return result;
}

struct Range {
    float low = 0.0F, high = 1.0F;
};

Range parseRange(const std::string& text) {
    const std::vector<std::string> ends = split(text, ',');
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const double low = parseDouble(ends.front()).value_or(kNone);
    const double high = ends.size() == 2 ? parseDouble(ends.back()).value_or(kNone) : kNone;
    if (!(low < high) && !(low > high)) {
        throw UsageError(
            fmt::format("--range: expected two numbers that differ, low,high; found '{}'", text));
    }
    return {static_cast<float>(low), static_cast<float>(high)};
}

/// Of the finite values; depths of 0 are of pixels that show nothing.
Range rangeOf(const ExrImage::Channel& channel) {
    Range range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (const float value : channel.values.values()) {
        if (!std::isfinite(value) || (channel.name == "Z" && value == 0.0F)) continue;
        range.low = std::min(range.low, value);
        range.high = std::max(range.high, value);
    }
    if (range.low > range.high) return {};
    if (range.low == range.high) range.high = range.low + 1.0F;
    return range;
}

/// Values of both signs, as an error's, get a map whose middle is 0.
Image8 falseColours(const ExrImage::Channel& channel, const ImageConvertOptions& options) {
    Range range = options.range.empty() ? rangeOf(channel) : parseRange(options.range);
    std::string colours = options.colours;
    if (colours == "auto") {
        const bool isSigned = range.low * range.high < 0.0F;
        colours = isSigned ? "cool_warm" : "magma";
        if (isSigned && options.range.empty()) {
            range.high = std::max(-range.low, range.high);
            range.low = -range.high;
        }
    }
    say("{}: {:g} to {:g} in {}\n", channel.name, range.low, range.high, colours);
    return image::coloured(channel.values, colourMapOf(colours), range.low, range.high);
}

bool areDirections(const ExrImage& image) {
    return image.channels[0].name.ends_with(".X") && image.channels[1].name.ends_with(".Y") &&
           image.channels[2].name.ends_with(".Z");
}

ImageF interleaved(const ExrImage& image) {
    ImageF result(image.width(), image.height(), static_cast<int>(image.channels.size()));
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (std::size_t c = 0; c < image.channels.size(); ++c) {
                result.at(x, y, static_cast<int>(c)) = image.channels[c].values.at(x, y);
            }
        }
    }
    return result;
}

Image8 directionPicture(const ImageF& directions) {
    Image8 picture(directions.width(), directions.height(), 3);
    for (std::size_t i = 0; i < picture.values().size(); ++i) {
        const float shown = std::clamp(0.5F + 0.5F * directions.values()[i], 0.0F, 1.0F);
        picture.values()[i] = static_cast<std::uint8_t>(255.0F * shown + 0.5F);
    }
    return picture;
}

Image8 shown(const ImageF& linear, const ImageConvertOptions& options) {
    return image::toSrgb8(image::toneMapped(linear, static_cast<float>(options.exposureStops),
                                            toneMapOf(options.toneMap)));
}

Image8 convertedPicture(const ImageConvertOptions& options) {
    if (options.channels.empty()) {
        if (!options.range.empty()) throw UsageError("--range is of one channel: give --channels");
        return shown(image::readLinear(options.in), options);
    }
    if (!image::isExrFile(options.in)) {
        throw UsageError(options.in + ": --channels is for EXR files");
    }
    const ExrImage image = picked(image::readExr(options.in), options.channels, options.in);
    if (image.channels.size() == 1) return falseColours(image.channels[0], options);
    if (!options.range.empty()) throw UsageError("--range is of one channel: name one");
    if (image.channels.size() != 3) {
        throw UsageError(fmt::format("--channels takes 1 or 3 names for a PNG, found {}",
                                     image.channels.size()));
    }
    if (areDirections(image)) return directionPicture(interleaved(image));
    return shown(interleaved(image), options);
}

ExrImage exrOf(const ImageF& image) {
    static const std::vector<std::string> kNames[] = {
        {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    ExrImage exr;
    exr.add(image, kNames[image.channels()]);
    return exr;
}

ExrImage exrFrom(const ImageConvertOptions& options) {
    if (options.toneMap != "none" || !options.range.empty()) {
        throw UsageError("--tonemap and --range are for PNG files; an EXR keeps its numbers");
    }
    ExrImage exr = image::isExrFile(options.in) ? image::readExr(options.in)
                                                : exrOf(image::readLinear(options.in));
    if (!options.channels.empty()) exr = picked(exr, options.channels, options.in);
    const auto scale = static_cast<float>(std::exp2(options.exposureStops));
    for (ExrImage::Channel& channel : exr.channels) {
        const bool isColour = channel.name == "R" || channel.name == "G" || channel.name == "B" ||
                              channel.name == "Y";
        if (!isColour) continue;
        for (float& value : channel.values.values()) value *= scale;
    }
    return exr;
}

}  // namespace

int imageConvert(const ImageConvertOptions& options) {
    image::isExrFile(options.in);
    requireNoInput(options.out, {&options.in, 1});
    if (image::isExrFile(options.out)) {
        image::writeExr(options.out, exrFrom(options));
    } else {
        image::writePng(options.out, convertedPicture(options));
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
