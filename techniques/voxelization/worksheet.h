// The worksheet: a voxel grid held in 2D textures, C voxels a texel. [zju2005] Sec. 2.2.1, 2.2.2.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "engine/scene/scene.h"
#include "runner/technique/technique.h"
#include "techniques/voxelization/grid_shape.h"

namespace gfxrepro::voxelization {

/// A direction of projection and packing.
enum class Axis { X = 0, Y = 1, Z = 2 };
inline constexpr Axis kAxes[] = {Axis::X, Axis::Y, Axis::Z};

/// Local coordinates (u, v, w) of an axis, w along it: x: (y, z, x), y: (z, x, y), z: (x, y, z).
template <class Vector>
Vector localFromVolume(Axis axis, const Vector& p) {
    switch (axis) {
        case Axis::X:
            return {p.y, p.z, p.x};
        case Axis::Y:
            return {p.z, p.x, p.y};
        case Axis::Z:
            break;
    }
    return p;
}
template <class Vector>
Vector volumeFromLocal(Axis axis, const Vector& local) {
    switch (axis) {
        case Axis::X:
            return {local.z, local.x, local.y};
        case Axis::Y:
            return {local.y, local.z, local.x};
        case Axis::Z:
            break;
    }
    return local;
}

/// How L × M × N voxels of b bits lie in R32UI sheets. A texel packs C = 32 / b voxels along w; a
/// slab of C slices is a patch of L × M texels; patches tile a sheet row by row; what does not fit
/// a sheet of 2048² texels (the thesis's) takes further sheets, layers of one array texture.
/// Capacity: L · M · N = W · H · layers · C, where C divides N and the patches fill their sheets;
/// else bits beyond the last slice, and whole patches, stay 0.
class WorksheetLayout {
  public:
    static constexpr int kMaxSheetSizePx = 2048;

    WorksheetLayout() = default;
    /// Asserts 1, 8, 16 or 32 bits.
    WorksheetLayout(const GridShape& shape, int voxelBits);

    const GridShape& shape() const { return shape_; }
    int voxelBits() const { return voxelBits_; }            // b
    int voxelsPerTexel() const { return 32 / voxelBits_; }  // C
    int slabCount() const { return (shape_.size.z + voxelsPerTexel() - 1) / voxelsPerTexel(); }
    int patchesPerSheet() const { return patchesX_ * patchesY_; }
    int layers() const { return (slabCount() + patchesPerSheet() - 1) / patchesPerSheet(); }
    glm::ivec2 sheetSizePx() const {
        return glm::ivec2(patchesX_, patchesY_) * glm::ivec2(shape_.size);
    }
    std::size_t wordCount() const;
    std::size_t sizeBytes() const { return wordCount() * sizeof(std::uint32_t); }
    std::uint32_t laneMask() const { return voxelBits_ == 32 ? ~0U : (1U << voxelBits_) - 1U; }

    /// Texel (x, y, layer) of the voxel at `local` = (u, v, w).
    glm::ivec3 texel(const glm::ivec3& local) const;
    /// Position of the voxel's lowest bit in its texel.
    int shift(int w) const { return w % voxelsPerTexel() * voxelBits_; }
    /// Index of that texel in a whole read-back, layer after layer, rows in the order of y.
    std::size_t wordIndex(const glm::ivec3& local) const;

    /// Of the directional sheet of an axis: the same voxels in its local coordinates.
    WorksheetLayout ofAxis(Axis axis) const;

    /// SIZE, SHEET, VOXEL_BITS, VOXELS_PER_TEXEL, LANE_MASK for worksheet.glsl.
    gl::Defines defines() const;
    /// SHEET alone.
    std::string sheetDefine() const;

    bool operator==(const WorksheetLayout&) const = default;

