// Pictures of clusters, of errors, and of what is wrong where ([xie2017] Fig. 22 to 28).
#pragma once

#include <cstdint>
#include <vector>

#include "runner/image/image.h"
#include "techniques/shared/reflections/gbuffer.h"

namespace gfxrepro::clustered_reflections {

/// Fig. 26: |picture − truth| of the values that are shown, times `gain`.
image::ImageF errorPicture(const image::ImageF& picture, const image::ImageF& truth, int gain);

/// Fig. 22 and 23: a colour a number (a reflector or cluster), 0 is grey; of the samples, averaged
/// to output pixels.
image::ImageF numbersPicture(const reflections::HostGBuffer& gbuffer,
                             const std::vector<std::uint16_t>& numbers, int supersampling);
std::vector<std::uint16_t> reflectorNumbers(const reflections::HostGBuffer& gbuffer);

/// Fig. 27 and 28: `picture`, a little darker, with marked samples red.
image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const reflections::HostGBuffer& gbuffer, int supersampling);

}  // namespace gfxrepro::clustered_reflections
