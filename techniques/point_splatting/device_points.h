// A model's points on the device, where a frame's drawn points lie in them, and what draws them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/point_splatting/patch_selection.h"
#include "techniques/point_splatting/point_model.h"

namespace gfxrepro::point_splatting {

enum class PointStorage {
    Compressed,    // 8 bytes, decoded in the vertex stage
    Uncompressed,  // 60 bytes
};

/// Points and colours, cut between patches into pieces that a shader storage block may hold.
class DevicePoints {
  public:
    DevicePoints(const ModelFile& model, PointStorage storage);

    /// Of decode_point.glsl.
    gl::Defines defines() const;
    gl::Resources resources(std::uint32_t piece) const;
    bool hasColors() const { return hasColors_; }
    std::size_t sizeBytes() const;

    std::span<const Patch> patches() const { return patches_; }
    std::span<const Level> levels() const { return levels_; }
    std::uint32_t pieceOf(std::uint32_t patch) const { return pieceOfPatch_[patch]; }
    /// A point of the model as the index into its piece's buffers.
    std::uint32_t indexInPiece(std::uint32_t piece, std::uint32_t point) const {
        return point - pieces_[piece].firstPoint;
    }

  private:
    struct Piece {
        std::uint32_t firstPoint = 0, pointCount = 0;
        gl::Buffer points, colors;
    };
    void cutIntoPieces(std::size_t pointBytes);

    PointStorage storage_;
    bool hasColors_;
    std::vector<Patch> patches_;
    std::vector<Level> levels_;
    std::vector<std::uint32_t> pieceOfPatch_;
    std::vector<Piece> pieces_;
    gl::Buffer radii_;
};

/// What a drawn patch's points need of it: attributes of an instance.
struct DrawnRecord {
    glm::vec4 boxMinScale;  // w: the level's radiusScale
    glm::vec4 boxSize;
};

/// Points of one patch, next to each other in a piece.
struct PointRange {
    std::uint32_t first = 0, count = 0;  // in the piece
    std::uint32_t record = 0;
};
/// Ranges drawn with one call: of one mode, in one piece.
struct Batch {
    SplatMode mode = SplatMode::FullEwa;
    std::uint32_t piece = 0;
    std::uint32_t firstRange = 0, rangeCount = 0, pointCount = 0;
};

/// A frame's drawn patches as batches, modes one after another: work per patch, none per point.
struct DrawList {
    std::vector<DrawnRecord> records;
    std::vector<PointRange> ranges;
    std::vector<Batch> batches;

    /// Ranges have at most `maxRange` points, batches begin none beyond `maxBatch`.
    void assign(const DevicePoints& points, std::span<const DrawnPatch> drawn,
                std::uint32_t maxRange, std::uint32_t maxBatch);
};

/// Towards the light.
inline constexpr glm::vec3 kLightDirectionView{0.3F, 0.5F, 0.8F};

/// Draws a model, each method in its way and passes.
class PointRenderer {
  public:
    virtual ~PointRenderer() = default;
    virtual void render(std::span<const DrawnPatch> drawn, const PatchView& view,
                        gl::Profiler& profiler) = 0;
    /// RGBA8, linear; alpha is the coverage.
    virtual const gl::Texture& output() const = 0;
    virtual std::size_t pointBytes() const = 0;   // of what holds the points
    virtual std::size_t targetBytes() const = 0;  // of images
};

/// What a pass needs of the view, set where the program uses it.
void setView(const gl::Program& program, const PatchView& view);

}  // namespace gfxrepro::point_splatting
