// Many images on one.
#pragma once

#include <span>
#include <string>

#include "engine/image/image.h"

namespace gfxrepro::image {

struct SheetLayout {
    int columns = 4;
    int cellWidthPx = 256;  // images are resized to this
    int gapPx = 8;          // around and between
};

/// Row by row, each image at the top of its cell, grey between; a row is as high as its highest
/// image. 1, 3 or 4 channels; alpha is laid over the grey. `captions`, one an image or none at all,
/// stand above the images: of longer ones the end. Throws Error for no images, layouts without a
/// size, and sheets beyond 32768 pixels a side.
Image8 contactSheet(std::span<const Image8> images, const SheetLayout& layout,
                    std::span<const std::string> captions = {});

}  // namespace gfxrepro::image
