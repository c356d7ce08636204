// The terrain on the device: heights as one texture, and the bounds that the control stage reads.
#pragma once

#include <glm/glm.hpp>

#include "runner/gl/objects.h"
#include "techniques/terrain_tessellation/terrain_metadata.h"

namespace gfxrepro::terrain_tessellation {

enum class HeightFormat {
    Float32,  // exact
    Unorm16,  // half the memory; steps of (highest − lowest) / 65535
};

/// The map must be the one that the metadata was built from; it is not kept, `metadata` must
/// outlive this.
class DeviceTerrain {
  public:
    /// Throws UnsupportedError beyond the device's texture or buffer size, Error for a map whose
    /// size is not the metadata's.
    DeviceTerrain(const scene::HeightMap& map, const TerrainMetadata& metadata,
                  HeightFormat format = HeightFormat::Float32);

    const TerrainMetadata& metadata() const { return *metadata_; }
    const gl::Texture& heights() const { return heights_; }
    const gl::Buffer& blocks() const { return blocks_; }
    const gl::Buffer& firstBlocks() const { return firstBlocks_; }  // by level
    /// A texel t is the height x + y·t.
    glm::vec2 heightOfTexel() const { return heightOfTexel_; }
    float lowestM() const { return lowestM_; }
    float highestM() const { return highestM_; }
    std::size_t sizeBytes() const;

  private:
    const TerrainMetadata* metadata_;
    gl::Texture heights_;
    gl::Buffer blocks_, firstBlocks_;
    glm::vec2 heightOfTexel_{0.0F, 1.0F};
    float lowestM_ = 0.0F, highestM_ = 0.0F;
};

}  // namespace gfxrepro::terrain_tessellation
