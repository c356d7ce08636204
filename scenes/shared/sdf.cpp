#include "scenes/shared/sdf.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gfxrepro::scene::sdf {

namespace {

constexpr float kPi = 3.14159265F;

/// The polynomial smooth minimum: the plain minimum where |a − b| ≥ blend.
float smoothMinimum(float a, float b, float blend) {
    const float overlap = blend - std::abs(a - b);
    if (overlap <= 0.0F) return std::min(a, b);
    return std::min(a, b) - overlap * overlap / (4.0F * blend);
}

std::uint32_t hashedLattice(int x, int y, int z, std::uint32_t seed) {
    auto h = static_cast<std::uint32_t>(x) * 0x8DA6B343U ^
             static_cast<std::uint32_t>(y) * 0xD8163841U ^
             static_cast<std::uint32_t>(z) * 0xCB1AB31FU ^ (seed * 0x9E3779B9U);
    h = (h ^ (h >> 16)) * 0x7FEB352DU;
    h = (h ^ (h >> 15)) * 0x846CA68BU;
    return h ^ (h >> 16);
}

/// Gradient noise: 0 at lattice points, about [−0.7, 0.7].
float noise(const glm::vec3& p, std::uint32_t seed) {
    const glm::vec3 cell = glm::floor(p);
    const glm::vec3 f = p - cell;
    const glm::vec3 w = f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F);
    const glm::ivec3 c(cell);
    const auto corner = [&](int x, int y, int z) {
        const std::uint32_t h = hashedLattice(c.x + x, c.y + y, c.z + z, seed);
        const auto part = [h](int shift) {
            return static_cast<float>((h >> shift) & 1023U) / 511.5F - 1.0F;
        };
        return glm::dot(glm::vec3(part(0), part(10), part(20)), f - glm::vec3(x, y, z));
    };
    const auto alongX = [&](int y, int z) {
        const float a = corner(0, y, z);
        return a + w.x * (corner(1, y, z) - a);
    };
    const auto alongY = [&](int z) {
        const float a = alongX(0, z);
        return a + w.y * (alongX(1, z) - a);
    };
    const float a = alongY(0);
    return a + w.z * (alongY(1) - a);
}

/// Bounds of a field over a neighbourhood.
struct Range {
    float low, high;
};

Range joined(const Range& a, const Range& b, float blend) {
    return {std::min(a.low, b.low) - 0.25F * blend, std::min(a.high, b.high)};
}

}  // namespace

float sine(float angleRad) {
    // To [−π/2, π/2], then Taylor's polynomial of degree 11.
    float x = angleRad - 2.0F * kPi * std::floor(angleRad / (2.0F * kPi) + 0.5F);
    if (x > 0.5F * kPi) x = kPi - x;
    if (x < -0.5F * kPi) x = -kPi - x;
    const float s = x * x;
    return x *
           (1.0F -
            s / 6.0F *
                (1.0F - s / 20.0F * (1.0F - s / 42.0F * (1.0F - s / 72.0F * (1.0F - s / 110.0F)))));
}

float cosine(float angleRad) {
    return sine(angleRad + 0.5F * kPi);
}

float Primitive::distance(const glm::vec3& pointWorld) const {
    const glm::vec3 p = (pointWorld - centre) * axes;  // components along the axes
    switch (kind) {
        case Kind::Ellipsoid: {
            // A bound: exact on the surface, too small by the ratio of the radii elsewhere.
            const float smallest = std::min({size.x, size.y, size.z});
            return (glm::length(p / size) - 1.0F) * smallest;
        }
        case Kind::Capsule: {
            const float along = std::clamp(glm::dot(p, span) * inverseSquaredSpan, 0.0F, 1.0F);
            const float around = radius + along * (endRadius - radius);
            return (glm::length(p - along * span) - around) * inverseSlope;
        }
        case Kind::Box: {
            const glm::vec3 q = glm::abs(p) - size + radius;
            return glm::length(glm::max(q, 0.0F)) + std::min(std::max({q.x, q.y, q.z}), 0.0F) -
                   radius;
        }
        case Kind::Torus: {
            const float ring = std::sqrt(p.x * p.x + p.z * p.z) - size.x;
            return std::sqrt(ring * ring + p.y * p.y) - size.y;
        }
        case Kind::Custom:
            break;
    }
    return field(p);
}

Primitive Primitive::pointing(const glm::vec3& direction) const {
    const glm::vec3 y = direction / glm::length(direction);
    const glm::vec3 helper = std::abs(y.z) < 0.9F ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    glm::vec3 x = glm::cross(y, helper);
    x /= glm::length(x);
    Primitive turned = *this;
    turned.axes = glm::mat3(x, y, glm::cross(x, y));
    return turned;
}

