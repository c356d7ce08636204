#include "runner/cli/image_commands.h"

#include <CLI/CLI.hpp>

namespace gfxrepro::cli {

namespace {

void addDiff(CLI::App& image, ImageDiffOptions& o, std::function<int()>& command) {
    CLI::App* app = image.add_subcommand("diff", "errors of an image, and their map");
    app->add_option("reference", o.reference, "EXR (linear) or PNG (sRGB as stored)")->required();
    app->add_option("test", o.test, "of the same kind")->required();
    app->add_option("--metric", o.metrics, "mse, psnr, ssim, flip, max (default: all that apply)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"mse", "psnr", "ssim", "flip", "max"}));
    app->add_option("--flip", o.flip, "auto | ldr | hdr; auto: hdr for EXR with values above 1")
        ->check(CLI::IsMember({"auto", "ldr", "hdr"}));
    app->add_option("--out", o.out, "write the error map: .png to look at, .exr its numbers");
    app->add_option("--map", o.map, "abs | signed (red: test too dark) | flip")
        ->check(CLI::IsMember({"abs", "signed", "flip"}));
    app->add_option("--gain", o.gain, "of the abs and signed maps")->check(CLI::Range(1e-6, 1e6));
    app->add_flag("--json", o.asJson, "machine-readable");
    app->callback([&] { command = [&] { return imageDiff(o); }; });
}

void addConvert(CLI::App& image, ImageConvertOptions& o, std::function<int()>& command) {
    CLI::App* app = image.add_subcommand("convert", "EXR to PNG and back; one channel in colours");
    app->add_option("in", o.in, "EXR or PNG")->required();
    app->add_option("out", o.out, "EXR or PNG")->required();
    app->add_option("--exposure", o.exposureStops, "stops: colours times 2^s")
        ->check(CLI::Range(-100.0, 100.0));
    app->add_option("--tonemap", o.toneMap, "none (clamps) | reinhard | aces")
        ->check(CLI::IsMember({"none", "reinhard", "aces"}));
    app->add_option("--channels", o.channels, "Z: in false colours; N.X,N.Y,N.Z: as 0.5 + 0.5 n");
    app->add_option("--range", o.range, "low,high of one channel (default: all of it)");
    app->add_option("--colours", o.colours, "magma | grey | cool_warm")
        ->check(CLI::IsMember({"magma", "grey", "cool_warm"}));
    app->callback([&] { command = [&] { return imageConvert(o); }; });
}

void addCropAndSheet(CLI::App& image, ImageCommandOptions& o, std::function<int()>& command) {
    CLI::App* crop = image.add_subcommand("crop", "a part, its pixels magnified");
    crop->add_option("in", o.crop.in, "EXR (all channels stay) or PNG")->required();
    crop->add_option("out", o.crop.out, "of the same kind")->required();
    crop->add_option("x", o.crop.left, "first column")->required();
    crop->add_option("y", o.crop.top, "first row from the top")->required();
    crop->add_option("width", o.crop.width, "pixels")->required();
    crop->add_option("height", o.crop.height, "pixels")->required();
    crop->add_option("--scale", o.crop.scale, "pixels across of each pixel");
    crop->callback([&] { command = [&] { return imageCrop(o.crop); }; });

    CLI::App* sheet = image.add_subcommand("contact-sheet", "many images on one PNG");
    sheet->add_option("out", o.sheet.out, "PNG")->required();
    sheet->add_option("files", o.sheet.files, "EXR or PNG, row by row")->required();
    sheet->add_option("--columns", o.sheet.columns, "images side by side")
        ->check(CLI::Range(1, 100));
    sheet->add_option("--width", o.sheet.widthPx, "pixels of an image")->check(CLI::Range(1, 8192));
    sheet->callback([&] { command = [&] { return imageSheet(o.sheet); }; });
}

}  // namespace

void addImageCommands(CLI::App& app, ImageCommandOptions& options, std::function<int()>& command) {
    CLI::App* image =
        app.add_subcommand("image", "diff, convert, crop, contact-sheet, info: EXR and PNG files");
    image->require_subcommand(1);
    addDiff(*image, options.diff, command);
    addConvert(*image, options.convert, command);
    addCropAndSheet(*image, options, command);
    CLI::App* info = image->add_subcommand("info", "size, channels and attributes of a file");
    info->add_option("file", options.file, "EXR or PNG")->required();
    info->callback([&] { command = [&] { return imageInfo(options.file); }; });
}

}  // namespace gfxrepro::cli
