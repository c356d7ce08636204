// OpenEXR files: named channels of half, float or whole numbers, with attributes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::image {

enum class ExrPixelType {
    Half,
    Float,
    Uint,  // of 32 bits; in memory as float, which rounds numbers above 2²⁴: a note says so
};

/// Of a display: x and y of its red, green, blue and white.
using Chromaticities = std::array<float, 8>;
constexpr Chromaticities kRec709{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};

constexpr const char* kConvertedPrimaries =
    "R, G, B are converted from its chromaticities to those of Rec. 709";

/// From colours of a display to those of Rec. 709's. White stays what it is: a colour keeps its X,
/// Y, Z.
class ToRec709 {
  public:
    /// Throws Error, which begins with `name`, for chromaticities of no colours.
    ToRec709(const Chromaticities& given, const std::string& name);
    std::array<float, 3> operator()(const std::array<float, 3>& rgb) const;

  private:
    std::array<float, 9> rows_;  // takes row vectors
};

/// Channels of one size, each with its EXR name ("R", "depth.Z", "id"). Values are linear.
struct ExrImage {
    struct Channel {
        std::string name;
        ExrPixelType type = ExrPixelType::Half;
        ImageF values;  // one channel
    };
    std::vector<Channel> channels;
    std::map<std::string, std::string> attributes;  // text metadata: camera, command, case
    /// Attributes of type m44f ("worldToCamera"), row by row; they take row vectors, so that a
    /// matrix of GLM has the same 16 numbers in the same order.
    std::map<std::string, std::array<float, 16>> matrices;

    /// Column and row of the first pixel: where the data window begins.
    int left = 0, top = 0;
    /// What a display shows, in the same columns and rows; none: these pixels.
    std::optional<Rectangle> displayWindow;
    /// What reading did to the values, and which attributes it passed over: a line each.
    std::vector<std::string> notes;

    Rectangle dataWindow() const { return {left, top, width(), height()}; }
    Rectangle shownWindow() const { return displayWindow.value_or(dataWindow()); }
    int width() const { return channels.empty() ? 0 : channels.front().values.width(); }
    int height() const { return channels.empty() ? 0 : channels.front().values.height(); }
    /// Null when there is no such channel.
    const ImageF* find(const std::string& name) const;
    /// Adds image channel by channel under `names` ("R","G","B", …).
    void add(const ImageF& image, const std::vector<std::string>& names,
             ExrPixelType type = ExrPixelType::Half);
    /// R, G, B or Y, with A where it is there, or Z alone. Throws Error when none of these is
    /// there.
    std::vector<std::string> colourNames() const;
    /// These as one image.
    ImageF colour() const;
};

/// Scanline or tiled, any compression that OpenEXR reads, level 0. Luminance and chroma (Y, RY, BY)
/// become R, G, B, and colours of other primaries those of Rec. 709. Attributes of other types than
/// text and m44f are passed over; `notes` names those that might change what is seen. Throws Error
/// with the path and the library's reason, and for a file of several parts; memory is bounded as in
/// png_io.h.
ExrImage readExr(const std::filesystem::path& path);
/// ZIP-compressed scanlines, without the notes, written atomically. Throws Error for what a file
/// cannot hold: channels of different sizes, two of one name, numbers in a Uint channel that are
/// not whole or beyond 2²⁴.
void writeExr(const std::filesystem::path& path, const ExrImage& image);

}  // namespace gfxrepro::image
