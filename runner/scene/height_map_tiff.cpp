// Height maps from TIFF files (libtiff).
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "runner/core/error.h"
#include "runner/image/limits.h"
#include "runner/scene/height_map_values.h"

namespace gfxrepro::scene {

namespace {

constexpr std::uint32_t kGdalNoData = 42113;

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

class TiffReader {
  public:
    explicit TiffReader(const std::filesystem::path& path) : name_(path.string()) {
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(
            TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepFirstMessage, &message_);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keepReadWarning, &message_);
        tiff_.reset(TIFFOpenExt(name_.c_str(), "r", options.get()));
        if (!tiff_ || !message_.empty()) fail();
        fileBytes_ = std::filesystem::file_size(path);
        readHeader();
    }

    HeightValues values() {
        HeightValues result;
        result.size = {static_cast<int>(width_), static_cast<int>(height_)};
        result.isEightBit = bits_ == 8;
        result.values.resize(std::size_t{width_} * height_);
        if (TIFFIsTiled(tiff_.get()) != 0) {
            readTiles(result.values);
        } else {
            readRows(result.values);
        }
        addNoData(result);
        return result;
    }

  private:
    [[noreturn]] void fail() const {
        throw Error(
            fmt::format("{}: {}", name_, message_.empty() ? "not a whole TIFF file" : message_));
    }

    void readHeader() {
        TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &width_);
        TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &height_);
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_BITSPERSAMPLE, &bits_);
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLEFORMAT, &format_);
        std::uint16_t channels = 1;
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, &channels);
        const bool isInteger = format_ == SAMPLEFORMAT_UINT || format_ == SAMPLEFORMAT_INT;
        if (channels != 1 || !((isInteger && (bits_ == 8 || bits_ == 16)) ||
                               (format_ == SAMPLEFORMAT_IEEEFP && bits_ == 32))) {
            throw Error(
                fmt::format("{}: {} channels of {} bits (sample format {}); allowed: one "
                            "of 8 or 16 bit integers or 32 bit floats",
                            name_, channels, bits_, format_));
        }
        checkHeightMapSize(width_, height_, name_);
        image::checkDeclaredSize(width_, height_, bits_ / 8U, fileBytes_, name_);
    }

    float valueAt(const std::vector<std::byte>& from, std::size_t i) const {
        const std::byte* at = from.data() + i * (bits_ / 8U);
        if (bits_ == 32) {
            float value = 0.0F;
            std::memcpy(&value, at, sizeof value);
            return value;
        }
        std::uint16_t value = 0;
        std::memcpy(&value, at, bits_ / 8U);
        if (bits_ == 8) {
            value = static_cast<std::uint16_t>(*at);
            return format_ == SAMPLEFORMAT_INT ? static_cast<float>(static_cast<std::int8_t>(value))
                                               : static_cast<float>(value);
        }
        return format_ == SAMPLEFORMAT_INT ? static_cast<float>(static_cast<std::int16_t>(value))
                                           : static_cast<float>(value);
    }

    void readRows(std::vector<float>& values) {
        std::vector<std::byte> line(static_cast<std::size_t>(TIFFScanlineSize(tiff_.get())));
        if (line.size() < std::size_t{width_} * (bits_ / 8U)) fail();
        for (std::uint32_t y = 0; y < height_; ++y) {
            if (TIFFReadScanline(tiff_.get(), line.data(), y, 0) != 1) fail();
            for (std::uint32_t x = 0; x < width_; ++x) {
                values[std::size_t{y} * width_ + x] = valueAt(line, x);
            }
        }
    }

    void readTiles(std::vector<float>& values) {
        std::uint32_t tileWidth = 0;
        std::uint32_t tileHeight = 0;
        TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &tileWidth);
        TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &tileHeight);
        image::checkDeclaredSize(tileWidth, tileHeight, bits_ / 8U, fileBytes_, name_ + ": a tile");
        std::vector<std::byte> tile(static_cast<std::size_t>(TIFFTileSize(tiff_.get())));
        if (tile.size() < std::size_t{tileWidth} * tileHeight * (bits_ / 8U)) fail();
        for (std::uint32_t top = 0; top < height_; top += tileHeight) {
            for (std::uint32_t left = 0; left < width_; left += tileWidth) {
                if (TIFFReadTile(tiff_.get(), tile.data(), left, top, 0, 0) < 0) fail();
                for (std::uint32_t y = top; y < std::min(top + tileHeight, height_); ++y) {
                    for (std::uint32_t x = left; x < std::min(left + tileWidth, width_); ++x) {
                        values[std::size_t{y} * width_ + x] =
                            valueAt(tile, std::size_t{y - top} * tileWidth + (x - left));
                    }
                }
            }
        }
    }

    void addNoData(HeightValues& result) {
        if (format_ != SAMPLEFORMAT_UINT) result.noData.push_back(-32768.0F);
        std::uint32_t count = 0;
        const char* text = nullptr;
        if (TIFFGetField(tiff_.get(), kGdalNoData, &count, &text) != 1 || text == nullptr) return;
        const std::string number(text, strnlen(text, count));
        char* end = nullptr;
        const float value = std::strtof(number.c_str(), &end);
        if (end != number.c_str()) result.noData.push_back(value);
    }

    std::string name_;
    std::string message_;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
    std::uintmax_t fileBytes_ = 0;
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    std::uint16_t bits_ = 1;
    std::uint16_t format_ = SAMPLEFORMAT_UINT;
};

}  // namespace

HeightValues readTiffValues(const std::filesystem::path& path) {
    return TiffReader(path).values();
}

}  // namespace gfxrepro::scene
