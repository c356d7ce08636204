#include "techniques/reflections/surface_pictures.h"

#include <cmath>

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

glm::vec3 dimmed(const HostGBuffer& gbuffer, std::size_t index) {
    constexpr glm::vec3 kLuminance{0.2126F, 0.7152F, 0.0722F};
    return glm::vec3(0.05F + 0.3F * glm::dot(gbuffer.diffuse[index], kLuminance));
}

glm::vec3 hue(float turn) {
    const float sixth = 6.0F * turn;
    return glm::clamp(glm::vec3(std::abs(sixth - 3.0F) - 1.0F, 2.0F - std::abs(sixth - 2.0F),
                                2.0F - std::abs(sixth - 4.0F)),
                      0.0F, 1.0F);
}

kit::ImageLayers surfaceLayers(const HostGBuffer& gbuffer, int supersampling) {
    std::vector<std::uint32_t> reflectors;
    reflectors.reserve(gbuffer.surface.size());
    for (std::size_t i = 0; i < gbuffer.surface.size(); ++i) {
        reflectors.push_back(static_cast<std::uint32_t>(gbuffer.reflector(i)));
    }
    kit::ImageLayers layers(gbuffer.view, supersampling);
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
