// Images by their file names: .exr or .png.
#pragma once

#include <filesystem>
#include <string>

#include "engine/image/image.h"

namespace gfxrepro::image {

/// Throws UsageError for any other ending.
bool isExrFile(const std::filesystem::path& path);

/// What a file shows, of 1 to 4 channels: grey, grey and alpha, RGB, RGB and alpha. Of an EXR file
/// it is what lies in its display window.
struct Picture {
    ImageF stored;  // of a PNG file sRGB in [0, 1], not multiplied by alpha; else as `linear`
    ImageF linear;  // light of Rec. 709's primaries, multiplied by alpha
    bool isLinear = false;
    int width = 0, height = 0;  // of the whole
    Rectangle part;             // that has these pixels: of an EXR file it may be smaller

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
