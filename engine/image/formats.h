// Formats of pictures that programs leave, beside EXR and PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/image.h"

struct tiff;

namespace gfxrepro::image {

/// Values of 1 to 4 channels.
struct Decoded {
    ImageF values;
    bool isLinear = false;  // light, multiplied by alpha; else sRGB in [0, 1] beside its alpha
    int bits = 8;           // of a value of sRGB: 8 or 16
    std::vector<std::string> notes = {};  // what reading changed, and what it left out
};

/// Whether a colour profile (ICC), whatever its name, has sRGB's primaries, unless it is of grey,
/// and sRGB's curve, or none of linear light.
bool isProfileOfSrgb(std::span<const std::byte> profile, bool isLinear);
constexpr const char* kProfileLeftOut = "left out: its colour profile";
/// Of a JPEG file's colours.
std::vector<std::string> notesOfJpeg(std::span<const std::byte> bytes);

/// Of how many pixels are as long across and down.
void noteAspect(double across, double down, std::vector<std::string>& notes);
/// Of what stands behind a picture, but for blanks and zeros.
void noteBehind(std::span<const std::byte> behind, std::vector<std::string>& notes);

/// As the tags of an Exif block say that it is to be seen.
ImageF turnedAsExif(const ImageF& image, std::span<const std::byte> exif);
/// Orientation of an Exif block: 1 … 8, 1 where it says nothing.
int orientationOf(std::span<const std::byte> exif);

/// Of `count` bytes from `at` on, the first being the lowest or the highest; what is not there is
/// left out.
std::size_t numberAt(std::span<const std::byte> bytes, std::size_t at, std::size_t count,
                     bool isLittle);
std::string_view textOf(std::span<const std::byte> bytes);

/// What to say of a file that lacks bytes of a part ("row 3"; it may be empty).
std::string endsEarly(std::string_view part, std::uint64_t from, std::uint64_t needed,
                      std::uint64_t found);

// Each throws Error, which begins with `name`, for what it does not read; memory is bounded as in
// png_io.h.

/// JPEG of 8 bits a channel, and what else stb_image reads; it rounds 16 bits to 8.
Image8 decodeByStb(std::span<const std::byte> bytes, const std::string& name,
                   ImageUse use = ImageUse::Texture);

/// sRGB of 8 bits. A file that ends early is refused.
Decoded decodeJpeg(std::span<const std::byte> bytes, const std::string& name);
/// sRGB: PBM, PGM and PPM, in text or binary, of up to 16 bits. Linear: PFM, rows from the bottom.
Decoded decodeNetpbm(std::span<const std::byte> bytes, const std::string& name);
/// Radiance's HDR, linear: divided by its EXPOSURE and COLORCORR.
Decoded decodeHdr(std::span<const std::byte> bytes, const std::string& name);
/// sRGB: grey, RGB or RGBA of 8 bits, run-length encoded or not.
Decoded decodeTga(std::span<const std::byte> bytes, const std::string& name);
/// sRGB of 8 or 16 bits, or linear floats of 16 or 32, in strips or tiles. Of several pages those
/// that are reductions of the first are passed over.
Decoded readTiff(const std::filesystem::path& path);

/// Rows from the bottom become rows from the top, and back.
void flipRows(ImageF& image);

/// Opened for reading, not mapped. The first error, or warning of a failed read, goes to `message`,
/// which stays where it is meanwhile. Throws Error.
std::unique_ptr<tiff, void (*)(tiff*)> openTiff(const std::filesystem::path& path,
                                                std::string& message);
/// Throws Error of a strip or tile that cannot be read: it ends early, or libtiff's own message.
[[noreturn]] void failInPart(tiff& file, const std::filesystem::path& path, std::uint32_t number,
                             const std::string& message);
/// Of several pages all but the first must be reductions of it. Throws Error.
void requireOnePage(tiff& file, const std::filesystem::path& path, const std::string& message);

}  // namespace gfxrepro::image
