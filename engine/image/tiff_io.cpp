// TIFF files (libtiff).
#include <Imath/half.h>
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/image/formats.h"

namespace gfxrepro::image {
namespace {

int keepFirstMessage(TIFF*, void* to, const char*, const char* format, va_list arguments) {
    auto& message = *static_cast<std::string*>(to);
    if (!message.empty()) return 1;
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    message = text;
    return 1;
}

/// Unknown tags, which GeoTIFF is full of, are no harm. A tag that lies beyond the end of the file
/// is: it may be the one that says which values are none.
int keepReadWarning(TIFF* tiff, void* to, const char* module, const char* format,
                    va_list arguments) {
    if (std::strstr(format, "IO error") == nullptr) return 1;
    return keepFirstMessage(tiff, to, module, format, arguments);
}

[[noreturn]] void failOf(const std::filesystem::path& path, const std::string& message) {
    throw Error(path.string() + ": " + (message.empty() ? "not a whole TIFF file" : message));
}

class TiffReader {
  public:
    explicit TiffReader(const std::filesystem::path& path)
        : path_(path), tiff_(openTiff(path, message_)) {
        requireOnePage(*tiff_, path_, message_);
        readHeader();
    }

    Decoded read() {
        Decoded result{ImageF(static_cast<int>(width_), static_cast<int>(height_), channels_),
                       isFloat_, bits_ == 8 ? 8 : 16};
        const int planes = isSeparate_ ? channels_ : 1;
        for (int plane = 0; plane < planes; ++plane) {
            if (TIFFIsTiled(tiff_.get()) != 0) {
                readTiles(plane, result.values);
            } else {
                readRows(plane, result.values);
            }
        }
        if (isFromBottom_) flipRows(result.values);
        useAlpha(result.values);
        result.notes = notes_;
        return result;
    }

  private:
    template <class T>
    T field(std::uint32_t tag, T otherwise) {
        T value{};
        return TIFFGetFieldDefaulted(tiff_.get(), tag, &value) == 1 ? value : otherwise;
    }

