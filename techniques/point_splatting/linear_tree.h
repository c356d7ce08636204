// The preprocess of zju2005 chapter 3: a covariance tree over all points, cut into patches, each
// stored breadth-first in one array (Sec. 3.2.2).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "runner/scene/scene.h"

namespace gfxrepro::point_splatting {

struct TreeSettings {
    /// A subtree is a patch when it has at most `maxPatchPoints` points and its normals lie within
    /// `patchConeRad` of their mean (fewer patches where flat, more where curved), or at most
    /// `minPatchPoints` points.
    std::uint32_t maxPatchPoints = 4096;
    std::uint32_t minPatchPoints = 256;
    float patchConeRad = 0.35F;
};

/// One level of a patch's linear binary tree: the first `count` points of the patch stand for all.
/// Departure [zju2005] Sec. 3.2.2: inner nodes are not stored beside the points. The node of a
/// subtree is the point of it that lies nearest to its mean, stored at the shallowest level that it
/// stands for, so levels are prefixes of one array: a point takes its 8 bytes once (the printed
/// tree takes twice that), and the order is progressive.
struct Level {
    std::uint32_t count = 0;
    float minRadius = 0.0F, maxRadius = 0.0F, meanRadius = 0.0F;  // of the discs at this level
    float radiusScale = 1.0F;  // a point's own radius times this covers what it stands for
};

constexpr std::uint32_t kMaxLevels = 24;

struct Patch {
    std::uint32_t firstPoint = 0;
    std::uint32_t pointCount = 0;
    std::uint32_t levelCount = 0;  // the last level has all points
    std::uint32_t firstLevel = 0;  // into PointModel::levels
    scene::Box bounds;             // of the points' centres
    glm::vec3 meanNormal{0.0F, 1.0F, 0.0F};
    float coneRad = 0.0F;    // every normal lies within this of the mean; π: no culling
    float curvature = 0.0F;  // λ₀ / (λ₀ + λ₁ + λ₂) of the positions' covariance
};

/// Points in the order of patches, each breadth-first. Colours are empty where the data has none.
struct PointModel {
    std::vector<glm::vec3> positions, normals;
    std::vector<float> radii;
    std::vector<glm::u8vec4> colors;  // sRGB, linear alpha unused
    std::vector<Patch> patches;
    std::vector<Level> levels;
    scene::Box bounds;
};

/// Splits at the mean along the principal axis (the first median where all points fall to one
/// side), in parallel; the same points give the same bytes. `points` are complete
/// (scene::completePoints). Throws Error for no points.
PointModel buildModel(const scene::PointCloud& points, const TreeSettings& settings);

}  // namespace gfxrepro::point_splatting
