// Images by their file names: .exr or .png.
#pragma once

#include <filesystem>

#include "engine/image/image.h"

namespace gfxrepro::image {

/// Throws UsageError for any other ending.
bool isExrFile(const std::filesystem::path& path);

/// The values as they are stored: of an EXR file its colour, linear; of a PNG file of 8 or 16 bits
/// sRGB in [0, 1]. Throws Error as the decoders do.
ImageF readStored(const std::filesystem::path& path);
/// The same as linear light: a PNG file's values are decoded, but for alpha.
ImageF readLinear(const std::filesystem::path& path);

}  // namespace gfxrepro::image
