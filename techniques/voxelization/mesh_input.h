// The mesh of a voxelization: from the case's scene, on the exact rules' lattice, split by axis, on
// the device, and drawn.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/gl/pass.h"
#include "engine/scene/scene.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// Throws Error for a scene without triangles, or with all of them at one point.
void requireVoxelizable(const scene::Scene& scene);

/// All triangles of a scene in world space: the scene's own mesh where it is the only one and lies
/// there already, else a copy.
class MeshInput {
  public:
    /// `scene` must outlive this.
    explicit MeshInput(const scene::Scene& scene);
    MeshInput(const MeshInput&) = delete;
    MeshInput& operator=(const MeshInput&) = delete;

    const scene::Mesh& mesh() const { return copy_ ? *copy_ : *original_; }

  private:
    const scene::Mesh* original_ = nullptr;
    std::optional<scene::Mesh> copy_;
};

/// Lattice units a voxel.
inline constexpr int kLatticePerVoxel = 256;
/// Farthest that a vertex may lie from the box's corner, in voxels: keeps products of differences
/// of coordinates below 2⁵³.
inline constexpr int kMaxExtentVoxels = 65536;
/// Widest mesh that 64-bit integers decide: products of three differences of coordinates, six of
/// them, stay below 2⁶³.
inline constexpr int kIntegerExtentVoxels = 4096;

/// A mesh snapped to a lattice of 2⁻⁸ voxels. On it the exact rules (thin, conservative, solid) are
/// decided in integers on the device and in doubles that hold them on the CPU, alike.
/// Positions in lattice units from the box's minimum; voxel (x, y, z) is the closed cube from
/// 256·(x, y, z) to 256·(x + 1, y + 1, z + 1), its centre at +128. `triangles` must outlive it.
struct LatticeMesh {
    std::vector<glm::ivec3> positions;
    std::span<const glm::uvec3> triangles;
};

/// Each vertex at the nearest lattice point. Throws Error for a vertex beyond kMaxExtentVoxels.
LatticeMesh snapped(const scene::Mesh& mesh, const scene::Box& box, const GridShape& shape);

/// 2 / the box's edges, of which the longest is exact.
glm::vec3 clipFromWorldScale(const scene::Box& box, const GridShape& shape);

/// Whether the mesh is wider than kIntegerExtentVoxels, so that doubles decide on the device too.
bool isWide(const scene::Mesh& mesh, const scene::Box& box, const GridShape& shape);

/// Triangles [first, first + count) of the split index buffer.
struct TriangleRange {
    int first = 0;
    int count = 0;
};

/// Preprocess: the index buffer split in three by the axis of largest projected area, [zju2005]
/// Sec. 2.3.1. The triangles in the order x, y, z of their axes; within an axis in the mesh's
/// order.
struct AxisSplit {
    std::vector<glm::uvec3> triangles;
    std::array<TriangleRange, 3> ranges;

    TriangleRange range(Axis axis) const { return ranges[static_cast<std::size_t>(axis)]; }
};

