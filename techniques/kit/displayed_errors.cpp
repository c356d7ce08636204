#include "techniques/kit/displayed_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/srgb.h"

namespace gfxrepro::kit {

glm::dvec3 channelErrors(const image::ImageF& picture, const image::ImageF& truth,
                         const std::vector<std::uint8_t>* wanted) {
    const image::Image8 a = image::toSrgb8(picture);
    const image::Image8 b = image::toSrgb8(truth);
    GFXREPRO_ASSERT_EQ(a.values().size(), b.values().size());
    const std::size_t pixels = a.values().size() / 3;
    glm::dvec3 sum(0.0);
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        if (wanted && (*wanted)[pixel] == 0) continue;
        ++count;
        for (std::size_t c = 0; c < 3; ++c) {
            sum[static_cast<int>(c)] +=
                std::abs(int{a.values()[3 * pixel + c]} - int{b.values()[3 * pixel + c]});
        }
    }
    return count == 0 ? sum : sum / static_cast<double>(count);
}

double shownPsnrDb(const image::ImageF& picture, const image::ImageF& truth) {
    const image::Image8 a = image::toSrgb8(picture);
    const image::Image8 b = image::toSrgb8(truth);
    double squares = 0.0;
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        const double difference = (int{a.values()[i]} - int{b.values()[i]}) / 255.0;
        squares += difference * difference;
    }
    if (squares == 0.0) return kEqualPsnrDb;
    return -10.0 * std::log10(squares / static_cast<double>(a.values().size()));
}

image::ImageF errorPicture(const image::ImageF& picture, const image::ImageF& truth, int gain) {
    const image::Image8 a = image::toSrgb8(picture);
    const image::Image8 b = image::toSrgb8(truth);
    const std::array<float, 256> linear = image::srgbDecoding();  // pictures are shown as sRGB
    image::ImageF error(picture.width(), picture.height(), picture.channels());
    for (std::size_t i = 0; i < error.values().size(); ++i) {
        const int difference = std::abs(int{a.values()[i]} - int{b.values()[i]});
        error.values()[i] = linear[static_cast<std::size_t>(std::min(gain * difference, 255))];
    }
    return error;
}

}  // namespace gfxrepro::kit
