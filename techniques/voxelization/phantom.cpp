#include "techniques/voxelization/phantom.h"

#include <algorithm>
#include <cmath>

#include "engine/core/random.h"

namespace gfxrepro::voxelization {

namespace {

// All positions in the cube [-1, 1]³.
constexpr glm::vec3 kCavityCentre{0.0F, 0.22F, -0.06F};
constexpr glm::vec3 kCavityRadii{0.47F, 0.50F, 0.60F};
constexpr glm::vec3 kHeadMin{-0.64F, -1.0F, -0.79F};  // ear, neck, occiput
constexpr glm::vec3 kHeadMax{0.64F, 0.85F, 0.73F};    // ear, crown, nose
constexpr float kBoneThickness = 0.05F;
constexpr float kSkinThickness = 0.035F;

// Densities; volume_transparent.frag.glsl tells tissues apart by them.
constexpr float kSkin = 0.22F;
constexpr float kSoft = 0.34F;
constexpr float kFluid = 0.46F;
constexpr float kBrain = 0.55F;
constexpr float kEye = 0.50F;
constexpr float kBone = 0.85F;

/// Approximate signed distance, negative inside.
float ellipsoid(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii) {
    const glm::vec3 q = (p - centre) / radii;
    const float k = glm::length(q);
    const float gradient = glm::length(q / radii);
    return gradient > 0.0F ? k * (k - 1.0F) / gradient : -std::min({radii.x, radii.y, radii.z});
}

float capsule(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, float radius) {
    const float t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0F, 1.0F);
    return glm::distance(p, a + t * (b - a)) - radius;
}

/// Union with a fillet of about `width`.
float blended(float a, float b, float width) {
    const float h = std::max(width - std::abs(a - b), 0.0F) / width;
    return std::min(a, b) - 0.25F * h * h * width;
}

/// Distance to the head's outer surface.
float skinDistance(const glm::vec3& p) {
    const glm::vec3 q(std::abs(p.x), p.y, p.z);  // both sides alike
    const glm::vec3 skullRadii = kCavityRadii + kBoneThickness + kSkinThickness + 0.02F;
    float d = ellipsoid(q, kCavityCentre, skullRadii);
    d = blended(d, ellipsoid(q, {0, -0.27F, 0.22F}, {0.36F, 0.42F, 0.36F}), 0.20F);    // face
    d = blended(d, ellipsoid(q, {0, -0.56F, 0.40F}, {0.17F, 0.12F, 0.15F}), 0.14F);    // chin
    d = blended(d, capsule(q, {0, -1.3F, -0.18F}, {0, -0.4F, -0.12F}, 0.29F), 0.16F);  // neck
    d = blended(d, capsule(q, {0, -0.02F, 0.55F}, {0, -0.19F, 0.66F}, 0.05F), 0.08F);  // nose
    d = blended(d, ellipsoid(q, {0.045F, -0.21F, 0.61F}, {0.06F, 0.04F, 0.06F}), 0.05F);
    d = blended(d, capsule(q, {0.05F, -0.345F, 0.56F}, {0.09F, -0.345F, 0.53F}, 0.03F),
                0.06F);  // lips
    d = blended(d, capsule(q, {0.1F, 0.09F, 0.545F}, {0.26F, 0.085F, 0.47F}, 0.05F),
                0.08F);                                                                  // brows
    d = blended(d, ellipsoid(q, {0.27F, -0.14F, 0.42F}, {0.10F, 0.08F, 0.10F}), 0.10F);  // cheeks
    const float socket = ellipsoid(q, {0.185F, 0.0F, 0.57F}, {0.10F, 0.06F, 0.09F});
    d = -blended(-d, socket, 0.07F);
    d = blended(d, ellipsoid(q, {0.18F, 0.0F, 0.46F}, {0.085F, 0.07F, 0.085F}), 0.03F);  // lids
    const float ear = std::max(ellipsoid(q, {0.56F, -0.06F, -0.07F}, {0.06F, 0.17F, 0.11F}),
                               -ellipsoid(q, {0.63F, -0.05F, -0.04F}, {0.05F, 0.10F, 0.06F}));
    return blended(d, ear, 0.03F);
}

/// Distance to the bone's outer surface: the skull's dome and a jaw.
float boneDistance(const glm::vec3& p) {
    const glm::vec3 q(std::abs(p.x), p.y, p.z);
    float d = ellipsoid(q, kCavityCentre, kCavityRadii + kBoneThickness);
    d = blended(d, ellipsoid(q, {0, -0.16F, 0.28F}, {0.27F, 0.24F, 0.24F}), 0.08F);  // upper jaw
    d = blended(d, capsule(q, {0.30F, -0.30F, 0.0F}, {0.10F, -0.54F, 0.38F}, 0.05F), 0.03F);
    d = std::max(d, -ellipsoid(q, {0.18F, 0.0F, 0.46F}, {0.12F, 0.11F, 0.22F}));   // orbits
    return std::max(d, -ellipsoid(q, {0, -0.14F, 0.50F}, {0.06F, 0.10F, 0.20F}));  // nose
}

float densityAt(const glm::vec3& p) {
    const float skin = skinDistance(p);
    if (skin > 0.0F) return 0.0F;
    const glm::vec3 q(std::abs(p.x), p.y, p.z);
    const float cavity = ellipsoid(p, kCavityCentre, kCavityRadii);
    if (cavity < 0.0F) {
        if (cavity > -0.025F) return kFluid;
        const float ventricles = ellipsoid(q, {0.07F, 0.24F, -0.05F}, {0.04F, 0.09F, 0.20F});
        const float fissure = q.x - 0.01F;
        return ventricles < 0.0F || fissure < 0.0F ? kFluid : kBrain;
    }
    if (ellipsoid(q, {0.18F, 0.0F, 0.46F}, glm::vec3(0.08F)) < 0.0F) return kEye;
    if (boneDistance(p) < 0.0F) return kBone;
    return skin > -kSkinThickness ? kSkin : kSoft;
}

/// A value of the sample grid, the border's beyond it.
float sampleOf(const std::vector<float>& values, int n, glm::ivec3 at) {
    at = glm::clamp(at, glm::ivec3(0), glm::ivec3(n - 1));
    return values[(static_cast<std::size_t>(at.z) * static_cast<std::size_t>(n) +
                   static_cast<std::size_t>(at.y)) *
                      static_cast<std::size_t>(n) +
                  static_cast<std::size_t>(at.x)];
}

glm::vec3 descentAt(const std::vector<float>& values, int n, const glm::ivec3& at) {
    glm::vec3 descent(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        descent[axis] = sampleOf(values, n, at - step) - sampleOf(values, n, at + step);
    }
    const float length = glm::length(descent);
    return length > 0.02F ? descent / length : glm::vec3(0.0F);
}

std::uint8_t toByte(float value) {
    return static_cast<std::uint8_t>(glm::clamp(value, 0.0F, 1.0F) * 255.0F + 0.5F);
}

/// One pass of a tent filter along each axis: a scanner's point spread, and no steps at borders.
void smooth(std::vector<float>& values, int n) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float> before = values;
        glm::ivec3 step(0);
        step[axis] = 1;
        std::size_t i = 0;
        for (int z = 0; z < n; ++z) {
            for (int y = 0; y < n; ++y) {
                for (int x = 0; x < n; ++x, ++i) {
                    const glm::ivec3 at(x, y, z);
                    values[i] = 0.5F * before[i] + 0.25F * sampleOf(before, n, at - step) +
                                0.25F * sampleOf(before, n, at + step);
                }
            }
        }
    }
}

}  // namespace

