// Depth images as pictures that show what the measures found: rows from the top, 3 linear channels.
#pragma once

#include <cstdint>
#include <span>

#include "engine/image/image.h"
#include "techniques/kit/depth_image.h"

namespace gfxrepro::depth_sampling {

/// Where there is no sample.
constexpr glm::vec3 kPictureBackground{0.020F, 0.022F, 0.030F};
/// The legend's colours, of fully lit white surfaces.
constexpr glm::vec3 kOccludedColor{0.06F, 0.62F, 0.10F};
constexpr glm::vec3 kUsefulColor{1.00F, 0.78F, 0.03F};
constexpr glm::vec3 kUnavailableColor{0.85F, 0.03F, 0.03F};

/// A reference image: useful samples yellow, other occluded ones green, the rest grey ([xie2017]
/// Table 3, Fig. 9). `marks` (Mark) one a pixel in the order of HostDepthImage.
image::ImageF occludedPicture(const kit::HostDepthImage& image,
                              std::span<const std::uint32_t> marks);

/// An output frame: samples without kAvailable red, the others in their shading ([xie2017] Fig.
/// 12).
image::ImageF availabilityPicture(const kit::HostDepthImage& frame,
                                  std::span<const std::uint32_t> marks);

}  // namespace gfxrepro::depth_sampling
