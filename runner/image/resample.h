// Images of other sizes.
#pragma once

#include "runner/image/image.h"

namespace gfxrepro::image {

/// The means of blocks of factor² pixels; both sides are multiples of `factor`.
ImageF averaged(const ImageF& image, int factor);

/// For looking only: the means of blocks of factor² values as they are stored, the blocks at the
/// right and lower edges cut.
Image8 reduced(const Image8& image, int factor);

}  // namespace gfxrepro::image
