// `gfxrepro image …`.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/image/contact_sheet.h"
#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/image/srgb.h"
#include "engine/metrics/error_map.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/image_error.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"

namespace gfxrepro::cli {

using image::ExrImage;
using image::Image8;
using image::ImageF;

namespace {

CLI::Option* addFile(CLI::App* app, const char* name, std::string& file, const std::string& doc) {
    return app->add_option(name, file, doc)->required()->option_text("FILE");
}

void addOut(CLI::App* app, std::string& file, const char* doc) {
    app->add_option("--out", file, doc)->required()->option_text("FILE");
}

/// `values` as the help shows them: "a|b|c".
CLI::Option* addChoice(CLI::App* app, const char* name, std::string& value, const char* values,
                       const char* doc) {
    return app->add_option(name, value, doc)
        ->check(CLI::IsMember(split(values, '|')))
        ->option_text(values);
}

void addDiff(CLI::App& image, ImageDiffOptions& o, std::function<int()>& command) {
    const std::string kinds = "a linear file (EXR, PFM, HDR, float TIFF) or one of sRGB (the rest)";
    CLI::App* app = image.add_subcommand("diff", "errors of an image, and a map of them");
    addFile(app, "reference", o.reference, "the reference: " + kinds);
    addFile(app, "test", o.test, "the image to compare with it, of the same kind");
    app->add_option("--metric", o.metrics,
                    "one or more, separated by commas (default: all that apply)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"mse", "psnr", "ssim", "flip", "max"}))
        ->option_text("mse|psnr|ssim|flip|max");
    addChoice(app, "--flip", o.flip, "auto|ldr|hdr", "auto: hdr for linear values above 1");
    app->add_option("--out", o.out, "write the error map: .png to look at, .exr for numbers")
        ->option_text("FILE");
    addChoice(app, "--map", o.map, "abs|signed|flip", "signed: red where the test is too dark");
    app->add_option("--gain", o.gain, "factor of the abs and signed maps")
        ->check(CLI::Range(1e-6, 1e6))
        ->option_text("K");
    app->add_flag("--json", o.asJson, "machine-readable");
    app->callback([&] { command = [&] { return imageDiff(o); }; });
}

void addConvert(CLI::App& image, ImageConvertOptions& o, std::function<int()>& command) {
    CLI::App* app = image.add_subcommand("convert", "any to EXR or PNG");
    addFile(app, "in", o.in, image::readEndings());
    addOut(app, o.out, "EXR or PNG");
    app->add_option("--exposure", o.exposureStops, "colours times 2^STOPS")
        ->check(CLI::Range(-100.0, 100.0))
        ->option_text("STOPS");
    app->callback([&] { command = [&] { return imageConvert(o); }; });
}

void addCrop(CLI::App& image, ImageCropOptions& o, std::function<int()>& command) {
    CLI::App* app = image.add_subcommand("crop", "a part of an image, its pixels magnified");
    addFile(app, "in", o.in, "EXR (all channels stay), or any other");
    addOut(app, o.out, "EXR of a linear file, else PNG");
    const auto addNumber = [&](const char* name, int& number, const char* doc, const char* text) {
        app->add_option(name, number, doc)->required()->option_text(text);
    };
    addNumber("x", o.left, "first column", "X");
    addNumber("y", o.top, "first row from the top", "Y");
    addNumber("width", o.width, "pixels", "WIDTH");
    addNumber("height", o.height, "pixels", "HEIGHT");
    app->add_option("--scale", o.scale, "show each pixel as N x N")->option_text("N");
    app->callback([&] { command = [&] { return imageCrop(o); }; });
}

void addSheet(CLI::App& image, ImageSheetOptions& o, std::function<int()>& command) {
    CLI::App* app = image.add_subcommand("contact-sheet", "many images on one PNG");
    app->add_option("files", o.files, "pictures, row by row")->required()->option_text("FILE");
    addOut(app, o.out, "PNG");
    app->add_option("--columns", o.columns, "images side by side")
        ->check(CLI::Range(1, 100))
        ->option_text("N");
    app->add_option("--width", o.widthPx, "width of each image in pixels")
        ->check(CLI::Range(1, 8192))
        ->option_text("PX");
    app->callback([&] { command = [&] { return imageSheet(o); }; });
}

}  // namespace

void requireNoInput(const std::string& out, std::span<const std::string> inputs,
                    std::string_view option) {
    for (const std::string& input : inputs) {
        std::error_code isAbsent;
        if (std::filesystem::equivalent(out, input, isAbsent)) {
            throw UsageError(std::string(option) + " " + out + " is the input " + input +
                             "; allowed: another file");
        }
    }
}

void addImageCommands(CLI::App& app, ImageCommandOptions& options, std::function<int()>& command) {
    CLI::App* image =
        app.add_subcommand("image", "diff, convert, crop, contact-sheet, info of pictures");
    image->require_subcommand(1);
    addDiff(*image, options.diff, command);
    addConvert(*image, options.convert, command);
    addCrop(*image, options.crop, command);
    addSheet(*image, options.sheet, command);
    CLI::App* info = image->add_subcommand("info", "size, channels and attributes of a file");
    addFile(info, "file", options.file, image::readEndings());
    info->callback([&] { command = [&] { return imageInfo(options.file); }; });
}

namespace {

const char* nameOf(image::ExrPixelType type) {
    switch (type) {
        case image::ExrPixelType::Half:
            return "half";
        case image::ExrPixelType::Float:
            return "float";
        case image::ExrPixelType::Uint:
            break;
    }
    return "uint";
}

void printChannel(const image::ExrImage::Channel& channel) {
    double sum = 0.0;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::size_t finite = 0;
    for (const float value : channel.values.values()) {
        if (!std::isfinite(value)) continue;
        ++finite;
        sum += double{value};
        low = std::min(low, value);
        high = std::max(high, value);
    }
    say("channel {:<10} {:<5}", channel.name, nameOf(channel.type));
    if (finite > 0) say(" {:g} to {:g}, mean {:g}", low, high, sum / static_cast<double>(finite));
    if (const std::size_t others = channel.values.values().size() - finite; others > 0) {
        say(" ({} not finite)", others);
    }
    say("\n");
}

}  // namespace

int imageInfo(const std::string& file) {
    const std::string_view format = image::formatOf(file);
    if (format != "exr") {
        const image::Picture picture = image::readPicture(file);
        const int channels = picture.stored.channels();
        say("{} {}x{}, {} {}, {}\n", format, picture.width, picture.height, channels,
            channels == 1 ? "channel" : "channels", picture.isLinear ? "linear" : "sRGB");
        for (const std::string& note : picture.notes) say("{}\n", note);
        return kExitOk;
    }
    const image::ExrImage exr = image::readExr(file);
    const auto [left, top, width, height] = exr.dataWindow();
    const image::Rectangle display = exr.shownWindow();
    say("exr {}x{}\ndata window {}x{} from ({}, {}), display window {}x{} from ({}, {})\n", width,
        height, width, height, left, top, display.width, display.height, display.left, display.top);
    for (const image::ExrImage::Channel& channel : exr.channels) printChannel(channel);
    for (const auto& [name, text] : exr.attributes) say("{}: {}\n", name, text);
    for (const auto& [name, matrix] : exr.matrices) {
        say("{}: {}\n", name, fmt::format("{:.6g}", fmt::join(matrix, " ")));
    }
    for (const std::string& note : exr.notes) say("{}\n", note);
    return kExitOk;
}

namespace {

/// Says what reading changed, and what it left out.
image::Picture readTelling(const std::string& file) {
    image::Picture picture = image::readPicture(file);
    for (const std::string& note : picture.notes) tell("{}: {}\n", file, note);
    return picture;
}

/// Of a picture that is to be shown, also of which part it is.
image::ImageF shownTelling(const std::string& file) {
    image::Picture picture = readTelling(file);
    if (!picture.isWhole()) tell("{}: {}\n", file, image::placeOf(picture));
    return std::move(picture.linear);
}

struct Pair {
    image::Picture reference, test;
    bool isLinear() const { return reference.isLinear; }
};

Pair readPair(const ImageDiffOptions& options) {
    if (!options.out.empty()) image::isExrFile(options.out);
    Pair pair{readTelling(options.reference), readTelling(options.test)};
    if (pair.test.isLinear != pair.isLinear()) {
        throw UsageError(
            fmt::format("image diff: {} and {} are of different kinds: one is linear, as EXR files "
                        "are, the other "
                        "sRGB, as PNG files are",
                        options.reference, options.test));
    }
    image::keepCommon(pair.reference, pair.test);
    metrics::requireComparable(pair.reference.stored, pair.test.stored);
    metrics::requireFlipSize(pair.reference.stored);
    if (!pair.reference.isWhole()) tell("compared are {}\n", image::placeOf(pair.reference));
    return pair;
}

bool usesHdrFlip(const ImageDiffOptions& options, const Pair& pair) {
    if (options.flip != "auto") return options.flip == "hdr";
    return pair.isLinear() && (metrics::exceedsDisplay(pair.reference.linear) ||
                               metrics::exceedsDisplay(pair.test.linear));
}

ImageF flipMapOf(const ImageDiffOptions& options, const Pair& pair) {
    const ImageF reference = image::rgbOf(pair.reference.linear);
    const ImageF test = image::rgbOf(pair.test.linear);
    return usesHdrFlip(options, pair) ? metrics::hdrFlipMap(reference, test)
                                      : metrics::flipMap(reference, test);
}

/// Structural similarity has no value for smaller images.
constexpr int kLeastSsimPx = 11;

std::vector<std::pair<std::string, double>> differencesOf(const ImageDiffOptions& options,
                                                          const Pair& pair,
                                                          std::optional<ImageF>& flipMap) {
    const ImageF& a = pair.reference.stored;
    const ImageF& b = pair.test.stored;
    const auto isWanted = [&](const char* name) {
        return options.metrics.empty() || std::find(options.metrics.begin(), options.metrics.end(),
                                                    name) != options.metrics.end();
    };
    const bool fitsSsim = a.width() >= kLeastSsimPx && a.height() >= kLeastSsimPx;
    std::vector<std::pair<std::string, double>> values;
    if (isWanted("mse")) values.emplace_back("mse", metrics::meanSquaredError(a, b));
    if (isWanted("psnr")) values.emplace_back("psnr_db", metrics::peakSignalToNoiseDb(a, b));
    if (isWanted("ssim") && (fitsSsim || !options.metrics.empty())) {
        values.emplace_back("ssim", metrics::structuralSimilarity(a, b));
    }
    if (isWanted("flip")) {
        flipMap = flipMapOf(options, pair);
        values.emplace_back(usesHdrFlip(options, pair) ? "hdr_flip" : "flip",
                            metrics::meanOfFlip(*flipMap));
    }
    if (isWanted("max")) values.emplace_back("max", metrics::maxAbsoluteError(a, b));
    return values;
}

/// The map's numbers: gain · (reference − test) or its magnitude a channel, or FLIP.
ImageF numbersOf(const ImageDiffOptions& options, const Pair& pair, const ImageF* flipMap) {
    if (flipMap != nullptr) return *flipMap;
    const auto gain = static_cast<float>(options.gain);
    if (options.map == "abs") {
        return metrics::absoluteDifference(pair.reference.stored, pair.test.stored, gain);
    }
    ImageF difference = pair.reference.stored;
    for (std::size_t i = 0; i < difference.values().size(); ++i) {
        difference.values()[i] = gain * (difference.values()[i] - pair.test.stored.values()[i]);
    }
    return difference;
}

/// Differences of what is compared above: linear light, or displayed values of sRGB files.
image::Image8 diffPicture(const ImageDiffOptions& options, const Pair& pair,
                          const ImageF* flipMap) {
    if (flipMap != nullptr) return metrics::flipPicture(*flipMap);
    const auto draw =
        options.map == "abs" ? metrics::absoluteErrorPicture : metrics::signedErrorPicture;
    return draw(pair.reference.linear, pair.test.linear, static_cast<float>(options.gain),
                pair.isLinear() ? metrics::ErrorOf::Linear : metrics::ErrorOf::Displayed);
}

void writeMap(const ImageDiffOptions& options, const Pair& pair, std::optional<ImageF> flipMap) {
    if (options.map == "flip" && !flipMap) flipMap = flipMapOf(options, pair);
    const ImageF* flip = options.map == "flip" ? &*flipMap : nullptr;
    if (!image::isExrFile(options.out)) {
        image::writePng(options.out, diffPicture(options, pair, flip));
        return;
    }
    static const std::vector<std::string> kNames[] = {
        {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const ImageF numbers = numbersOf(options, pair, flip);
    image::ExrImage exr;
    exr.add(numbers, kNames[numbers.channels()], image::ExrPixelType::Float);
    exr.attributes["reference"] = options.reference;
    exr.attributes["test"] = options.test;
    exr.attributes["map"] = options.map;
    exr.attributes["gain"] = flip ? "1" : fmt::format("{:g}", options.gain);
    image::writeExr(options.out, exr);
}

}  // namespace

int imageDiff(const ImageDiffOptions& options) {
    if (!options.out.empty()) {
        const std::string inputs[] = {options.reference, options.test};
        requireNoInput(options.out, inputs);
    }
    const Pair pair = readPair(options);
    std::optional<ImageF> flipMap;
    const auto values = differencesOf(options, pair, flipMap);
    if (options.asJson) {
        nlohmann::ordered_json json;
        for (const auto& [name, value] : values) {
            json[name] = std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
        }
        fmt::print("{}\n", json.dump(2));
    } else {
        for (const auto& [name, value] : values) fmt::print("{} {:.6g}\n", name, value);
    }
    if (!options.out.empty()) writeMap(options, pair, std::move(flipMap));
    return kExitOk;
}

namespace {

/// Times a power of two, and no less than 0 nor more than 1.
Image8 shown(const ImageF& linear, const ImageConvertOptions& options) {
    const auto stops = static_cast<float>(options.exposureStops);
    return image::toSrgb8(
        image::toneMapped(image::withStraightAlpha(linear), stops, image::ToneMap::None));
}

/// Of values as they are: a half ends at 65504.
ExrImage exrOf(const ImageF& image) {
    static const std::vector<std::string> kNames[] = {
        {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    ExrImage exr;
    exr.add(image, kNames[image.channels()], image::ExrPixelType::Float);
    return exr;
}

ExrImage exrTelling(const std::string& file) {
    ExrImage exr = image::readExr(file);
    for (const std::string& note : exr.notes) tell("{}: {}\n", file, note);
    return exr;
}

ExrImage exrFrom(const ImageConvertOptions& options) {
    ExrImage exr = image::formatOf(options.in) == "exr" ? exrTelling(options.in)
                                                        : exrOf(readTelling(options.in).linear);
    const auto scale = static_cast<float>(std::exp2(options.exposureStops));
    for (ExrImage::Channel& channel : exr.channels) {
        const bool isColour = channel.name == "R" || channel.name == "G" || channel.name == "B" ||
                              channel.name == "Y";
        if (!isColour) continue;
        if (scale == 1.0F) continue;
        channel.type = image::ExrPixelType::Float;
        for (float& value : channel.values.values()) value *= scale;
    }
    return exr;
}

template <class T>
image::Image<T> quantized(const ImageF& unit) {
    constexpr auto kMost = static_cast<float>(std::numeric_limits<T>::max());
    image::Image<T> result(unit.width(), unit.height(), unit.channels());
    std::ranges::transform(unit.values(), result.values().begin(),
                           [](float value) { return static_cast<T>(value * kMost + 0.5F); });
    return result;
}

/// Values of sRGB as they are.
void writeAsStored(const std::string& path, const ImageF& stored, int bits) {
    if (bits == 16) {
        image::writePng(path, quantized<std::uint16_t>(stored));
    } else {
        image::writePng(path, quantized<std::uint8_t>(stored));
    }
}

}  // namespace

int imageConvert(const ImageConvertOptions& options) {
    requireNoInput(options.out, {&options.in, 1});
    if (image::isExrFile(options.out)) {
        image::writeExr(options.out, exrFrom(options));
        return kExitOk;
    }
    if (image::formatOf(options.in) == "exr") {
        image::writePng(options.out, shown(shownTelling(options.in), options));
        return kExitOk;
    }
    const image::Picture picture = readTelling(options.in);
    if (picture.isLinear || options.exposureStops != 0.0) {
        image::writePng(options.out, shown(picture.linear, options));
    } else {
        writeAsStored(options.out, picture.stored, picture.bits);
    }
    return kExitOk;
}

int imageCrop(const ImageCropOptions& options) {
    const bool isExr = image::formatOf(options.in) == "exr";
    image::Picture picture;
    if (!isExr) picture = readTelling(options.in);
    if (image::isExrFile(options.out) != (isExr || picture.isLinear)) {
        throw UsageError(
            fmt::format("image crop: {} and {} are of different kinds; 'image "
                        "convert' makes one of the other",
                        options.in, options.out));
    }
    requireNoInput(options.out, {&options.in, 1});
    image::Rectangle part{options.left, options.top, options.width, options.height};
    if (isExr || picture.isLinear) {
        const ExrImage exr = isExr ? exrTelling(options.in) : exrOf(picture.linear);
        // Counted from the corner of what is shown.
        part.left += exr.shownWindow().left - exr.dataWindow().left;
        part.top += exr.shownWindow().top - exr.dataWindow().top;
        image::writeExr(options.out, image::cropped(exr, part, options.scale));
    } else {
        writeAsStored(options.out, image::cropped(picture.stored, part, options.scale),
                      picture.bits);
    }
    return kExitOk;
}

int imageSheet(const ImageSheetOptions& options) {
    if (image::isExrFile(options.out)) {
        throw UsageError(options.out + ": a contact sheet is a .png");
    }
    requireNoInput(options.out, options.files);
    std::vector<image::Image8> images;
    for (const std::string& file : options.files) {
        images.push_back(image::toSrgb8(image::withStraightAlpha(shownTelling(file))));
    }
    image::SheetLayout layout;
    layout.columns = options.columns;
    layout.cellWidthPx = options.widthPx;
    image::writePng(options.out, image::contactSheet(images, layout, options.files));
    const auto columns = std::min(static_cast<std::size_t>(options.columns), options.files.size());
    for (std::size_t i = 0; i < options.files.size(); ++i) {
        say("row {} column {}  {}\n", i / columns + 1, i % columns + 1, options.files[i]);
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
