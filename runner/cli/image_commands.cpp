#include "runner/cli/image_commands.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::cli {

namespace {

CLI::Option* addFile(CLI::App* app, const char* name, std::string& file, const char* doc) {
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
    CLI::App* app = image.add_subcommand("diff", "errors of an image, and a map of them");
    addFile(app, "reference", o.reference, "the reference: EXR (linear) or PNG (sRGB)");
    addFile(app, "test", o.test, "the image to compare with it, of the same kind");
    app->add_option("--metric", o.metrics,
                    "one or more, separated by commas (default: all that apply)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"mse", "psnr", "ssim", "flip", "max"}))
        ->option_text("mse|psnr|ssim|flip|max");
    addChoice(app, "--flip", o.flip, "auto|ldr|hdr", "auto: hdr for EXR with values above 1");
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
    CLI::App* app = image.add_subcommand("convert", "EXR to PNG and back; one channel in colours");
    addFile(app, "in", o.in, "EXR or PNG");
    addOut(app, o.out, "EXR or PNG");
    app->add_option("--exposure", o.exposureStops, "colours times 2^STOPS")
        ->check(CLI::Range(-100.0, 100.0))
        ->option_text("STOPS");
    addChoice(app, "--tonemap", o.toneMap, "none|reinhard|aces", "none clamps");
    app->add_option("--channels", o.channels,
                    "Z: in false colours; N.X,N.Y,N.Z: as 0.5 + 0.5 n; R,G,B")
        ->option_text("A,B,C");
    app->add_option("--range", o.range, "values shown of one channel (default: all)")
        ->option_text("LOW,HIGH");
    addChoice(app, "--colours", o.colours, "auto|magma|grey|cool_warm",
              "for one channel; auto: cool_warm for values of both signs, else magma");
    app->callback([&] { command = [&] { return imageConvert(o); }; });
}

void addCrop(CLI::App& image, ImageCropOptions& o, std::function<int()>& command) {
    CLI::App* app = image.add_subcommand("crop", "a part of an image, its pixels magnified");
    addFile(app, "in", o.in, "EXR (all channels stay) or PNG");
    addOut(app, o.out, "a file of the same kind");
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
    app->add_option("files", o.files, "EXR or PNG, row by row")->required()->option_text("FILE");
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
        app.add_subcommand("image", "diff, convert, crop, contact-sheet, info for EXR and PNG");
    image->require_subcommand(1);
    addDiff(*image, options.diff, command);
    addConvert(*image, options.convert, command);
    addCrop(*image, options.crop, command);
    addSheet(*image, options.sheet, command);
    CLI::App* info = image->add_subcommand("info", "size, channels and attributes of a file");
    addFile(info, "file", options.file, "EXR or PNG");
    info->callback([&] { command = [&] { return imageInfo(options.file); }; });
}

}  // namespace gfxrepro::cli
