// The terrain on the device: heights of the tiles in view, and the bounds that the control stage
// reads.
#pragma once

#include <glm/glm.hpp>

#include "engine/gl/pass.h"
#include "techniques/terrain_tessellation/height_pages.h"
#include "techniques/terrain_tessellation/terrain_metadata.h"

namespace gfxrepro::terrain_tessellation {

/// The map must be the one that the metadata was built from; both must outlive this.
class DeviceTerrain {
  public:
    /// Throws UnsupportedError beyond the device's texture or buffer size, Error for a map whose
    /// size is not the metadata's or a budget that holds no tile.
    DeviceTerrain(const scene::HeightMap& map, const TerrainMetadata& metadata,
                  const HeightPageSettings& settings = {});

    const TerrainMetadata& metadata() const { return *metadata_; }
    HeightPages& pages() { return pages_; }
    const HeightPages& pages() const { return pages_; }
    /// Of terrain.glsl and factors.glsl.
    gl::Resources resources() const;
    /// A texel t is the height x + y·t.
    glm::vec2 heightOfTexel() const { return heightOfTexel_; }
    float lowestM() const { return lowestM_; }
    float highestM() const { return highestM_; }
    std::size_t sizeBytes() const;

  private:
    const TerrainMetadata* metadata_;
    float lowestM_, highestM_;
    glm::vec2 heightOfTexel_;
    HeightPages pages_;
    gl::Buffer blocks_;
    gl::Buffer firstBlocks_;  // by level
};

}  // namespace gfxrepro::terrain_tessellation
