// PNG files (libpng).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "runner/image/image.h"

namespace gfxrepro::image {

/// 8-bit values, 1 to 4 channels; palettes and lower depths are expanded, 16-bit is an Error.
/// Throws Error with the path and the decoder's reason; the memory stays bounded by what the header
/// declares, which may be at most 32768² pixels, and by 2,000 times the file's size.
Image8 readPng8(const std::filesystem::path& path);
/// 16-bit values; 8-bit files are widened (v·257).
Image16 readPng16(const std::filesystem::path& path);
/// From memory; `name` stands in messages.
Image8 decodePng8(std::span<const std::byte> bytes, const std::string& name);

void writePng(const std::filesystem::path& path, const Image8& image);
void writePng(const std::filesystem::path& path, const Image16& image);
/// Encoded in memory, for reports that carry their images inside.
std::string encodePng(const Image8& image);

}  // namespace gfxrepro::image
