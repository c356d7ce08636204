// How far a picture is from the truth, as both are shown: numbers and pictures.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::kit {

/// Mean absolute difference a channel of two pictures as they are shown: sRGB, 0 … 255. Over the
/// pixels that `wanted` marks, all where it is null; 0 over none.
glm::dvec3 channelErrors(const image::ImageF& picture, const image::ImageF& truth,
                         const std::vector<std::uint8_t>* wanted);

/// Of pictures as they are shown; equal pictures have kEqualPsnrDb.
constexpr double kEqualPsnrDb = 120.0;  // above what 8 bits of any picture here can give
double shownPsnrDb(const image::ImageF& picture, const image::ImageF& truth);

/// [xie2017] Fig. 26 and 41: |picture − truth| of the values that are shown, times `gain`.
image::ImageF errorPicture(const image::ImageF& picture, const image::ImageF& truth, int gain);

}  // namespace gfxrepro::kit
