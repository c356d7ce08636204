// Depth images: per pixel the shading, depth and triangle of the sample at its centre.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/gl/objects.h"
#include "techniques/kit/picture.h"
#include "techniques/kit/view.h"

namespace gfxrepro::kit {

/// What the depth test compares; the stored depth does not depend on it.
enum class DepthFormat {
    Unorm24,
    Float32,
    ReversedFloat32,  // 1 at the near plane, 0 at the far plane, clip z from 0 to w
};

/// A depth image on the device, drawn by DepthImageRenderer ([xie2017] Sec. 2.3.1).
struct DepthImage {
    View view;
    gl::Texture shading;     // RGBA8, linear, direct light; alpha 1 where there is a sample
    gl::Texture depth;       // R32F, distance along the view axis in metres; 0: no sample
    gl::Texture triangleId;  // R32UI, 1 + index into scene::flattened(scene).triangles; 0: none
    gl::Texture depthBuffer;
    gl::Framebuffer framebuffer;

    DepthImage(const View& view, DepthFormat format);
    std::size_t sizeBytes() const;
};

/// The same in the host's memory, rows from the bottom: pixel (x, y) is at y · width + x.
struct HostDepthImage {
    View view;
    std::vector<glm::u8vec4> shading;
    std::vector<float> depthM;
    std::vector<std::uint32_t> triangleId;

    std::size_t indexOf(glm::ivec2 pixel) const {
        return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(view.sizePx.x) +
               static_cast<std::size_t>(pixel.x);
    }
    /// The point that a pixel's sample lies on. Only where there is a sample.
    glm::vec3 pointWorld(glm::ivec2 pixel) const {
        return unproject(view, glm::vec2(pixel) + 0.5F, depthM[indexOf(pixel)]);
    }
};

/// Reads back; waits for the device.
HostDepthImage readDepthImage(const DepthImage& image);

/// The shading as an image, rows from the top, 3 linear channels; `background` where there is no
/// sample.
image::ImageF shadingPicture(const HostDepthImage& image,
                             const glm::vec3& background = kBackground);

}  // namespace gfxrepro::kit
