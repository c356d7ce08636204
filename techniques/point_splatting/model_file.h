// The preprocess's result on disk, mapped into memory by later runs.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "techniques/point_splatting/compressed_point.h"
#include "techniques/point_splatting/linear_tree.h"

namespace gfxrepro::point_splatting {

/// Views into a mapped file (or into memory, where nothing is cached); valid while it lives.
class ModelFile {
  public:
    /// Opens `folder`/<key>.points, or builds and writes it (to a temporary name, then renamed: two
    /// processes may do so at once). `key` is a hash of the content and the settings; a file that
    /// is cut off, of another version or of another key is built again. An unwritable folder:
    /// kept in memory, with a warning.
    static ModelFile openOrBuild(const std::filesystem::path& folder, const std::string& key,
                                 const scene::PointCloud& points, const TreeSettings& settings);
    ~ModelFile();
    ModelFile(ModelFile&&) noexcept;
    ModelFile& operator=(ModelFile&&) noexcept;

    std::span<const Patch> patches() const;
    std::span<const Level> levels() const;
    std::span<const CompressedPoint> compressed() const;
    std::span<const glm::vec3> positions() const;
    std::span<const glm::vec3> normals() const;
    std::span<const float> radii() const;
    std::span<const glm::u8vec4> colors() const;  // empty: none
    const RadiusTable& radiusTable() const;
    const scene::Box& bounds() const;
    bool wasBuilt() const;  // this time

  private:
    struct Impl;
    explicit ModelFile(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// The key of points with settings: a digest of both and of the file's version.
std::string modelKey(const scene::PointCloud& points, const TreeSettings& settings);

}  // namespace gfxrepro::point_splatting
