#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scenes/indoor/bathroom_parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::bathroom_parts {

namespace {

constexpr int kDirections = 64;
constexpr float kRangeM = 0.9F;     // what is further away takes nothing
constexpr float kStrength = 0.85F;  // what is shut in on all sides keeps the rest
constexpr float kLiftM = 0.015F;  // rays start off the surface, whose own solid is only roughly it

/// Even over the cosine around +y: points of a Vogel spiral on the disc, lifted to the hemisphere.
std::array<glm::vec3, kDirections> hemisphere() {
    constexpr float kGoldenAngleRad = 2.39996323F;
    std::array<glm::vec3, kDirections> directions;
    for (int i = 0; i < kDirections; ++i) {
        const float squared = (static_cast<float>(i) + 0.5F) / static_cast<float>(kDirections);
        const float radius = std::sqrt(squared);
        const float angleRad = kGoldenAngleRad * static_cast<float>(i);
        directions[static_cast<std::size_t>(i)] = {radius * sdf::cosine(angleRad),
                                                   std::sqrt(1.0F - squared),
                                                   radius * sdf::sine(angleRad)};
    }
    return directions;
}

struct Interval {
    float low = 0.0F;
    float high = std::numeric_limits<float>::infinity();

    void cut(float a, float b) {
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
    }
};

void cutSlab(Interval& interval, float origin, float direction, float min, float max) {
    if (std::abs(direction) > 1e-6F) {
        interval.cut((min - origin) / direction, (max - origin) / direction);
    } else if (origin < min || origin > max) {
        interval.high = -1.0F;
    }
}

/// Where the ray enters the solid; infinite where it does not.
float distanceTo(const Occluder& occluder, const glm::vec3& origin, const glm::vec3& direction) {
    Interval interval;
    cutSlab(interval, origin.y, direction.y, occluder.min.y, occluder.max.y);
    if (occluder.isRound) {
        const glm::vec3 half = 0.5F * (occluder.max - occluder.min);
        const glm::vec3 o = (origin - 0.5F * (occluder.max + occluder.min)) / half;
        const glm::vec3 d = direction / half;
        const float a = d.x * d.x + d.z * d.z, b = o.x * d.x + o.z * d.z;
        const float c = o.x * o.x + o.z * o.z - 1.0F;
        const float discriminant = b * b - a * c;
        if (discriminant < 0.0F || (a < 1e-6F && c > 0.0F)) {
            interval.high = -1.0F;
        } else if (a >= 1e-6F) {
            const float root = std::sqrt(discriminant);
            interval.cut((-b - root) / a, (-b + root) / a);
        }
    } else {
        cutSlab(interval, origin.x, direction.x, occluder.min.x, occluder.max.x);
        cutSlab(interval, origin.z, direction.z, occluder.min.z, occluder.max.z);
    }
    return interval.low < interval.high ? interval.low : std::numeric_limits<float>::infinity();
}

float distanceToWalls(const glm::vec3& origin, const glm::vec3& direction) {
    Interval interval;
    for (int axis = 0; axis < 3; ++axis) {
        cutSlab(interval, origin[axis], direction[axis], 0.0F, kRoom[axis]);
    }
    return std::max(interval.high, 0.0F);
}

float opennessAt(const glm::vec3& position, const glm::vec3& normal,
                 std::span<const Occluder> occluders,
                 std::span<const glm::vec3, kDirections> directions) {
    const glm::vec3 origin = glm::clamp(position + normal * kLiftM, glm::vec3(0.0F), kRoom);
    const glm::vec3 axis = std::abs(normal.y) < 0.8F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 tangent = glm::normalize(glm::cross(axis, normal));
    const glm::mat3 frame(tangent, normal, glm::cross(tangent, normal));
    float taken = 0.0F;
    for (const glm::vec3& local : directions) {
        const glm::vec3 direction = frame * local;
        float distance = distanceToWalls(origin, direction);
        for (const Occluder& occluder : occluders) {
            // Zero: the ray starts within, on the occluder's own surface.
            const float entry = distanceTo(occluder, origin, direction);
            if (entry > 0.0F) distance = std::min(distance, entry);
        }
        const float nearness = std::max(0.0F, 1.0F - distance / kRangeM);
        taken += nearness * nearness;
    }
    return 1.0F - kStrength * taken / static_cast<float>(kDirections);
}

}  // namespace

void darken(Mesh& mesh, std::span<const Occluder> occluders) {
    const auto directions = hemisphere();
    // Only what is near the mesh matters.
    Box reach = mesh.bounds();
    std::vector<Occluder> near;
    for (const Occluder& occluder : occluders) {
        const glm::vec3 apart = glm::max(occluder.min - reach.max, reach.min - occluder.max);
        if (std::max({apart.x, apart.y, apart.z}) < kRangeM) near.push_back(occluder);
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.colors[i] *= opennessAt(mesh.positions[i], mesh.normals[i], near, directions);
    }
}

}  // namespace gfxrepro::scene::bathroom_parts
