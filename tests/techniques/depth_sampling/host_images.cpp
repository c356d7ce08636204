#include "tests/techniques/depth_sampling/host_images.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/intersect.hpp>
#include <random>

namespace gfxrepro::test {

using kit::HostDepthImage;
using kit::View;

std::vector<Triangle> randomTriangles(int count, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> place(-1.0F, 1.0F);
    std::uniform_real_distribution<float> edge(-0.5F, 0.5F);
    const auto vector = [&](auto& distribution) {
        const float x = distribution(generator);
        const float y = distribution(generator);
        return glm::vec3(x, y, distribution(generator));
    };
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 centre = vector(place);
        Triangle triangle;
        for (glm::vec3& corner : triangle) corner = centre + vector(edge);
        triangles.push_back(triangle);
    }
    return triangles;
}

View viewFrom(const glm::vec3& eye, glm::ivec2 sizePx, const glm::vec3& target) {
    const scene::Camera camera{.position = eye,
                               .target = target,
                               .verticalFovRad = glm::radians(45.0F),
                               .nearM = 0.05F,
                               .farM = 20.0F};
    return kit::viewOf(camera, sizePx);
}

HostDepthImage filledImage(const View& view, float depthM, std::uint32_t triangleId) {
    const auto pixels =
        static_cast<std::size_t>(view.sizePx.x) * static_cast<std::size_t>(view.sizePx.y);
    HostDepthImage image{view, {}, {}, {}};
    image.shading.assign(pixels, triangleId == 0 ? glm::u8vec4(0) : glm::u8vec4(255));
    image.depthM.assign(pixels, depthM);
    image.triangleId.assign(pixels, triangleId);
    return image;
}

HostDepthImage emptyImage(const View& view) {
    return filledImage(view, 0.0F, 0);
}

bool isPixelRedundant(const HostDepthImage& image, glm::ivec2 pixel, const HostDepthImage& other) {
    const auto landed = kit::pixelOf(other.view, image.pointWorld(pixel));
    return landed &&
           other.triangleId[other.indexOf(*landed)] == image.triangleId[image.indexOf(pixel)];
}

bool isRedundantWithAny(const HostDepthImage& image, glm::ivec2 pixel, HostImages others) {
    return std::any_of(others.begin(), others.end(), [&](const HostDepthImage& other) {
        return isPixelRedundant(image, pixel, other);
    });
}

bool isBorderline(const HostDepthImage& image, glm::ivec2 pixel, const HostDepthImage& other) {
    constexpr float kTolerancePx = 1e-3F;
    const auto landed = kit::project(other.view, image.pointWorld(pixel));
    if (!landed) return false;
    for (int axis = 0; axis < 2; ++axis) {
        const float border = std::round((*landed)[axis]);
        if (border < 0.0F || border > static_cast<float>(other.view.sizePx[axis])) continue;
        if (std::abs((*landed)[axis] - border) < kTolerancePx) return true;
    }
    return false;
}

bool isBorderlineWithAny(const HostDepthImage& image, glm::ivec2 pixel, HostImages others) {
    return std::any_of(others.begin(), others.end(), [&](const HostDepthImage& other) {
        return isBorderline(image, pixel, other);
    });
}

HostDepthImage castImage(const View& view, std::span<const Triangle> triangles,
                         HostImages earlier) {
    struct Met {
        float depthM;
        std::uint32_t triangleId;
    };
    HostDepthImage image = emptyImage(view);
    for (int y = 0; y < view.sizePx.y; ++y) {
        for (int x = 0; x < view.sizePx.x; ++x) {
            // Of depth 1 along the view axis: distances along it are depths.
            const glm::vec3 direction =
                kit::unproject(view, glm::vec2(x, y) + 0.5F, 1.0F) - view.eyeWorld;
            std::vector<Met> all;
            for (std::size_t t = 0; t < triangles.size(); ++t) {
                glm::vec2 barycentric;
                float depthM = 0.0F;
                const Triangle& v = triangles[t];
                if (glm::intersectRayTriangle(view.eyeWorld, direction, v[0], v[1], v[2],
                                              barycentric, depthM) &&
                    depthM > view.nearM) {
                    all.push_back({depthM, static_cast<std::uint32_t>(t + 1)});
                }
            }
            std::sort(all.begin(), all.end(),
                      [](const Met& a, const Met& b) { return a.depthM < b.depthM; });
            const std::size_t index = image.indexOf({x, y});
            for (const Met& met : all) {
                image.depthM[index] = met.depthM;
                image.triangleId[index] = met.triangleId;
                image.shading[index] = glm::u8vec4(met.triangleId * 5U, 128, 128, 255);
                if (!isRedundantWithAny(image, {x, y}, earlier)) break;
                image.depthM[index] = 0.0F;
                image.triangleId[index] = 0;
                image.shading[index] = glm::u8vec4(0);
            }
        }
    }
    return image;
}

}  // namespace gfxrepro::test
