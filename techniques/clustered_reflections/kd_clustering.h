// The k-d clustering that Sec. 4.7.4 of [xie2017] names as future work.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/clustered_reflections/clustering.h"

namespace gfxrepro::clustered_reflections {

/// Clusters by position and normal together: each reflector starts as one cluster; the one with the
/// largest squared spread along its widest axis is split at the mean of that axis, until there are
/// as many as the reflector's bins would show at most: half of theta × phi bins, the other half
/// faces away (52 of 13 × 8 on a lone sphere). The six axes are the position, in units of half the
/// diagonal of the reflector's visible part, and the normal. A planar reflector is one cluster.
///
/// On the host: the G-buffer is read back, the clusters are uploaded. The thesis judged
/// clusterings from the top down too slow; this is here to measure what they would gain.
void buildKdClusters(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
                     const std::vector<std::uint8_t>& isPlanar,
                     const std::vector<std::uint32_t>& wholes, const BinSettings& bins,
                     Clusters& clusters);

}  // namespace gfxrepro::clustered_reflections
