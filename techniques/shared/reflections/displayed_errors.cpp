#include "techniques/shared/reflections/displayed_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runner/core/error.h"
#include "runner/image/srgb.h"

namespace gfxrepro::reflections {

std::vector<std::uint8_t> reflectivePixels(const HostGBuffer& gbuffer, int supersampling) {
    const glm::ivec2 size = gbuffer.view.sizePx / supersampling;
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.x) *
                                     static_cast<std::size_t>(size.y));
    for (int y = 0; y < size.y * supersampling; ++y) {
        for (int x = 0; x < size.x * supersampling; ++x) {
            if (!gbuffer.isReflective(gbuffer.indexOf({x, y}))) continue;
            const int row = size.y - 1 - y / supersampling;
            pixels[static_cast<std::size_t>(row * size.x + x / supersampling)] = 1;
        }
    }
    return pixels;
}

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

image::ImageF averagedPicture(const HostGBuffer& gbuffer, int supersampling,
                              const std::function<glm::vec3(std::size_t)>& colorOf) {
    const glm::ivec2 size = gbuffer.view.sizePx / supersampling;
    image::ImageF picture(size.x, size.y, 3);
    const float weight = 1.0F / static_cast<float>(supersampling * supersampling);
    for (int y = 0; y < size.y * supersampling; ++y) {
        for (int x = 0; x < size.x * supersampling; ++x) {
            const glm::vec3 value = weight * colorOf(gbuffer.indexOf({x, y}));
            for (int c = 0; c < 3; ++c) {
                picture.at(x / supersampling, size.y - 1 - y / supersampling, c) += value[c];
            }
        }
    }
    return picture;
}

depth_images::ImageLayers surfaceLayers(const HostGBuffer& gbuffer, int supersampling) {
    std::vector<std::uint32_t> reflectors;
    reflectors.reserve(gbuffer.surface.size());
    for (std::size_t i = 0; i < gbuffer.surface.size(); ++i) {
        reflectors.push_back(static_cast<std::uint32_t>(gbuffer.reflector(i)));
    }
    depth_images::ImageLayers layers(gbuffer.view, supersampling);
    layers.depths(gbuffer.depthM).normals(gbuffer.normalWorld).ids("id", reflectors);
    return layers;
}

image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const HostGBuffer& gbuffer, int supersampling) {
    const image::ImageF shares = averagedPicture(gbuffer, supersampling, [&](std::size_t i) {
        return glm::vec3(marks[i] != 0 ? 1.0F : 0.0F);
    });
    image::ImageF marked = picture;
    for (int y = 0; y < marked.height(); ++y) {
        for (int x = 0; x < marked.width(); ++x) {
            const float share = shares.at(x, y);
            for (int c = 0; c < 3; ++c) {
                float& value = marked.at(x, y, c);
                value = glm::mix(0.6F * value, c == 0 ? 1.0F : 0.0F, share);
            }
        }
    }
    return marked;
}

}  // namespace gfxrepro::reflections
