// Many images on one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/image/image.h"

namespace gfxrepro::image {

// Captions of pictures.

/// Pixels of a letter with the gap behind it, and of a line.
inline constexpr int kLetterWidthPx = 6, kLetterHeightPx = 7;

/// Draws one line of ASCII from its upper left corner on, letters of 5 × 7 pixels, in all channels;
/// other bytes are drawn as '?'. What lies beside the picture is not drawn.
void drawText(Image8& image, int leftPx, int topPx, std::string_view text, std::uint8_t value);

struct SheetLayout {
    int columns = 4;
    int cellWidthPx = 256;  // images are resized to this
    int gapPx = 8;          // around and between
};

/// Row by row, each image at the top of its cell, grey between; a row is as high as its highest
/// image. 1 to 4 channels; alpha is laid over the grey. `captions`, one an image or none at all,
/// stand above the images: of longer ones the end. Throws Error for no images, layouts without a
/// size, and sheets beyond 32768 pixels a side.
Image8 contactSheet(std::span<const Image8> images, const SheetLayout& layout,
                    std::span<const std::string> captions = {});

}  // namespace gfxrepro::image
