#include "techniques/kit/depth_image.h"

#include <array>

#include "engine/core/error.h"

namespace gfxrepro::kit {

namespace {

GLenum glFormatOf(DepthFormat format) {
    return format == DepthFormat::Unorm24 ? GL_DEPTH_COMPONENT24 : GL_DEPTH_COMPONENT32F;
}

}  // namespace

DepthImage::DepthImage(const View& imageView, DepthFormat format)
    : view(imageView),
      shading(gl::Texture::make2D(GL_RGBA8, imageView.sizePx)),
      depth(gl::Texture::make2D(GL_R32F, imageView.sizePx)),
      triangleId(gl::Texture::make2D(GL_R32UI, imageView.sizePx)),
      depthBuffer(gl::Texture::make2D(glFormatOf(format), imageView.sizePx)),
      framebuffer(std::array<const gl::Texture*, 3>{&shading, &depth, &triangleId}, &depthBuffer) {}

std::size_t DepthImage::sizeBytes() const {
    return shading.sizeBytes() + depth.sizeBytes() + triangleId.sizeBytes() +
           depthBuffer.sizeBytes();
}

HostDepthImage readDepthImage(const DepthImage& image) {
    HostDepthImage host;
    host.view = image.view;
    host.shading = image.shading.read<glm::u8vec4>(GL_RGBA, GL_UNSIGNED_BYTE, 1);
    host.depthM = image.depth.read<float>(GL_RED, GL_FLOAT, 1);
    host.triangleId = image.triangleId.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
    return host;
}

image::ImageF shadingPicture(const HostDepthImage& image, const glm::vec3& background) {
    return pictureOf(image.view.sizePx, [&](std::size_t pixel) {
        return image.triangleId[pixel] != 0 ? glm::vec3(image.shading[pixel]) / 255.0F : background;
    });
}

}  // namespace gfxrepro::kit
