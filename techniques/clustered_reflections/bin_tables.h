// Borders of the bins of [xie2017] Sec. 4.3 in forms that need no quotient, root or angle: products
// and sums are rounded the same on every device, so that the host repeats each decision exactly.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "techniques/clustered_reflections/clustering.h"

namespace gfxrepro::clustered_reflections {

struct BinTables {
    explicit BinTables(const BinSettings& settings);

    /// Theta and phi bins of a curved reflector with `area` of `total` reflective samples, one of
    /// `visible` reflectors.
    glm::ivec2 binsOf(std::uint32_t area, std::uint32_t total, std::uint32_t visible) const;
    /// No more bins than this have curved reflectors together, whatever their areas are; `parts`
    /// has the number of them that each object consists of.
    long long mostBins(std::vector<int> parts) const;

    glm::ivec2 maxBins;
    /// The least a_R / n_v for k + 2 theta bins, k = 0 … maxThetaBins − 2; then for phi's.
    std::vector<float> leastScale;
    /// (cos, sin) of border k = 1 … n − 1 between n theta bins, n = 2 … maxThetaBins.
    std::vector<glm::vec2> thetaBorders;
    /// cos · |cos| of border k = 1 … n − 1 between n phi bins, n = 2 … maxPhiBins.
    std::vector<float> phiBorders;
};

}  // namespace gfxrepro::clustered_reflections
