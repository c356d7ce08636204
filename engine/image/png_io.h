// PNG files (libpng).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/image/exr_io.h"
#include "engine/image/image.h"

namespace gfxrepro::image {

/// What a PNG file says of its colours and how it is held, where it is not sRGB from the top: by
/// the standard's precedence cICP, iCCP, sRGB, then gAMA and cHRM.
struct PngColours {
    double gamma = 0.0;                       // light is value^(1 / gamma); 0: by the curve of sRGB
    std::optional<Chromaticities> primaries;  // none: Rec. 709's
    std::span<const std::byte> exif;
    std::vector<std::string> notes;        // what is left out
    std::vector<std::string> notesOfFile;  // likewise, but of no colours
    std::size_t beyondPalette = 0;         // pixels of numbers that its palette has not: black
};
/// A gamma of 1 / 2.2 is the standard's own number for sRGB. Of a broken file: as far as it goes.
PngColours pngColours(std::span<const std::byte> bytes, const std::string& name);

/// What a PNG file says of what it shows, by extensions of the standard.
struct PngPhysics {
    bool hasSize = false;                        // that of a pixel (sCAL)
    std::optional<std::array<float, 2>> pixelM;  // it, along x and y, where it is in metres
    bool hasValues = false;                      // what its values mean (pCAL)
    bool isTurned = false;                       // by its Exif block
};
PngPhysics pngPhysics(std::span<const std::byte> bytes);

/// 8-bit values, 1 to 4 channels; palettes and lower depths are expanded, 16-bit is an Error.
/// Throws Error with the path and the decoder's reason; the memory stays bounded by what the header
/// declares, and that as checkDeclaredSize() says of pictures.
Image8 readPng8(const std::filesystem::path& path);
/// 16-bit values; 8-bit files are widened (v·257).
Image16 readPng16(const std::filesystem::path& path);
/// Of a texture, from memory; `name` stands in messages.
Image8 decodePng8(std::span<const std::byte> bytes, const std::string& name);

/// A PNG file's rows of 16-bit values, one after the other: in memory are a few of them. An
/// interlaced file has no such order, and is decoded whole with its first row.
class PngRows {
  public:
    /// Reads the header. Throws as readPng16() does, of at most `maxSidePx` a side.
    PngRows(const std::filesystem::path& path, std::int64_t maxSidePx,
            ImageUse use = ImageUse::Texture);
    ~PngRows();
    PngRows(PngRows&&) noexcept;

    int width() const;
    int height() const;
    /// With the alpha that a transparent colour adds.
    int channels() const;
    int bitDepth() const;
    bool isInterlaced() const;
    /// width · channels values of the next row; behind the last one the file is read to its end.
    void read(std::uint16_t* values);

  private:
    class Decoder;
    std::unique_ptr<Decoder> decoder_;
};

void writePng(const std::filesystem::path& path, const Image8& image);
void writePng(const std::filesystem::path& path, const Image16& image);
/// Encoded in memory, for reports that carry their images inside.
std::string encodePng(const Image8& image);

}  // namespace gfxrepro::image
