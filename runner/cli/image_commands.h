// `gfxrepro image …`: options in, exit code out.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gfxrepro::cli {

struct ImageDiffOptions {
    std::string reference;
    std::string test;
    std::vector<std::string> metrics;  // mse, psnr, ssim, flip, max; none: all that apply
    std::string flip = "auto";         // auto | ldr | hdr
    std::string out;
    std::string map = "abs";  // abs | signed | flip
    double gain = 1.0;
    bool asJson = false;
};

struct ImageConvertOptions {
    std::string in;
    std::string out;
    double exposureStops = 0.0;
    std::string toneMap = "none";  // none | reinhard | aces
    std::string channels;          // "Z" or "N.X,N.Y,N.Z"; empty: the colours
    std::string range;             // "low,high" of one channel
    std::string colours = "auto";  // auto | magma | grey | cool_warm
};

struct ImageCropOptions {
    std::string in;
    std::string out;
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
    int scale = 1;
};

struct ImageSheetOptions {
    std::string out;
    std::vector<std::string> files;
    int columns = 4;
    int widthPx = 256;
};

struct ImageCommandOptions {
    ImageDiffOptions diff;
    ImageConvertOptions convert;
    ImageCropOptions crop;
    ImageSheetOptions sheet;
    std::string file;  // of info
};

int imageDiff(const ImageDiffOptions& options);
int imageConvert(const ImageConvertOptions& options);
int imageCrop(const ImageCropOptions& options);
int imageSheet(const ImageSheetOptions& options);
int imageInfo(const std::string& file);

/// Adds them to the program's; `command` becomes the one that was chosen.
void addImageCommands(CLI::App& app, ImageCommandOptions& options, std::function<int()>& command);

/// Throws UsageError where `out` is one of the files that are read.
void requireNoInput(const std::string& out, std::span<const std::string> inputs,
                    std::string_view option = "--out");

}  // namespace gfxrepro::cli
