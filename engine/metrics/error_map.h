// Pictures of the errors of an image, for people.
#pragma once

#include "engine/image/image.h"

namespace gfxrepro::metrics {

/// Which values are subtracted.
enum class ErrorOf {
    Displayed,  // sRGB in [0, 1], what a display cannot show clamped: what a person compares
    Linear,     // as they are: differences in the light above 1 count, too
};

/// gain · (reference − test), the mean of the colour channels (alpha is left out), from −1 to 1:
/// grey where the two are equal, red where the test is too dark, blue where it is too bright. Both
/// images are linear. Throws Error as requireComparable() does, and for a gain that is not
/// positive.
image::Image8 signedErrorPicture(const image::ImageF& reference, const image::ImageF& test,
                                 float gain = 1.0F, ErrorOf values = ErrorOf::Displayed);
/// The channels of gain · |reference − test|, clamped to [0, 1] and written as they are: black
/// where the two are equal.
image::Image8 absoluteErrorPicture(const image::ImageF& reference, const image::ImageF& test,
                                   float gain = 1.0F, ErrorOf values = ErrorOf::Displayed);
/// A map of flipMap() as its authors show it: magma, black for 0 and pale yellow for 1.
image::Image8 flipPicture(const image::ImageF& map);

}  // namespace gfxrepro::metrics
