// The preprocess's result on disk, mapped into memory by later runs.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "techniques/point_splatting/compressed_point.h"
#include "techniques/point_splatting/linear_tree.h"

namespace gfxrepro::point_splatting {

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
    const scene::Box& bounds() const;

    bool wasBuilt() const { return wasBuilt_; }  // by openOrBuild(), else found

  private:
    struct Content;
    explicit ModelFile(std::unique_ptr<Content> content, bool wasBuilt);
    std::unique_ptr<Content> content_;
    bool wasBuilt_ = false;
};

}  // namespace gfxrepro::point_splatting
