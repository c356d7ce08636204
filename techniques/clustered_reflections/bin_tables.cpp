#include "techniques/clustered_reflections/bin_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/core/error.h"

namespace gfxrepro::clustered_reflections {

BinTables::BinTables(const BinSettings& settings)
    : maxBins(settings.maxThetaBins, settings.maxPhiBins) {
    GFXREPRO_ASSERT(maxBins.x >= 1 && maxBins.y >= 1);
    GFXREPRO_ASSERT(settings.exponent >= 0.0F && settings.gain > 0.0F);
    for (const int most : {maxBins.x, maxBins.y}) {
        for (int bins = 2; bins <= most; ++bins) {
            // round(most · (scale · gain)^exponent) ≥ bins, solved for the scale; with exponent 0
            // the power is 1 and every scale will do.
            const double share = (bins - 0.5) / most;
            const double exponent = settings.exponent;
            const double least =
                exponent > 0.0 ? std::pow(share, 1.0 / exponent) / double{settings.gain} : 0.0;
            leastScale.push_back(static_cast<float>(least));
        }
    }
    for (int bins = 2; bins <= maxBins.x; ++bins) {
        for (int k = 1; k < bins; ++k) {
            const double theta = 2.0 * std::numbers::pi * k / bins;
            thetaBorders.emplace_back(std::cos(theta), std::sin(theta));
        }
    }
    for (int bins = 2; bins <= maxBins.y; ++bins) {
        for (int k = 1; k < bins; ++k) {
            const double cosine = std::cos(std::numbers::pi * k / bins);
            phiBorders.push_back(static_cast<float>(cosine * std::abs(cosine)));
        }
    }
}

glm::ivec2 BinTables::binsOf(std::uint32_t area, std::uint32_t total, std::uint32_t visible) const {
    const float totalTimesVisible = static_cast<float>(total) * static_cast<float>(visible);
    glm::ivec2 bins(1);
    std::size_t at = 0;
    for (int axis = 0; axis < 2; ++axis) {
        for (int k = 2; k <= maxBins[axis]; ++k) {
            if (static_cast<float>(area) >= leastScale[at++] * totalTimesVisible) ++bins[axis];
        }
    }
    return bins;
}

long long BinTables::mostBins(std::vector<int> parts) const {
    // The bins of one reflector by its scale a_R / n_v: corners of the staircase, in order.
    std::vector<glm::dvec2> corners{{0.0, 1.0}};
    std::vector<float> scales = leastScale;
    std::ranges::sort(scales);
    for (const float scale : scales) {
        int bins[2] = {1, 1};
        for (std::size_t at = 0; at < leastScale.size(); ++at) {
            const int axis = at < static_cast<std::size_t>(maxBins.x - 1) ? 0 : 1;
            bins[axis] += scale >= leastScale[at] ? 1 : 0;
        }
        const glm::dvec2 corner(scale, bins[0] * bins[1]);
        // Its upper convex hull: no corner below the line from the one before to the one after.
        while (corners.size() > 1 && corner.y > corners.back().y) {
            const glm::dvec2 a = corners[corners.size() - 2], b = corners.back();
            if ((b.y - a.y) * (corner.x - a.x) > (corner.y - a.y) * (b.x - a.x)) break;
            corners.pop_back();
        }
        if (corner.x == corners.back().x) {
            corners.back().y = std::max(corners.back().y, corner.y);
        } else {
            corners.push_back(corner);
        }
    }
    const auto atMost = [&](double scale) {
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const glm::dvec2 a = corners[i - 1], b = corners[i];
            if (scale < b.x) return a.y + (b.y - a.y) * (scale - a.x) / (b.x - a.x);
        }
        return corners.back().y;
    };
    // Of n visible objects the scales of all m parts add up to 1 / n: on a concave curve the most
    // is where all are the same. Most parts have the objects with most of them.
    std::ranges::sort(parts, std::greater());
    double most = 0.0;
    int m = 0;
    for (std::size_t n = 1; n <= parts.size(); ++n) {
        m += parts[n - 1];
        if (m > 0) most = std::max(most, m * atMost(1.0 / (static_cast<double>(n) * m)));
    }
    return static_cast<long long>(most);
}

}  // namespace gfxrepro::clustered_reflections