    void readHeader() {
        width_ = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
        height_ = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
        bits_ = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
        const auto format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        const auto colours = field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, 65535);
        channels_ = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
        isFloat_ = format == SAMPLEFORMAT_IEEEFP;
        isSeparate_ = field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) ==
                      PLANARCONFIG_SEPARATE;
        std::uint16_t extras = 0;
        const std::uint16_t* kinds = nullptr;
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_EXTRASAMPLES, &extras, &kinds);
        const int kind = extras == 1 ? kinds[0] : EXTRASAMPLE_UNSPECIFIED;
        isMultiplied_ = kind == EXTRASAMPLE_ASSOCALPHA;
        if (channels_ % 2 == 0 && kind == EXTRASAMPLE_UNSPECIFIED) {
            notes_.push_back(fmt::format(
                "its channel {}, of which it says no kind, is taken as straight alpha", channels_));
        }
        const bool isOfColours =
            (colours == PHOTOMETRIC_MINISBLACK && (channels_ == 1 || channels_ == 2)) ||
            (colours == PHOTOMETRIC_RGB && (channels_ == 3 || channels_ == 4));
        const bool isOfBits = isFloat_ ? bits_ == 16 || bits_ == 32
                                       : format == SAMPLEFORMAT_UINT && (bits_ == 8 || bits_ == 16);
        if (!isOfColours || !isOfBits) {
            throw Error(fmt::format(
                "{}: {} × {} bits a pixel (sample format {}, photometric {}); allowed: grey or "
                "RGB, with or without alpha, of 8 or 16 bits or 16 or 32 bit floats",
                path_.string(), channels_, bits_, format, colours));
        }
        const auto orientation = field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
        isFromBottom_ = orientation == ORIENTATION_BOTLEFT;
        if (!isFromBottom_ && orientation != ORIENTATION_TOPLEFT) {
            throw Error(
                fmt::format("{}: orientation {}; allowed: 1 (from the top) and 4 (from the "
                            "bottom)",
                            path_.string(), orientation));
        }
        checkDeclaredSize(width_, height_, static_cast<std::size_t>(channels_) * sizeof(float),
                          std::filesystem::file_size(path_), path_.string(), kMaxSidePx,
                          ImageUse::Picture);
        noteColours();
        noteAspect(field<float>(TIFFTAG_XRESOLUTION, 0.0F), field<float>(TIFFTAG_YRESOLUTION, 0.0F),
                   notes_);
    }

    void noteColours() {
        std::uint32_t size = 0;
        const std::byte* profile = nullptr;
        if (TIFFGetField(tiff_.get(), TIFFTAG_ICCPROFILE, &size, &profile) == 1) {
            if (!isProfileOfSrgb({profile, size}, isFloat_)) notes_.emplace_back(kProfileLeftOut);
            return;
        }
        const float* primaries = nullptr;
        const float* white = nullptr;
        const bool hasPrimaries =
            TIFFGetField(tiff_.get(), TIFFTAG_PRIMARYCHROMATICITIES, &primaries) == 1;
        const bool hasWhite = TIFFGetField(tiff_.get(), TIFFTAG_WHITEPOINT, &white) == 1;
        const auto differs = [](const float* given, std::size_t count, std::size_t from) {
            constexpr float kTolerance = 1e-3F;
            for (std::size_t i = 0; i < count; ++i) {
                if (std::abs(given[i] - kRec709[from + i]) > kTolerance) return true;
            }
            return false;
        };
        if ((hasPrimaries && differs(primaries, 6, 0)) || (hasWhite && differs(white, 2, 6))) {
            notes_.emplace_back("left out: its chromaticities");
        }
        const std::uint16_t* curves[3] = {};
        if (TIFFGetField(tiff_.get(), TIFFTAG_TRANSFERFUNCTION, &curves[0], &curves[1],
                         &curves[2]) == 1) {
            notes_.emplace_back("left out: its transfer function");
        }
        constexpr std::size_t kGreyResponseCurve = 291;
        if (hasTag(kGreyResponseCurve)) notes_.emplace_back("left out: its grey response curve");
    }

    /// Also of those that the library passes over, as 291.
    bool hasTag(std::size_t tag) const {
        const MappedFile file(path_);
        const bool isLittle = file.text().starts_with('I');
        const auto number = [&](std::size_t at, std::size_t bytes) {
            return numberAt(file.bytes(), at, bytes, isLittle);
        };
        const bool isClassic = number(2, 2) == 42;  // not of 64 bits
        const std::size_t directory = number(4, 4);
        const std::size_t count = isClassic ? number(directory, 2) : 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (number(directory + 2 + 12 * i, 2) == tag) return true;
        }
        return false;
    }

    float valueAt(const std::byte* at) const {
        if (bits_ == 8) return static_cast<float>(std::to_integer<int>(*at)) / 255.0F;
        if (bits_ == 16) {
            std::uint16_t value = 0;
            std::memcpy(&value, at, sizeof value);
            if (!isFloat_) return static_cast<float>(value) / 65535.0F;
            half number;
            number.setBits(value);
            return number;
        }
        float value = 0.0F;
        std::memcpy(&value, at, sizeof value);
        return value;
    }

    /// `count` pixels of all channels, or of one plane.
    void place(const std::byte* from, std::size_t count, int plane, float* to) const {
        const auto channels = static_cast<std::size_t>(channels_);
        const std::size_t stored = isSeparate_ ? 1 : channels;
        for (std::size_t x = 0; x < count; ++x) {
            for (std::size_t c = 0; c < stored; ++c) {
                to[x * channels + c + static_cast<std::size_t>(plane)] =
                    valueAt(from + (x * stored + c) * (bits_ / 8U));
            }
        }
    }

    std::size_t bytesOf(std::size_t pixels) const {
        return pixels * static_cast<std::size_t>(isSeparate_ ? 1 : channels_) * (bits_ / 8U);
    }

    void readRows(int plane, ImageF& image) {
        std::vector<std::byte> row(static_cast<std::size_t>(TIFFScanlineSize(tiff_.get())));
        if (row.size() < bytesOf(width_)) failOf(path_, message_);
        for (std::uint32_t y = 0; y < height_; ++y) {
            const auto sample = static_cast<std::uint16_t>(plane);
            if (TIFFReadScanline(tiff_.get(), row.data(), y, sample) != 1) {
                failInPart(*tiff_, path_, TIFFComputeStrip(tiff_.get(), y, sample), message_);
            }
            place(row.data(), width_, plane, image.row(static_cast<int>(y)).data());
        }
    }

    void readTiles(int plane, ImageF& image) {
        const auto across = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
        const auto down = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
        checkDeclaredSize(across, down, static_cast<std::size_t>(channels_) * sizeof(float),
                          std::filesystem::file_size(path_), path_.string() + ": a tile");
        std::vector<std::byte> tile(static_cast<std::size_t>(TIFFTileSize(tiff_.get())));
        if (tile.size() < bytesOf(std::size_t{across} * down)) failOf(path_, message_);
        for (std::uint32_t top = 0; top < height_; top += down) {
            for (std::uint32_t left = 0; left < width_; left += across) {
                const auto sample = static_cast<std::uint16_t>(plane);
                if (TIFFReadTile(tiff_.get(), tile.data(), left, top, 0, sample) < 0) {
                    failInPart(*tiff_, path_, TIFFComputeTile(tiff_.get(), left, top, 0, sample),
                               message_);
                }
                for (std::uint32_t y = 0; y < std::min(down, height_ - top); ++y) {
                    place(&tile[y * bytesOf(across)], std::min(across, width_ - left), plane,
                          &image.at(static_cast<int>(left), static_cast<int>(top + y)));
                }
            }
        }
    }

    /// Light is multiplied by alpha, sRGB is not.
    void useAlpha(ImageF& image) const {
        const auto channels = static_cast<std::size_t>(channels_);
        if (!isAlpha(channels - 1, channels) || isMultiplied_ == isFloat_) return;
        for (std::size_t i = 0; i < image.values().size(); i += channels) {
            const float alpha = image.values()[i + channels - 1];
            for (float& value : image.values().subspan(i, channels - 1)) {
                if (isFloat_) {
                    value *= alpha;
                } else if (alpha > 0.0F) {
                    value = std::min(1.0F, value / alpha);
                }
            }
        }
    }

    std::filesystem::path path_;
    std::string message_;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_;
    std::vector<std::string> notes_;
    std::uint32_t width_ = 0, height_ = 0;
    std::uint16_t bits_ = 0;
    int channels_ = 0;
    bool isFloat_ = false, isSeparate_ = false, isMultiplied_ = false, isFromBottom_ = false;
};

}  // namespace

