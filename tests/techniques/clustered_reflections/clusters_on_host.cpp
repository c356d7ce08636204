#include "tests/techniques/clustered_reflections/clusters_on_host.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gfxrepro::clustered_reflections {

namespace {

/// Borders between n bins begin here.
std::size_t firstBorder(int bins) {
    return static_cast<std::size_t>((bins - 1) * (bins - 2) / 2);
}

bool isInSecondHalf(const glm::vec2& v) {
    return !(v.y > 0.0F || (v.y == 0.0F && v.x > 0.0F));
}

/// Is the angle of a at least that of b, both in [0°, 360°) from +x? As in assign_bins.frag.
bool isAtLeast(const glm::vec2& a, const glm::vec2& b) {
    if (isInSecondHalf(a) != isInSecondHalf(b)) return isInSecondHalf(a);
    return b.x * a.y >= b.y * a.x;
}

}  // namespace

glm::ivec2 binOnHost(const BinTables& tables, const glm::vec2& normalOctahedral,
                     const glm::ivec2& bins) {
    const glm::vec3 n = reflections::directionFromOctahedral(normalOctahedral);
    glm::ivec2 bin(0);
    if (n.x != 0.0F || n.z != 0.0F) {
        for (int k = 1; k < bins.x; ++k) {
            const auto border = firstBorder(bins.x) + static_cast<std::size_t>(k - 1);
            if (isAtLeast({n.x, n.z}, tables.thetaBorders[border])) bin.x = k;
        }
    }
    const float lengthSquare = n.x * n.x + n.y * n.y + n.z * n.z;
    for (int k = 1; k < bins.y; ++k) {
        const auto border = firstBorder(bins.y) + static_cast<std::size_t>(k - 1);
        if (n.y * std::abs(n.y) <= tables.phiBorders[border] * lengthSquare) bin.y = k;
    }
    return bin;
}

HostClusters clusterOnHost(const reflections::HostGBuffer& gbuffer,
                           const reflections::ReflectiveScene& scene, const BinSettings& bins,
                           const std::vector<std::uint8_t>* wanted) {
    const BinTables tables(bins);
    const std::vector<std::uint8_t> isPlanar = planarReflectors(scene);
    const std::size_t pixels = gbuffer.surface.size();
    const auto reflectorAt = [&](std::size_t i) {
        const bool isWanted = wanted == nullptr || (*wanted)[i] != 0;
        return isWanted ? static_cast<std::size_t>(gbuffer.reflector(i)) : 0;
    };
    std::vector<std::uint32_t> areas(isPlanar.size(), 0);
    for (std::size_t i = 0; i < pixels; ++i) ++areas[reflectorAt(i)];

    HostClusters result;
    const std::vector<std::uint32_t> wholes = wholeReflectors(scene);
    std::set<std::uint32_t> visible;
    std::uint32_t total = 0;
    for (std::size_t r = 1; r < areas.size(); ++r) {
        total += areas[r];
        if (areas[r] > 0) visible.insert(wholes[r]);
    }
    result.visibleReflectors = static_cast<int>(visible.size());
    std::vector<glm::ivec2> grids(areas.size(), glm::ivec2(1));
    std::vector<int> firstBins(areas.size(), 0), reflectorOfBin;
    for (std::size_t r = 1; r < areas.size(); ++r) {
        firstBins[r] = static_cast<int>(reflectorOfBin.size());
        if (areas[r] == 0) continue;
        const auto visibleCount = static_cast<std::uint32_t>(visible.size());
        if (isPlanar[r] == 0) grids[r] = tables.binsOf(areas[r], total, visibleCount);
        const auto count = static_cast<std::size_t>(grids[r].x * grids[r].y);
        reflectorOfBin.insert(reflectorOfBin.end(), count, static_cast<int>(r));
    }

    std::vector<int> bin(pixels, -1);
    std::vector<int> samplesOfBin(reflectorOfBin.size(), 0);
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t r = reflectorAt(i);
        if (r == 0) continue;
        const glm::ivec2 ij = binOnHost(tables, gbuffer.normalOctahedral[i], grids[r]);
        bin[i] = firstBins[r] + ij.y * grids[r].x + ij.x;
        ++samplesOfBin[static_cast<std::size_t>(bin[i])];
    }
    std::vector<std::uint16_t> clusterOfBin(reflectorOfBin.size(), 0);
    int lastReflector = 0, lastSamples = 0;
    for (std::size_t b = 0; b < clusterOfBin.size(); ++b) {
        if (samplesOfBin[b] == 0) continue;
        const bool isJoined = reflectorOfBin[b] == lastReflector &&
                              std::min(lastSamples, samplesOfBin[b]) < bins.leastSamples;
        if (!isJoined) {
            ++result.clusterCount;
            result.reflectorOfCluster.push_back(reflectorOfBin[b]);
            lastReflector = reflectorOfBin[b];
            lastSamples = 0;
        }
        lastSamples += samplesOfBin[b];
        clusterOfBin[b] = static_cast<std::uint16_t>(result.clusterCount);
    }
    result.clusterOfSample.assign(pixels, 0);
    for (std::size_t i = 0; i < pixels; ++i) {
        if (bin[i] >= 0) result.clusterOfSample[i] = clusterOfBin[static_cast<std::size_t>(bin[i])];
    }
    return result;
}

}  // namespace gfxrepro::clustered_reflections
