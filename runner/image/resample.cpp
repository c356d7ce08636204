#include "runner/image/resample.h"

#include <algorithm>

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

Image8 reduced(const Image8& image, int factor) {
    GFXREPRO_ASSERT(factor >= 1);
    const auto blocks = [factor](int sizePx) { return (sizePx + factor - 1) / factor; };
    Image8 result(blocks(image.width()), blocks(image.height()), image.channels());
    for (int y = 0; y < result.height(); ++y) {
        for (int x = 0; x < result.width(); ++x) {
            const int right = std::min((x + 1) * factor, image.width());
            const int below = std::min((y + 1) * factor, image.height());
            const int count = (right - x * factor) * (below - y * factor);
            for (int c = 0; c < image.channels(); ++c) {
                int sum = count / 2;
                for (int v = y * factor; v < below; ++v) {
                    for (int u = x * factor; u < right; ++u) sum += image.at(u, v, c);
                }
                result.at(x, y, c) = static_cast<std::uint8_t>(sum / count);
            }
        }
    }
    return result;
}

}  // namespace gfxrepro::image