Primitive ellipsoid(const glm::vec3& centre, const glm::vec3& radii) {
    return {.kind = Primitive::Kind::Ellipsoid, .centre = centre, .size = radii};
}

Primitive ball(const glm::vec3& centre, float radius) {
    return ellipsoid(centre, glm::vec3(radius));
}

Primitive capsule(const glm::vec3& a, const glm::vec3& b, float radiusA, float radiusB) {
    const glm::vec3 span = b - a;
    const float inverseSquaredSpan = 1.0F / glm::dot(span, span);
    const float taper = radiusB - radiusA;
    return {.kind = Primitive::Kind::Capsule,
            .centre = a,
            .span = span,
            .inverseSquaredSpan = inverseSquaredSpan,
            .radius = radiusA,
            .endRadius = radiusB,
            .inverseSlope = 1.0F / std::sqrt(1.0F + taper * taper * inverseSquaredSpan)};
}

Primitive box(const glm::vec3& centre, const glm::vec3& halfSides, float rounding) {
    return {.kind = Primitive::Kind::Box, .centre = centre, .size = halfSides, .radius = rounding};
}

Primitive torus(const glm::vec3& centre, float radius, float tubeRadius) {
    return {.kind = Primitive::Kind::Torus,
            .centre = centre,
            .size = glm::vec3(radius, tubeRadius, 0.0F)};
}

Primitive custom(Field field) {
    return {.kind = Primitive::Kind::Custom, .field = field};
}

float Relief::at(const glm::vec3& point) const {
    switch (kind) {
        case Kind::Bumps:
            return height * std::clamp(1.5F * noise(point * frequency, seed), -1.0F, 1.0F);
        case Kind::Grooves: {
            // Narrow folds along the zero set of the noise, which winds like the furrows of a
            // brain.
            const float value = noise(point * frequency, seed) * 3.5F;
            const float inside = 1.0F - std::min(value * value, 1.0F);
            return height * inside * inside;
        }
        case Kind::None:
            break;
    }
    return 0.0F;
}

Shape& Shape::add(Primitive part, float blend) {
    part.blend = blend;
    parts_.push_back(part);
    return *this;
}

Shape& Shape::cut(Primitive part, float blend) {
    part.isCut = true;
    return add(part, blend);
}

Shape& Shape::addPair(const Primitive& part, float blend) {
    Primitive mirrored = part;
    mirrored.centre.x = -mirrored.centre.x;
    mirrored.span.x = -mirrored.span.x;
    // The mirror image of a solid that is symmetric in its own x: conjugation by the reflection.
    const glm::mat3 reflection(-1, 0, 0, 0, 1, 0, 0, 0, 1);
    mirrored.axes = reflection * mirrored.axes * reflection;
    return add(part, blend).add(mirrored, blend);
}

Shape& Shape::setRelief(const Relief& relief) {
    relief_ = relief;
    return *this;
}

float Shape::distance(const glm::vec3& point) const {
    float distance = std::numeric_limits<float>::infinity();
    for (const Primitive& part : parts_) {
        const float d = part.distance(point);
        distance = part.isCut ? -smoothMinimum(-distance, d, part.blend)
                              : smoothMinimum(distance, d, part.blend);
    }
    // Farther away relief cannot reach the surface.
    if (std::abs(distance) <= relief_.height) distance += relief_.at(point);
    return distance;
}

glm::vec3 Shape::gradient(const glm::vec3& point, float here, float step) const {
    return glm::vec3(distance(point + glm::vec3(step, 0, 0)) - here,
                     distance(point + glm::vec3(0, step, 0)) - here,
                     distance(point + glm::vec3(0, 0, step)) - here) /
           step;
}

bool Shape::restrictTo(const glm::vec3& centre, float radius, Shape& near) const {
    near.parts_.clear();
    near.relief_ = relief_;
    const float reach = radius * 1.001F + 1e-6F;  // room for rounding
    constexpr float kFar = std::numeric_limits<float>::infinity();
    Range range{kFar, kFar};
    for (const Primitive& part : parts_) {
        const float d = part.distance(centre);
        if (part.isCut) {
            // max(range, −d): matters only where −d comes within the blend of what is there.
            if (reach - d + part.blend < range.low) continue;
            const Range opposite =
                joined({-range.high, -range.low}, {d - reach, d + reach}, part.blend);
            range = {-opposite.high, -opposite.low};
        } else {
            if (d - reach > range.high + part.blend) continue;
            if (d + reach + part.blend < range.low) near.parts_.clear();
            range = joined(range, {d - reach, d + reach}, part.blend);
        }
        near.parts_.push_back(part);
    }
    return range.low - relief_.height <= 0.0F && range.high + relief_.height >= 0.0F;
}

}  // namespace gfxrepro::scene::sdf
