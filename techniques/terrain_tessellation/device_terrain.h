// The terrain on the device: heights of the tiles in view, which in [zhang2012] have a height
// texture each, and the bounds that the control stage reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/scene/height_map.h"
#include "techniques/terrain_tessellation/terrain_metadata.h"
#include "techniques/terrain_tessellation/tile_selection.h"

namespace gfxrepro::terrain_tessellation {

enum class HeightFormat {
    Float32,  // exact
    Unorm16,  // half the memory; steps of (highest − lowest) / 65535
};

struct HeightPageSettings {
    HeightFormat format = HeightFormat::Float32;
    std::size_t budgetBytes = std::size_t{256} << 20;
};

/// A page is a layer of a texture array: every 2^level-th sample of a tile of that level, one more
/// to the west and north, two more beyond the eastern and southern rim. That is what normals at the
/// rim reach, so that neighbours agree there. Beyond the map the border's heights go on.
class HeightPages {
  public:
    /// Texel (i, j) is the sample at origin + (i − 1, j − 1) · 2^level.
    static constexpr int kBorder = 1, kMoreTexels = 4;

    /// `map` must outlive it. `tileCount`: how many there are at all, no more pages are made.
    /// Throws Error where the budget holds no page.
    HeightPages(const scene::HeightMap& map, const HeightPageSettings& settings,
                glm::vec2 heightOfTexel, int tileSegments, int tileCount);

    int capacity() const { return texture_.size().z; }
    /// The layers of at most capacity() tiles; those that are not there are loaded, in the place of
    /// those that were asked for longest ago.
    std::vector<int> load(std::span<const Tile> tiles);
    /// Since the beginning.
    std::uint64_t loadedCount() const { return loadedCount_; }
    const gl::Texture& texture() const { return texture_; }

  private:
    using Key = std::tuple<int, int, int>;  // level, origin

    int leastRecentlyUsed() const;
    void fill(int layer, const Tile& tile);

    const scene::HeightMap* map_;
    HeightFormat format_;
    glm::vec2 heightOfTexel_;
    gl::Texture texture_;
    std::map<Key, int> layers_;
    std::vector<Key> keys_;               // by layer
    std::vector<std::uint64_t> lastUse_;  // by layer, in calls of load(); 0: empty
    std::uint64_t clock_ = 0, loadedCount_ = 0;
};

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
