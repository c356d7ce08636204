// Captions of pictures.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/image/image.h"

namespace gfxrepro::image {

/// Pixels of a letter with the gap behind it, and of a line.
inline constexpr int kLetterWidthPx = 6, kLetterHeightPx = 7;

/// Draws one line of ASCII from its upper left corner on, letters of 5 × 7 pixels, in all channels;
/// other bytes are drawn as '?'. What lies beside the picture is not drawn.
void drawText(Image8& image, int leftPx, int topPx, std::string_view text, std::uint8_t value);

}  // namespace gfxrepro::image
