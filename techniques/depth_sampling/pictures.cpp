#include "techniques/depth_sampling/pictures.h"

#include "techniques/depth_sampling/pixel_measures.h"

namespace gfxrepro::depth_sampling {

using kit::HostDepthImage;

namespace {

glm::vec3 shadingOf(const HostDepthImage& image, std::size_t index) {
    return glm::vec3(image.shading[index]) / 255.0F;
}

/// Luminance of linear Rec. 709.
float brightness(const glm::vec3& color) {
    return glm::dot(color, glm::vec3(0.2126F, 0.7152F, 0.0722F));
}

/// The legend's colour, darkened by the shading so that shapes stay visible, but never below 0.3 of
/// it, so that a dark leaf can still be told green from yellow.
glm::vec3 tinted(const glm::vec3& color, const glm::vec3& shading) {
    return color * (0.3F + 0.7F * brightness(shading));
}

/// `colorOf(index)` of all samples.
template <class ColorOf>
image::ImageF picture(const HostDepthImage& image, std::span<const std::uint32_t> marks,
                      ColorOf&& colorOf) {
    GFXREPRO_ASSERT_EQ(marks.size(), image.triangleId.size());
    return kit::pictureOf(image.view.sizePx, [&](std::size_t index) {
        return (marks[index] & kSample) != 0 ? colorOf(index) : kPictureBackground;
    });
}

}  // namespace

image::ImageF occludedPicture(const HostDepthImage& image, std::span<const std::uint32_t> marks) {
    return picture(image, marks, [&](std::size_t index) {
        const glm::vec3 shading = shadingOf(image, index);
        if ((marks[index] & kUseful) != 0) return tinted(kUsefulColor, shading);
        if ((marks[index] & kOccluded) != 0) return tinted(kOccludedColor, shading);
        return glm::vec3(brightness(shading));
    });
}

image::ImageF availabilityPicture(const HostDepthImage& frame,
                                  std::span<const std::uint32_t> marks) {
    return picture(frame, marks, [&](std::size_t index) {
        const glm::vec3 shading = shadingOf(frame, index);
        return (marks[index] & kAvailable) != 0 ? shading : tinted(kUnavailableColor, shading);
    });
}

}  // namespace gfxrepro::depth_sampling
