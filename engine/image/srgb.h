// The transfer curve of sRGB, both ways.
#pragma once

#include <array>

#include "engine/image/image.h"

namespace gfxrepro::image {

/// Linear in [0, 1] to sRGB (IEC 61966-2-1).
float srgbOf(float linear);
/// And back.
float linearOf(float srgb);
/// sRGB to linear for every 8-bit value.
std::array<float, 256> srgbDecoding();

// What a display shows of light without bounds.

enum class ToneMap {
    None,  // what is above 1 is clamped
    Aces,  // a curve a channel that looks like film
};

/// (n2·x² + n1·x) / (d2·x² + d1·x + d0): Narkowicz 2015, "ACES Filmic Tone Mapping Curve", for x
/// that is not exposed by 0.6 before, as Andersson et al. 2021 have it.
struct AcesCurve {
    double n2 = 0.6 * 0.6 * 2.51;
    double n1 = 0.6 * 0.03;
    double d2 = 0.6 * 0.6 * 2.43;
    double d1 = 0.6 * 0.59;
    double d0 = 0.14;
};

/// Colours divided by their alpha, the second of two channels or the fourth of four, as PNG files
/// have them; what has no alpha stays.
ImageF withStraightAlpha(ImageF premultiplied);

/// 2^exposure times the image, mapped to [0, 1], still linear. Negative values count as 0; alpha
/// stays.
ImageF toneMapped(const ImageF& linear, float exposureStops, ToneMap toneMap);

}  // namespace gfxrepro::image
