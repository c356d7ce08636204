// What a picture of terrain gets wrong, against the full-resolution truth from the same view. On
// the host, without GL.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/image/image.h"
#include "techniques/kit/view.h"

namespace gfxrepro::terrain_tessellation {

/// Distances along the view axis in metres, rows from the bottom; 0: background, or the underside
/// of the terrain.
struct DepthMap {
    kit::View view;
    std::vector<float> depthM;

    std::size_t indexOf(glm::ivec2 pixel) const {
        return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(view.sizePx.x) +
               static_cast<std::size_t>(pixel.x);
    }
    bool contains(glm::ivec2 pixel) const {
        return glm::clamp(pixel, glm::ivec2(0), view.sizePx - 1) == pixel;
    }
    bool isCovered(glm::ivec2 pixel) const { return depthM[indexOf(pixel)] > 0.0F; }
};

/// Over the pixels that show ground, of which the truth shows some, too (skirts hang where it does
/// not): how far above or below the true terrain the point is that
/// they show.
struct HeightErrors {
    double meanM = 0.0, maxM = 0.0;
    double meanPx = 0.0, maxPx = 0.0;  // seen from the side at the point's depth: an upper bound
    std::size_t pixels = 0;
};
/// `heightAt(x, z)`: of the truth's triangles (drawnHeightAt) in metres; `afterRow` is called
/// between rows of pixels.
HeightErrors heightErrors(
    const DepthMap& drawn, const DepthMap& truth,
    const std::function<float(float x, float z)>& heightAt,
    const std::function<void()>& afterRow = [] {});

/// Marks pixels through which the background shows although the terrain is whole there: below
/// drawn terrain, and further from what the truth, too, shows of the background, and from the
/// image's rim, beside which it may, than an outline drawn too low or too narrow leaves bare. A
/// byte a pixel, rows from the bottom.
std::vector<std::uint8_t> crackMarks(const DepthMap& drawn, const DepthMap& truth);
std::size_t markedCount(const std::vector<std::uint8_t>& marks);

/// `picture` a little darker, marked pixels red. `marks` has rows from the bottom.
image::ImageF withMarks(const image::ImageF& picture, const std::vector<std::uint8_t>& marks);

}  // namespace gfxrepro::terrain_tessellation
