// Pictures of what a frame took from its key frame ([xie2017] Fig. 36).
#pragma once

#include <vector>

#include "runner/image/image.h"
#include "techniques/reflections/gbuffer.h"

namespace gfxrepro::reflection_reuse {

/// Fig. 36 B: hue by direction, stronger the longer an offset is beside the longest; samples
/// without a match are black, without a reflection grey. `key` is the key frame's.
image::ImageF offsetsPicture(const reflections::HostGBuffer& key,
                             const std::vector<glm::vec2>& offsets, int supersampling);

/// Fig. 36 C: radiance of the shifted image, red where a reflective sample got nothing valid.
image::ImageF shiftedPicture(const reflections::HostGBuffer& key,
                             const std::vector<glm::vec4>& radiance, int supersampling);

}  // namespace gfxrepro::reflection_reuse
