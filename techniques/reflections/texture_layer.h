// Textures of any size as layers of one array.
#pragma once

#include <array>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::reflections {

/// What the first three channels of a texture are.
enum class TexelKind {
    Colours,  // sRGB
    Values,   // as they are: roughness and metalness, normals
};

/// From the 256 values of a channel to linear ones, 0 to 1.
std::array<float, 256> decodingOf(TexelKind kind);

/// An image (3 or 4 channels) as a square of `sizePx` with 4: each texel is the mean (of colours in
/// linear light) of the part of the image that it covers. The same size stays as it is.
image::Image8 textureLayer(const image::Image8& image, int sizePx,
                           TexelKind kind = TexelKind::Colours);

/// The same at half the width and height: each texel is the mean of four. The image has 4 channels
/// and an even size.
image::Image8 halvedLayer(const image::Image8& layer, TexelKind kind = TexelKind::Colours);

}  // namespace gfxrepro::reflections
