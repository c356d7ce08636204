#include "engine/image/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "engine/image/exr_io.h"
#include "engine/image/formats.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {
namespace {

struct Format {
    std::string_view name;
    std::string_view magic;    // that its files begin with
    std::string_view endings;  // ".a.b"
};
using namespace std::string_view_literals;
constexpr Format kFormats[] = {
    {"exr", "v/1\x01", ".exr"},
    {"png", "\x89PNG", ".png"},
    {"pfm", "PF", ".pfm"},
    {"pfm", "Pf", ".pfm"},
    {"hdr", "#?", ".hdr"},
    {"pnm", "P1", ".pbm.pgm.ppm.pnm"},
    {"pnm", "P2", ".pbm.pgm.ppm.pnm"},
    {"pnm", "P3", ".pbm.pgm.ppm.pnm"},
    {"pnm", "P4", ".pbm.pgm.ppm.pnm"},
    {"pnm", "P5", ".pbm.pgm.ppm.pnm"},
    {"pnm", "P6", ".pbm.pgm.ppm.pnm"},
    {"tga", "", ".tga"},
    {"tiff", "II*\0"sv, ".tif.tiff"},
    {"tiff", "MM\0*"sv, ".tif.tiff"},
    {"jpeg", "\xFF\xD8\xFF", ".jpg.jpeg"},
};

/// Makes values and colours of a PNG file those of sRGB.
void makeSrgb(const PngColours& given, const std::string& name, Decoded& decoded) {
    if (given.gamma == 0.0 && !given.primaries) return;
    ImageF& values = decoded.values;
    const auto channels = static_cast<std::size_t>(values.channels());
    const std::size_t colours = channels < 3 ? 1 : 3;
    std::optional<ToRec709> toRec709;
    if (given.primaries && colours == 3) toRec709.emplace(*given.primaries, name);
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < values.values().size(); i += channels) {
        std::array<float, 3> light{};
        for (std::size_t c = 0; c < colours; ++c) {
            const float value = values.values()[i + c];
            light[c] = given.gamma == 0.0 ? linearOf(value)
                                          : std::pow(value, static_cast<float>(1.0 / given.gamma));
        }
        if (toRec709) light = (*toRec709)(light);
        constexpr float kRounding = 1e-4F;
        const auto [least, most] = std::ranges::minmax(light);
        if (least < -kRounding || most > 1.0F + kRounding) ++beyond;
        for (std::size_t c = 0; c < colours; ++c) {
            values.values()[i + c] = srgbOf(std::clamp(light[c], 0.0F, 1.0F));
        }
    }
    decoded.bits = 16;
    if (given.gamma != 0.0) {
        decoded.notes.push_back(
            fmt::format("its values are converted from a gamma of {:g} to sRGB", given.gamma));
    }
    if (toRec709) decoded.notes.emplace_back(kConvertedPrimaries);
    if (beyond > 0) {
        decoded.notes.push_back(
            fmt::format("pixels of colours beyond Rec. 709, which are cut: {}", beyond));
    }
}

Decoded decodedPng(const std::filesystem::path& path) {
    PngRows stored(path, kMaxSidePx, ImageUse::Picture);
    Decoded result{ImageF(stored.width(), stored.height(), stored.channels()), false,
                   stored.bitDepth() == 16 ? 16 : 8};
    ImageF& values = result.values;
    std::vector<std::uint16_t> row(values.row(0).size());
    for (int y = 0; y < values.height(); ++y) {
        stored.read(row.data());
        std::ranges::transform(row, values.row(y).begin(), [](std::uint16_t value) {
            return static_cast<float>(value) / 65535.0F;
        });
    }
    const MappedFile file(path);
    const PngColours colours = pngColours(file.bytes(), path.string());
    result.notes = colours.notes;
    result.notes.insert(result.notes.end(), colours.notesOfFile.begin(), colours.notesOfFile.end());
    if (colours.beyondPalette > 0) {
        result.notes.push_back(
            fmt::format("pixels of colours that its palette has not: {}; they are black",
                        colours.beyondPalette));
    }
    makeSrgb(colours, path.string(), result);
    if (!colours.exif.empty()) values = turnedAsExif(values, colours.exif);
    return result;
}

Decoded decodedFile(const std::filesystem::path& path, std::string_view format) {
    if (format == "png") return decodedPng(path);
    if (format == "tiff") return readTiff(path);
    const MappedFile file(path);
    if (format == "jpeg") return decodeJpeg(file.bytes(), path.string());
    if (format == "hdr") return decodeHdr(file.bytes(), path.string());
    if (format == "tga") return decodeTga(file.bytes(), path.string());
    return decodeNetpbm(file.bytes(), path.string());
}

/// Of sRGB beside its alpha.
ImageF lightOf(ImageF image) {
    const auto channels = static_cast<std::size_t>(image.channels());
    const bool hasAlpha = isAlpha(channels - 1, channels);
    const std::size_t colours = hasAlpha ? channels - 1 : channels;
    for (std::size_t i = 0; i < image.values().size(); i += channels) {
        for (float& value : image.values().subspan(i, colours)) {
            value = linearOf(value) * (hasAlpha ? image.values()[i + colours] : 1.0F);
        }
    }
    return image;
}

