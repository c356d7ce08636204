#include "runner/image/resample.h"

#include "runner/core/error.h"

namespace gfxrepro::image {

ImageF averaged(const ImageF& image, int factor) {
    GFXREPRO_ASSERT(image.width() % factor == 0 && image.height() % factor == 0);
    ImageF result(image.width() / factor, image.height() / factor, image.channels());
    const float weight = 1.0F / static_cast<float>(factor * factor);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < image.channels(); ++c) {
                result.at(x / factor, y / factor, c) += weight * image.at(x, y, c);
            }
        }
    }
    return result;
}

}  // namespace gfxrepro::image
