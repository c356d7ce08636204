// Textures of any size as layers of one array.
#pragma once

#include "runner/image/image.h"

namespace gfxrepro::reflections {

/// An sRGB image (3 or 4 channels) as a square of `sizePx` with 4: each texel is the mean, in
/// linear light, of the part of the image that it covers. The same size stays as it is.
image::Image8 textureLayer(const image::Image8& image, int sizePx);

}  // namespace gfxrepro::reflections
