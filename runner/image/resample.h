// Images of other sizes.
#pragma once

#include "runner/image/image.h"

namespace gfxrepro::image {

/// The means of blocks of factor² pixels; both sides are multiples of `factor`.
ImageF averaged(const ImageF& image, int factor);

}  // namespace gfxrepro::image
