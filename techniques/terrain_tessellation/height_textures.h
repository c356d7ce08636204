// The terrain on the device: heights as one texture, and the bounds that the control stage reads.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "runner/gl/objects.h"

namespace gfxrepro::terrain_tessellation {

/// A regular grid of heights in the plane y = 0: sample (i, j) lies at
/// (originWorld.x + i·spacingM, height, originWorld.y + j·spacingM). Row by row, i fastest.
struct HeightGrid {
    std::span<const float> heightsM;
    glm::ivec2 size{0};  // samples
    float spacingM = 1.0F;
    glm::vec2 originWorld{0.0F};  // x and z of sample (0, 0)
};

/// h_min, h_max and ε_max of a block or of one of its edges, in metres. [zhang2012] Sec. 2.1
struct HeightBounds {
    float minM = 0.0F, maxM = 0.0F, errorM = 0.0F, unused = 0.0F;
};
static_assert(sizeof(HeightBounds) == 16);

/// One level of the quadtree; level 0 is the finest. n × n blocks, row by row; n × (n + 1) edges
/// along x (edge [z·n + x] is the side of block (x, z) with the smaller z), then (n + 1) × n edges
/// along z (edge [z·(n + 1) + x] is its side with the smaller x).
struct LevelBounds {
    int blocksPerSide = 0;  // n
    std::vector<HeightBounds> blocks, edgesAlongX, edgesAlongZ;
};

enum class HeightFormat {
    Float32,  // exact
    Unorm16,  // half the memory; steps of (highest − lowest) / 65535
};

class DeviceTerrain {
  public:
    /// `levels` from the finest on. Throws UnsupportedError beyond the device's texture size, Error
    /// for grids and bounds whose sizes do not fit together.
    DeviceTerrain(const HeightGrid& grid, std::span<const LevelBounds> levels,
                  HeightFormat format = HeightFormat::Float32);

    const gl::Texture& heights() const { return heights_; }
    const gl::Buffer& levelTable() const { return levelTable_; }
    const gl::Buffer& bounds() const { return bounds_; }
    /// A texel t is the height x + y·t.
    glm::vec2 heightOfTexel() const { return heightOfTexel_; }
    glm::ivec2 size() const { return {heights_.size().x, heights_.size().y}; }
    float spacingM() const { return spacingM_; }
    glm::vec2 originWorld() const { return originWorld_; }
    float lowestM() const { return lowestM_; }
    float highestM() const { return highestM_; }
    std::span<const LevelBounds> levels() const { return levels_; }  // as given
    std::size_t sizeBytes() const;

  private:
    gl::Texture heights_;
    gl::Buffer levelTable_, bounds_;
    std::vector<LevelBounds> levels_;
    glm::vec2 heightOfTexel_{0.0F, 1.0F}, originWorld_{0.0F};
    float spacingM_ = 1.0F, lowestM_ = 0.0F, highestM_ = 0.0F;
};

}  // namespace gfxrepro::terrain_tessellation