std::vector<float> headDensities(int resolution, std::uint64_t seed) {
    constexpr float kNoise = 0.02F;
    const auto n = static_cast<std::size_t>(resolution);
    std::vector<float> values;
    values.reserve(n * n * n);
    for (int z = 0; z < resolution; ++z) {
        for (int y = 0; y < resolution; ++y) {
            for (int x = 0; x < resolution; ++x) {
                const glm::vec3 p =
                    (glm::vec3(x, y, z) + 0.5F) * (2.0F / static_cast<float>(resolution)) - 1.0F;
                values.push_back(densityAt(p));
            }
        }
    }
    smooth(values, resolution);
    Random random(seed);
    for (float& value : values) {
        value = glm::clamp(value + random.uniform(-kNoise, kNoise), 0.0F, 1.0F);
    }
    return values;
}

gl::Texture makeHeadTexture(int resolution, std::uint64_t seed) {
    const std::vector<float> densities = headDensities(resolution, seed);
    std::vector<float> forNormals = densities;
    smooth(forNormals, resolution);
    std::vector<std::uint8_t> texels;
    texels.reserve(4 * densities.size());
    std::size_t i = 0;
    for (int z = 0; z < resolution; ++z) {
        for (int y = 0; y < resolution; ++y) {
            for (int x = 0; x < resolution; ++x, ++i) {
                const glm::vec3 descent = descentAt(forNormals, resolution, {x, y, z});
                for (int axis = 0; axis < 3; ++axis)
                    texels.push_back(toByte(descent[axis] * 0.5F + 0.5F));
                texels.push_back(toByte(densities[i]));
            }
        }
    }
    gl::Texture head = gl::Texture::make3D(GL_RGBA8, glm::ivec3(resolution));
    head.upload(GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    head.setFilter(GL_LINEAR, GL_LINEAR);
    head.setWrap(GL_CLAMP_TO_EDGE);
    return head;
}

scene::Box headBoxAround(const scene::Box& brain) {
    // A skull is a little wider than its brain.
    constexpr float kFit = 0.94F;
    const glm::vec3 scale = 0.5F * brain.size() / (kFit * kCavityRadii);
    const float half = std::max({scale.x, scale.y, scale.z});
    const glm::vec3 centre = brain.centre() - half * kCavityCentre;
    return {centre - half, centre + half};
}

scene::Box headBounds(const scene::Box& cube) {
    const glm::vec3 half = 0.5F * cube.size();
    return {cube.centre() + half * kHeadMin, cube.centre() + half * kHeadMax};
}

}  // namespace gfxrepro::voxelization
