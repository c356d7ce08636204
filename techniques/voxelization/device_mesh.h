// The mesh under voxelization on the device, in the form that a rule needs.
#pragma once

#include <array>

#include "engine/gl/pass.h"
#include "techniques/voxelization/axis_split.h"
#include "techniques/voxelization/grid_source.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// Which voxels a triangle fills.
enum class Rule {
    Rasterized,    // the thesis's: what the hardware rasterizer samples along the dominant axis
    Thin,          // 6-separating
    Conservative,  // every voxel whose closed cube meets the triangle
};

/// How synthesis reads the sheets of x and y; the grids are equal bit by bit.
enum class Merging {
    PerVoxel,    // a fetch per voxel. [zju2005] Sec. 2.3.2 (3)
    Transposed,  // tiles of C³ voxels, a fetch per texel
    Sparse,      // as Transposed, and only tiles that hold fragments; surfaces only
};

/// How the worksheet method finds the bits of a voxel.
enum class Addressing {
    Instructions,  // shifts and masks
    Tables,        // dependent look-ups. [zju2005] Sec. 2.3.2; synthesis per voxel, one sheet
};

/// What flips the inside flag along a scan line of a solid.
enum class FillRule {
    Crossings,      // each exact crossing of the surface; two of three axes decide
    SurfaceVoxels,  // each voxel that the hardware samples; any axis decides. [zju2005] Sec. 2.2.3
};

/// A mesh and how it is to become voxels. `mesh` must outlive what is made of this.
struct MeshRequest {
    const scene::Mesh& mesh;
    scene::Box box;  // cubic, world space
    GridSettings settings;
    Rule rule = Rule::Rasterized;
    Merging merging = Merging::Transposed;
    Addressing addressing = Addressing::Instructions;
    FillRule fillRule = FillRule::Crossings;

    bool isSolid() const { return settings.fill == Fill::Solid; }
    /// Decided on the lattice, not by the hardware.
    bool isExact() const { return isSolid() ? fillsByCrossings() : rule != Rule::Rasterized; }
    bool fillsByCrossings() const { return isSolid() && fillRule == FillRule::Crossings; }
    /// Every triangle is drawn along every axis, not only along its dominant one.
    bool drawsAllAxes() const { return rule == Rule::Thin || isSolid(); }
    /// The largest value of a voxel wins (its bits are not simply OR-ed).
    bool hasValues() const { return settings.value != VoxelValue::Occupancy; }
};

struct DeviceMesh {
    gl::Buffer positions;   // world space, or lattice units when the request is exact
    gl::Buffer attributes;  // normals or colours; one element when voxels say occupancy only
    gl::Buffer triangles;   // in the order of the split
    gl::VertexArray vertexArray;
    std::array<TriangleRange, 3> ranges;

    /// Throws UnsupportedError for what does not fit a storage block of `limits`.
    DeviceMesh(const MeshRequest& request, const AxisSplit& split, const gl::DeviceLimits& limits);
    /// Replaces the indices: the dynamic index buffer of [zju2005] Sec. 2.3.1.
    void update(const AxisSplit& split);
    TriangleRange allTriangles() const { return {0, ranges[2].first + ranges[2].count}; }
    /// For the exact rules' passes; the others have the vertex array.
    gl::Resources resources() const;
    /// Draws these triangles with the program in use, in pieces: the memory that a software device
    /// takes for a draw then does not grow with the mesh.
    void drawIndexed(TriangleRange range) const;
    std::size_t sizeBytes() const;
};

}  // namespace gfxrepro::voxelization