/// What `display` shows of an image whose pixels lie in `data`.
Picture shownOf(ImageF linear, const Rectangle& data, const Rectangle& display,
                const std::filesystem::path& path) {
    Rectangle part = intersection(data, display);
    if (part.width == 0 || part.height == 0) {
        const auto text = [](const Rectangle& r) {
            return fmt::format("{}x{} from ({}, {})", r.width, r.height, r.left, r.top);
        };
        throw Error(fmt::format("{}: its pixels, {}, lie outside of its display window, {}",
                                path.string(), text(data), text(display)));
    }
    part.left -= data.left;
    part.top -= data.top;
    if (part.width < data.width || part.height < data.height) linear = cropped(linear, part);
    part.left += data.left - display.left;
    part.top += data.top - display.top;
    Picture picture;
    picture.stored = linear;
    picture.linear = std::move(linear);
    picture.isLinear = true;
    picture.width = display.width;
    picture.height = display.height;
    picture.part = part;
    return picture;
}

/// Names the channels of which a picture has nothing: layers, depths, identifiers.
void noteOtherChannels(const ExrImage& exr, std::vector<std::string>& notes) {
    constexpr std::size_t kMostNamed = 8;
    const std::vector<std::string> used = exr.colourNames();
    std::vector<std::string> others;
    for (const ExrImage::Channel& channel : exr.channels) {
        if (std::ranges::find(used, channel.name) == used.end()) others.push_back(channel.name);
    }
    if (others.empty()) return;
    const std::size_t named = std::min(others.size(), kMostNamed);
    notes.push_back(fmt::format(
        "left out: the channels {}{}", joined(std::span(others).first(named)),
        named < others.size() ? fmt::format(" and {} more", others.size() - named) : ""));
}

void noteNonFinite(const ImageF& image, std::vector<std::string>& notes) {
    const auto channels = static_cast<std::size_t>(image.channels());
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < image.values().size(); i += channels) {
        pixels += !std::ranges::all_of(image.values().subspan(i, channels),
                                       [](float value) { return std::isfinite(value); });
    }
    if (pixels == 0) return;
    notes.push_back(
        fmt::format("pixels that are not finite: {}; NaN is shown black, infinity white", pixels));
}

}  // namespace

bool isExrFile(const std::filesystem::path& path) {
    const std::string extension = path.extension();
    if (extension == ".exr" || extension == ".png") return extension == ".exr";
    throw UsageError(path.string() + ": is neither .exr nor .png");
}

const std::string& readEndings() {
    static const std::string kText = [] {
        std::string text;
        for (const Format& format : kFormats) {
            if (text.find(format.endings) == std::string::npos) text += format.endings;
        }
        for (std::size_t at = 1; (at = text.find('.', at)) != std::string::npos; at += 3) {
            text.replace(at, 1, ", .");
        }
        return text;
    }();
    return kText;
}

bool hasReadEnding(const std::string& name) {
    const std::string ending = std::filesystem::path(name).extension();
    return ending.size() > 1 && (readEndings() + ",").find(ending + ",") != std::string::npos;
}

std::string_view formatOf(const std::filesystem::path& path) {
    const MappedFile file(path);
    for (const Format& format : kFormats) {
        if (!format.magic.empty() && file.text().starts_with(format.magic)) return format.name;
    }
    const std::string ending = path.extension();
    for (const Format& format : kFormats) {
        if (hasReadEnding(path) && format.endings.find(ending) != std::string_view::npos) {
            return format.name;
        }
    }
    throw Error(path.string() + ": no picture of a format that is read; allowed: " + readEndings());
}

Picture readPicture(const std::filesystem::path& path) {
    const std::string_view format = formatOf(path);
    if (format == "exr") {
        const ExrImage exr = readExr(path);
        Picture picture = shownOf(exr.colour(), exr.dataWindow(), exr.shownWindow(), path);
        picture.notes = exr.notes;
        noteOtherChannels(exr, picture.notes);
        noteNonFinite(picture.stored, picture.notes);
        return picture;
    }
    Decoded decoded = decodedFile(path, format);
    const Rectangle whole{0, 0, decoded.values.width(), decoded.values.height()};
    Picture picture = shownOf(std::move(decoded.values), whole, whole, path);
    picture.notes = std::move(decoded.notes);
    if (decoded.isLinear) {
        noteNonFinite(picture.stored, picture.notes);
        return picture;
    }
    picture.isLinear = false;
    picture.linear = lightOf(std::move(picture.linear));
    picture.bits = decoded.bits;
    return picture;
}

void keepCommon(Picture& a, Picture& b) {
    if (a.isWhole() && b.isWhole()) return;
    const Rectangle common = intersection(a.part, b.part);
    if (a.width != b.width || a.height != b.height || common.width == 0 || common.height == 0) {
        throw Error(fmt::format("the images show no place that both have: {} and {}", placeOf(a),
                                placeOf(b)));
    }
    for (Picture* picture : {&a, &b}) {
        const Rectangle part{common.left - picture->part.left, common.top - picture->part.top,
                             common.width, common.height};
        picture->stored = cropped(picture->stored, part);
        picture->linear = cropped(picture->linear, part);
        picture->part = common;
    }
}

std::string placeOf(const Picture& picture) {
    return fmt::format("{}x{} pixels from ({}, {}) of {}x{}", picture.part.width,
                       picture.part.height, picture.part.left, picture.part.top, picture.width,
                       picture.height);
}

}  // namespace gfxrepro::image
