// Depth images of a small random scene by brute force: what the device's measures are compared
// with.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "techniques/kit/depth_image.h"

namespace gfxrepro::test {

using Triangle = std::array<glm::vec3, 3>;

/// `count` triangles around the origin, most of them within a box of half size 1.
std::vector<Triangle> randomTriangles(int count, unsigned seed);

/// A view towards `target`, of 45 degrees.
kit::View viewFrom(const glm::vec3& eye, glm::ivec2 sizePx,
                   const glm::vec3& target = glm::vec3(0.0F));

/// An image without samples.
kit::HostDepthImage emptyImage(const kit::View& view);
/// All samples at one depth and of one triangle.
kit::HostDepthImage filledImage(const kit::View& view, float depthM, std::uint32_t triangleId);

using HostImages = std::span<const kit::HostDepthImage>;

/// [xie2017] Algorithm 3, word by word.
bool isPixelRedundant(const kit::HostDepthImage& image, glm::ivec2 pixel,
                      const kit::HostDepthImage& other);
bool isRedundantWithAny(const kit::HostDepthImage& image, glm::ivec2 pixel, HostImages others);

/// Whether the pixel in which the sample lands depends on rounding: a border of pixels of `other`
/// is within 1e-3 px, ten times the difference seen between single and double precision here.
bool isBorderline(const kit::HostDepthImage& image, glm::ivec2 pixel,
                  const kit::HostDepthImage& other);
bool isBorderlineWithAny(const kit::HostDepthImage& image, glm::ivec2 pixel, HostImages others);

/// [xie2017] Algorithm 1: on the ray of each pixel the nearest triangle that no earlier image holds
/// where it lands. Both sides of triangles are seen.
kit::HostDepthImage castImage(const kit::View& view, std::span<const Triangle> triangles,
                              HostImages earlier = {});

}  // namespace gfxrepro::test