  private:
    GridShape shape_ = 32;
    int voxelBits_ = 1;
    int patchesX_ = 1;
    int patchesY_ = 1;
};

/// A grid on the CPU: one value a voxel, packed as in a worksheet of the z layout.
class DenseGrid {
  public:
    DenseGrid() = default;
    explicit DenseGrid(const WorksheetLayout& layout);
    /// Asserts layout.wordCount() words.
    DenseGrid(const WorksheetLayout& layout, std::vector<std::uint32_t> words);

    const WorksheetLayout& layout() const { return layout_; }
    const GridShape& shape() const { return layout_.shape(); }
    std::span<const std::uint32_t> words() const { return words_; }

    std::uint32_t value(const glm::ivec3& voxel) const;
    bool isFull(const glm::ivec3& voxel) const { return value(voxel) != 0; }
    void set(const glm::ivec3& voxel, std::uint32_t value);
    /// Number of voxels whose value is not 0.
    std::size_t countFull() const;

    bool operator==(const DenseGrid&) const = default;

  private:
    WorksheetLayout layout_;
    std::vector<std::uint32_t> words_ = std::vector<std::uint32_t>(layout_.wordCount());
};

/// An R32UI 2D array texture of the layout's size, all bits 0.
gl::Texture makeSheets(const WorksheetLayout& layout);

/// The edge of a voxel, by the longest side.
float voxelSizeOf(const scene::Box& box, const GridShape& shape);

/// What reads a bit of a byte: texel (s, t) is bit t of the byte s. [zju2005] Sec. 2.3.2 (1).
gl::Texture makeBitTable();

/// A voxel grid on the device, in the z layout. Voxel (0, 0, 0) lies at box.min.
struct VoxelGrid {
    gl::Texture sheets;
    WorksheetLayout layout;
    scene::Box box;  // of the layout's shape, world space

    float voxelSize() const { return voxelSizeOf(box, layout.shape()); }
    /// Waits for the device.
    DenseGrid read() const;
};

/// The sheets' words as wordIndex() counts them; waits for the device.
std::vector<std::uint32_t> readSheets(const gl::Texture& sheets);

/// Throws UnsupportedError, with the numbers, when the sheets do not fit the device.
void checkFitsDevice(const WorksheetLayout& layout, const gl::DeviceLimits& limits);

/// About the centre of `bounds`, with `paddingVoxels` free voxels, of those along the shape's
/// longest side, at both ends of the longest side of `bounds`, which has a length.
scene::Box gridBox(const scene::Box& bounds, const GridShape& shape, int paddingVoxels);

/// Which shape a grid has.
enum class Extent {
    Cube,
    Box,  // L × M × N: as many voxels as reach from end to end, and the padding
};

/// What a voxel's value says.
enum class VoxelValue { Occupancy, Normal };
enum class Fill { Surface, Solid };

/// What every source has to know of the grid that is asked for.
struct GridSettings {
    WorksheetLayout layout;  // of Extent::Box the cube's until fitTo()
    VoxelValue value = VoxelValue::Occupancy;
    Fill fill = Fill::Surface;
    Extent extent = Extent::Cube;

    /// Extent::Box takes the shape of what has these bounds; a cube stays as it is.
    void fitTo(const scene::Box& bounds, int paddingVoxels);
};

/// Life: setup → render, repeatedly → grid, record.
class GridSource {
  public:
    virtual ~GridSource() = default;
    virtual void setup(technique::SetupContext& context) = 0;
    /// Makes the grid anew, each stage in a scope of the profiler.
    virtual void render(gl::Profiler& profiler) = 0;
    /// The grid of the last render; null when the method under measurement makes none.
    virtual const VoxelGrid* grid() const = 0;
    /// Metrics of the source's own (the grid's are the technique's). Throws Error when the last
    /// render failed.
    virtual void record(technique::Recorder& /*recorder*/) {}
    /// Of a solid by crossings: the scan lines that end inside, as its mesh is not closed.
    virtual std::uint32_t openScanLines() const { return 0; }
};

}  // namespace gfxrepro::voxelization