std::unique_ptr<TIFF, void (*)(TIFF*)> openTiff(const std::filesystem::path& path,
                                                std::string& message) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(
        TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepFirstMessage, &message);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keepReadWarning, &message);
    // Not mapped ("m"): what is read of a file need not stay.
    std::unique_ptr<TIFF, void (*)(TIFF*)> file(TIFFOpenExt(path.c_str(), "rm", options.get()),
                                                TIFFClose);
    if (file == nullptr || !message.empty()) failOf(path, message);
    return file;
}

void failInPart(TIFF& file, const std::filesystem::path& path, std::uint32_t number,
                const std::string& message) {
    const std::uint64_t from = TIFFGetStrileOffset(&file, number);
    const std::uint64_t needed = TIFFGetStrileByteCount(&file, number);
    const std::uint64_t size = std::filesystem::file_size(path);
    const std::uint64_t found = size - std::min(from, size);
    const std::string part =
        fmt::format("{} {}", TIFFIsTiled(&file) != 0 ? "tile" : "strip", number);
    if (needed > found) failOf(path, endsEarly(part, from, needed, found));
    failOf(path, message.empty() ? message : part + ": " + message);
}

void requireOnePage(TIFF& file, const std::filesystem::path& path, const std::string& message) {
    int pages = 1;
    while (TIFFReadDirectory(&file) == 1) {
        std::uint32_t kind = 0;
        TIFFGetFieldDefaulted(&file, TIFFTAG_SUBFILETYPE, &kind);
        if ((kind & FILETYPE_REDUCEDIMAGE) == 0) ++pages;
    }
    if (!message.empty() || TIFFSetDirectory(&file, 0) != 1) failOf(path, message);
    if (pages > 1) {
        throw Error(fmt::format("{}: has {} pages; one is allowed", path.string(), pages));
    }
}

Decoded readTiff(const std::filesystem::path& path) {
    return TiffReader(path).read();
}

}  // namespace gfxrepro::image
