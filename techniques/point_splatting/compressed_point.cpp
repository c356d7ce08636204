#include "techniques/point_splatting/compressed_point.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "engine/core/error.h"

namespace gfxrepro::point_splatting {

namespace {

constexpr int kTableSize = 256;
/// The grid and its cells (Sec. 3.3.2.1): 256 · 8, 256 · 8 and 256 · 4 places an axis.
constexpr glm::vec3 kPlaces{2048.0F, 2048.0F, 1024.0F};
constexpr float kAngleSteps = 256.0F;

std::uint32_t placeOn(float value, float low, float high, float places) {
    const float size = high - low;
    const float share = size > 0.0F ? (value - low) / size : 0.0F;
    return static_cast<std::uint32_t>(std::clamp(std::floor(share * places), 0.0F, places - 1.0F));
}

glm::vec3 normalAt(std::uint32_t theta, std::uint32_t phi) {
    const float t = (static_cast<float>(theta) + 0.5F) / kAngleSteps * glm::two_pi<float>();
    const float p = (static_cast<float>(phi) + 0.5F) / kAngleSteps * glm::pi<float>();
    return {std::sin(p) * std::cos(t), std::cos(p), std::sin(p) * std::sin(t)};
}

}  // namespace

std::vector<float> clusteredRadii(std::span<const float> radii) {
    std::vector<float> sorted(radii.begin(), radii.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<float> table(sorted);
    table.erase(std::unique(table.begin(), table.end()), table.end());
    if (table.size() <= kTableSize) return table;

    // One-dimensional k-means over sorted values: clusters are ranges.
    std::vector<double> sums(sorted.size() + 1, 0.0);  // of logarithms, up to each
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        sums[i + 1] = sums[i] + std::log(static_cast<double>(sorted[i]));
    }
    table.resize(kTableSize);
    for (std::size_t k = 0; k < kTableSize; ++k) {
        table[k] = sorted[(2 * k + 1) * sorted.size() / (2 * kTableSize)];
    }
    constexpr int kRounds = 32;
    for (int round = 0; round < kRounds; ++round) {
        std::size_t begin = 0;
        std::vector<float> moved(kTableSize);
        for (std::size_t k = 0; k < kTableSize; ++k) {
            std::size_t end = sorted.size();
            if (k + 1 < kTableSize) {  // the border is the middle of the logarithms
                const float border = std::sqrt(table[k] * table[k + 1]);
                end = static_cast<std::size_t>(
                    std::lower_bound(sorted.begin(), sorted.end(), border) - sorted.begin());
                end = std::max(end, begin);
            }
            moved[k] = end > begin ? static_cast<float>(std::exp((sums[end] - sums[begin]) /
                                                                 static_cast<double>(end - begin)))
                                   : table[k];
            begin = end;
        }
        if (moved == table) break;
        table = std::move(moved);
    }
    return table;
}

std::uint8_t nearestRadius(std::span<const float> table, float radius) {
    GFXREPRO_ASSERT(!table.empty() && table.size() <= kTableSize);
    const auto above = std::lower_bound(table.begin(), table.end(), radius);
    if (above == table.begin()) return 0;
    const auto below = static_cast<std::size_t>(above - table.begin()) - 1;
    if (above == table.end()) return static_cast<std::uint8_t>(below);
    const bool isBelowNearer = radius - table[below] <= *above - radius;
    return static_cast<std::uint8_t>(isBelowNearer ? below : below + 1);
}

int tangentChoice(const glm::vec3& normal) {
    const glm::vec3 size = glm::abs(normal);
    if (size.x <= size.y && size.x <= size.z) return 0;
    return size.y <= size.z ? 1 : 2;
}

glm::vec3 tangentOf(const glm::vec3& normal, int choice) {
    if (choice == 0) return glm::normalize(glm::vec3(0.0F, -normal.z, normal.y));
    if (choice == 1) return glm::normalize(glm::vec3(normal.z, 0.0F, -normal.x));
    return glm::normalize(glm::vec3(-normal.y, normal.x, 0.0F));
}

CompressedPoint compressed(const glm::vec3& position, const glm::vec3& normal, float radius,
                           const scene::Box& patchBounds, std::span<const float> radiusTable) {
    const auto place = [&](int axis) {
        return placeOn(position[axis], patchBounds.min[axis], patchBounds.max[axis], kPlaces[axis]);
    };
    const std::uint32_t x = place(0), y = place(1), z = place(2);
    CompressedPoint point;
    const std::array<std::uint32_t, 6> places{x >> 3, y >> 3, z >> 2, x & 7U, y & 7U, z & 3U};
    for (std::size_t i = 0; i < places.size(); ++i) {
        point.position |= layout::kPosition[i].put(places[i]);
    }

    float angle = std::atan2(normal.z, normal.x);
    if (angle < 0.0F) angle += glm::two_pi<float>();
    const std::uint32_t theta = placeOn(angle, 0.0F, glm::two_pi<float>(), kAngleSteps);
    const std::uint32_t phi =
        placeOn(std::acos(std::clamp(normal.y, -1.0F, 1.0F)), 0.0F, glm::pi<float>(), kAngleSteps);
    // Of the normal that will be decoded: its tangent must not vanish.
    const auto choice = static_cast<std::uint32_t>(tangentChoice(normalAt(theta, phi)));
    point.surface = layout::kTheta.put(theta) | layout::kPhi.put(phi) |
                    layout::kTangent.put(choice) |
                    layout::kRadius.put(nearestRadius(radiusTable, radius));
    return point;
}

DecodedPoint decoded(const CompressedPoint& point, const scene::Box& patchBounds,
                     std::span<const float> radiusTable) {
    const auto at = [&](std::size_t i) { return layout::kPosition[i].of(point.position); };
    const glm::vec3 place(at(0) << 3 | at(3), at(1) << 3 | at(4), at(2) << 2 | at(5));
    DecodedPoint result;
    result.position = patchBounds.min + (place + 0.5F) / kPlaces * patchBounds.size();
    result.normal = normalAt(layout::kTheta.of(point.surface), layout::kPhi.of(point.surface));
    result.tangent = tangentOf(result.normal, static_cast<int>(layout::kTangent.of(point.surface)));
    result.bitangent = glm::cross(result.normal, result.tangent);
    result.radius = radiusTable[layout::kRadius.of(point.surface)];
    return result;
}

glm::vec3 positionErrorBound(const scene::Box& patchBounds) {
    // The box's size, the share of it and their product round by half a unit in the last place of
    // the size each, the sum by half a unit of the coordinate.
    constexpr float kHalfUnit = 0x1p-24F;
    const glm::vec3 size = patchBounds.size();
    const glm::vec3 coordinate = glm::max(glm::abs(patchBounds.min), glm::abs(patchBounds.max));
    return 0.5F * size / kPlaces + kHalfUnit * (3.0F * size + coordinate);
}

float normalErrorBoundRad() {
    // Half a step along the circle of latitude (longest at the equator) and half a step across.
    return std::hypot(0.5F / kAngleSteps * glm::two_pi<float>(),
                      0.5F / kAngleSteps * glm::pi<float>());
}

}  // namespace gfxrepro::point_splatting
