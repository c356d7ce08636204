// Pictures of files, whichever format they have.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::image {

/// Of a file that is written: .exr, not .png. Throws UsageError for any other ending.
bool isExrFile(const std::filesystem::path& path);

/// The endings of the formats that are read: ".exr, .png, …".
const std::string& readEndings();
/// Whether a name has one of them.
bool hasReadEnding(const std::string& name);

/// exr, png, pfm, hdr, pnm, tga, tiff or jpeg: by what a file begins with, else by its ending.
/// Throws Error where it is none of them.
std::string_view formatOf(const std::filesystem::path& path);

/// What a file shows, of 1 to 4 channels: grey, grey and alpha, RGB, RGB and alpha. Of an EXR file
/// it is what lies in its display window. EXR, PFM, HDR and TIFF of floats are linear; PNG, PNM,
/// TGA, JPEG and other TIFF are sRGB. A PNG file's gamma and primaries are converted to sRGB's;
/// other colour profiles than those of sRGB are not read. PNG and JPEG are turned as their Exif
/// says.
struct Picture {
    ImageF stored;  // sRGB in [0, 1], not multiplied by alpha; of a linear file as `linear`
    ImageF linear;  // light of Rec. 709's primaries, multiplied by alpha
    bool isLinear = false;
    int bits = 8;                    // of a value of sRGB: 8 or 16
    int width = 0, height = 0;       // of the whole
    Rectangle part;                  // that has these pixels: of an EXR file it may be smaller
    std::vector<std::string> notes;  // what reading changed, and what it left out

    bool isWhole() const { return part == Rectangle{0, 0, width, height}; }
};
/// Throws Error as the decoders do, and where an EXR file has no pixel in its display window.
Picture readPicture(const std::filesystem::path& path);

/// Leaves of both the pixels that both have. Throws Error with both places where they have none,
/// or are parts of wholes of different sizes.
void keepCommon(Picture& a, Picture& b);

/// "4x4 pixels from (2, 2) of 8x8"
std::string placeOf(const Picture& picture);

}  // namespace gfxrepro::image
