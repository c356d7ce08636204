// Pictures of clusters ([xie2017] Fig. 22 and 23).
#pragma once

#include <cstdint>
#include <vector>

#include "runner/image/image.h"
#include "techniques/reflections/gbuffer.h"

namespace gfxrepro::clustered_reflections {

/// Fig. 22 and 23: a colour a number (a reflector or cluster), 0 is grey; of the samples, averaged
/// to output pixels.
image::ImageF numbersPicture(const reflections::HostGBuffer& gbuffer,
                             const std::vector<std::uint16_t>& numbers, int supersampling);
std::vector<std::uint16_t> reflectorNumbers(const reflections::HostGBuffer& gbuffer);

}  // namespace gfxrepro::clustered_reflections
