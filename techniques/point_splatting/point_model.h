// The preprocess of zju2005 chapter 3: a covariance tree over all points, cut into patches, each
// stored breadth-first in one array (Sec. 3.2.2); on disk, mapped into memory by later runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "techniques/point_splatting/compressed_point.h"

namespace gfxrepro::point_splatting {

/// When a subtree is a patch: with at most `maxPatchPoints` points whose normals lie within
/// `patchConeRad` of their mean (fewer patches where flat, more where curved), or with at most
/// `minPatchPoints`.
struct TreeSettings {
    std::uint32_t maxPatchPoints = 4096;
    std::uint32_t minPatchPoints = 64;
    float patchConeRad = 0.35F;
};

/// One level of a patch's linear binary tree: the patch's first `count` points stand for all.
struct Level {
    std::uint32_t count = 0;
    float minRadius = 0.0F, maxRadius = 0.0F, meanRadius = 0.0F;  // of this level's discs
    float radiusScale = 1.0F;  // a point's own radius times this covers what it stands for
};

/// Deeper levels are one with the last.
constexpr std::uint32_t kMaxLevels = 24;

/// A subtree. Its nodes lie breadth-first: level by level, each level behind all coarser ones.
struct Patch {
    std::uint32_t firstPoint = 0;
    std::uint32_t pointCount = 0;
    std::uint32_t firstLevel = 0;  // into PointModel::levels
    std::uint32_t levelCount = 0;  // the last level has all points
    scene::Box bounds;             // of the points' centres
    glm::vec3 meanNormal{0.0F, 1.0F, 0.0F};
    float coneRad = 0.0F;  // every normal lies within this of the mean; π: any direction
    float curvature = 0.0F;  // λ₀ / (λ₀ + λ₁ + λ₂) of the positions' covariance, 0 … 1/3
};

/// Points in the order of patches. Colours are empty where the data has none.
///
/// Departure [zju2005] Sec. 3.2.2: a node holds the point of its subtree that is nearest to the
/// subtree's mean, not a point made up for it, and that point goes no further down. So the tree has
/// as many nodes as there are points, a point takes its 8 bytes once (8 bytes a node of the printed
/// tree are 16 a point), and a level is drawn with the coarser ones: a prefix of the array, whose
/// points are all samples of the surface.
struct PointModel {
    std::vector<glm::vec3> positions, normals;
    std::vector<float> radii;
    std::vector<glm::vec3> colors;  // linear
    std::vector<Patch> patches;
    std::vector<Level> levels;
};

/// Splits subtrees through their mean, across the principal axis (in halves where all points fall
/// to one side), in parallel; the same points give the same model. `points` are complete
/// (scene::completePoints). Throws Error for no points.
PointModel buildModel(const scene::PointCloud& points, const TreeSettings& settings);

/// A point model with its compressed points, in a mapped file; spans are valid while it lives.
class ModelFile {
  public:
    /// Maps `folder`/<key>.points, made of `points` first where it is not there, is cut off, or is
    /// another version's (kit::keepFile). Where the folder cannot be written the model stays in
    /// memory. Throws Error for no points.
    static ModelFile openOrBuild(const std::filesystem::path& folder,
                                 const scene::PointCloud& points, const TreeSettings& settings);
    /// In memory only.
    static ModelFile build(const scene::PointCloud& points, const TreeSettings& settings);
    /// A digest of points and settings.
    static std::string keyOf(const scene::PointCloud& points, const TreeSettings& settings);

    ~ModelFile();
    ModelFile(ModelFile&&) noexcept;
    ModelFile& operator=(ModelFile&&) noexcept;

    std::span<const Patch> patches() const;
    std::span<const Level> levels() const;
    std::span<const CompressedPoint> compressed() const;
    std::span<const glm::vec3> positions() const;
    std::span<const glm::vec3> normals() const;
    std::span<const float> radii() const;
    std::span<const glm::u8vec4> colors() const;  // sRGB; empty: the data has none
    std::span<const float> radiusTable() const;

    bool wasBuilt() const { return wasBuilt_; }  // by openOrBuild(), else found

  private:
    struct Content;
    explicit ModelFile(std::unique_ptr<Content> content, bool wasBuilt);
    std::unique_ptr<Content> content_;
    bool wasBuilt_ = false;
};

}  // namespace gfxrepro::point_splatting