/// The axis on which the triangle's projected area is largest, so that it is never seen edge-on;
/// ties go to z, then y. Triangles without area go to z.
Axis dominantAxis(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Time linear in the triangles; `split` keeps its memory from call to call.
void splitByAxis(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 AxisSplit& split);

/// Which voxels a triangle fills.
enum class Rule {
    Rasterized,    // the thesis's: what the hardware rasterizer samples along the dominant axis
    Thin,          // 6-separating
    Conservative,  // every voxel whose closed cube meets the triangle, and few more
};

/// How the worksheet method, and drawing after it, find the bits of a voxel.
enum class Addressing {
    Instructions,  // shifts and masks
    Tables,        // dependent look-ups. [zju2005] Sec. 2.3.2; one sheet
};

/// What flips the inside flag along a scan line of a solid.
enum class FillRule {
    Crossings,      // each exact crossing of the surface; two of three axes decide
    SurfaceVoxels,  // each voxel that the hardware samples; any axis decides. [zju2005] Sec. 2.2.3
};

enum class Method {
    Worksheet,  // rasterization, texelization, synthesis
    Direct,     // one pass: each voxel is written with an image atomic
    Slices,     // the mesh is drawn once a slice. [zju2005] Sec. 2.5.3
    DepthOnly,  // no grid: a depth-only draw, the yardstick
};

enum class Split { Once, EveryFrame };

struct MeshVoxelizerSettings {
    GridSettings grid;
    Method method = Method::Direct;
    Rule rule = Rule::Thin;
    Split split = Split::Once;
    Addressing addressing = Addressing::Instructions;
    FillRule fillRule = FillRule::Crossings;
};

/// A mesh and how it is to become voxels. `mesh` must outlive what is made of this.
struct MeshRequest {
    const scene::Mesh& mesh;
    scene::Box box;  // of the layout's shape, world space
    MeshVoxelizerSettings settings;

    const WorksheetLayout& layout() const { return settings.grid.layout; }
    bool isSolid() const { return settings.grid.fill == Fill::Solid; }
    /// Decided on the lattice, not by the hardware: Method::Direct.
    bool isExact() const {
        return isSolid() ? settings.fillRule == FillRule::Crossings
                         : settings.rule != Rule::Rasterized;
    }
    /// Of rasterized voxels the largest value stays; exact rules have the mean.
    bool hasValues() const { return settings.grid.value != VoxelValue::Occupancy; }
};

/// The mesh under voxelization on the device, in the form that a rule needs.
struct DeviceMesh {
    gl::Buffer positions;   // world space, or lattice units when the request is exact
    gl::Buffer attributes;  // normals; one element when voxels say occupancy only
    gl::Buffer triangles;   // in the order of the split
    gl::VertexArray vertexArray;
    std::array<TriangleRange, 3> ranges;

    /// Throws UnsupportedError for what does not fit a storage block of `limits`.
    DeviceMesh(const MeshRequest& request, const AxisSplit& split, const gl::DeviceLimits& limits);
    /// Replaces the indices: the dynamic index buffer of [zju2005] Sec. 2.3.1.
    void update(const AxisSplit& split);
    TriangleRange allTriangles() const { return {0, ranges[2].first + ranges[2].count}; }
    /// For the exact rules' passes; draws have the vertex array.
    gl::Resources resources() const;
    /// Draws these triangles with the program in use, in pieces: the memory that a software device
    /// takes for a draw then does not grow with the mesh.
    void drawIndexed(TriangleRange range) const;
    std::size_t sizeBytes() const;
};

/// Where the fragments' voxels go.
enum class DrawTarget {
    FragmentList,  // the blocks Records and Counters
    Grid,          // the z layout, the image `sheet`
    GridSlice,     // as Grid, one slice of the drawn axis at a time
};

/// Draws a mesh along an axis so that its fragments become voxels (Rule::Rasterized): the part that
/// rasterization and the one-pass baselines share.
class MeshDraw {
  public:
    MeshDraw(const gl::ShaderLibrary& shaders, const MeshRequest& request, DrawTarget target);

    /// To be used with what the DrawTarget names, for the draws that follow. Not before each of
    /// them where that stays: llvmpipe finishes what was drawn when an image is bound again.
    const gl::Pass& pass() const { return pass_; }
    /// Draws the triangles of the axis, of solids all, into a framebuffer without attachments, a
    /// pixel a voxel. Slices: the pass's uniform `slice` says which one.
    void draw(const DeviceMesh& mesh, Axis axis) const;

  private:
    gl::Pass pass_;
    gl::Framebuffer framebuffer_;
    GridShape shape_;
    glm::vec3 boxCentreWorld_, clipFromWorldScale_;
    bool drawsAllAxes_;
};

}  // namespace gfxrepro::voxelization
