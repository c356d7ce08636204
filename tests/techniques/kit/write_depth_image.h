// Depth images that were made on the host, by ray casting or by hand, for what reads them.
#pragma once

#include "engine/core/error.h"
#include "techniques/kit/depth_image.h"

namespace gfxrepro::kit {

/// Writes a host image into one of the same size.
inline void writeDepthImage(const HostDepthImage& host, DepthImage& image) {
    const glm::ivec2 sizePx = image.view.sizePx;
    const auto pixelCount = static_cast<std::size_t>(sizePx.x) * static_cast<std::size_t>(sizePx.y);
    GFXREPRO_ASSERT(host.view.sizePx == sizePx);
    GFXREPRO_ASSERT_EQ(host.shading.size(), pixelCount);
    GFXREPRO_ASSERT_EQ(host.depthM.size(), pixelCount);
    GFXREPRO_ASSERT_EQ(host.triangleId.size(), pixelCount);
    image.view = host.view;
    image.shading.upload(GL_RGBA, GL_UNSIGNED_BYTE, host.shading.data());
    image.depth.upload(GL_RED, GL_FLOAT, host.depthM.data());
    image.triangleId.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, host.triangleId.data());
}

}  // namespace gfxrepro::kit
