// Meshes from depth images: [xie2017] Algorithm 4 (hybrid) and the classic four-neighbour mesh.
#pragma once

#include <cstdint>

#include "engine/gl/device.h"
#include "engine/gl/pass.h"
#include "engine/scene/scene.h"
#include "techniques/kit/depth_image.h"
#include "techniques/kit/prefix_sum.h"

namespace gfxrepro::soft_shadows {

enum class Reconstruction {
    Hybrid,   // a quad per sample, corners from the offset image H or from the sample's plane
    Classic,  // two triangles between four neighbouring samples, none across a discontinuity
};

struct ReconstructionSettings {
    Reconstruction method = Reconstruction::Hybrid;
    /// A corner (hybrid) or neighbour (classic) belongs to a sample when its depth differs from the
    /// depth of the sample's plane there by at most this many pixel footprints (the width of a
    /// pixel at the sample's depth). The thesis gives no threshold. Of ½ … 16, 4 to 8 gave the
    /// fewest wrong pixels in depth maps of the meshes, seen from between their images.
    float discontinuityPx = 4.0F;
    /// A plane-fitted corner lies at most this many footprints nearer or farther than its sample:
    /// bounds grazing planes, which the thesis does not discuss. A plane that slants by up to twice
    /// as many footprints a pixel is met as it is; beyond, corners at outlines would stand out as
    /// spikes. Of ½ … 16, 1 to 4 gave the fewest wrong pixels.
    float grazingLimitPx = 2.0F;
    /// Beyond the thesis, hybrid only: samples side by side in a row whose quads lie within one
    /// triangle become one quad of the same plane. What it no longer uses of the vertices stays.
    bool mergesRows = false;
};

/// A vertex of a reconstructed mesh.
struct CornerVertex {
    std::uint16_t xHalfPx = 0;  // pixel coordinates of the image, doubled
    std::uint16_t yHalfPx = 0;
    float depthM = 0.0F;  // distance along the view axis
};
static_assert(sizeof(CornerVertex) == 8);

/// A reconstructed mesh on the device: CornerVertex a vertex, 32-bit indices, two triangles a quad:
/// c₀c₁c₂, c₂c₃c₀, counter-clockwise seen from the eye. Order of vertices and triangles follows the
/// image's rows.
struct ReconstructedMesh {
    kit::View view;
    gl::Buffer vertices;
    gl::Buffer indices;
    std::uint32_t vertexCount = 0;
    std::uint32_t triangleCount = 0;
    std::uint32_t sampleCount = 0;  // samples of the image

    std::size_t sizeBytes() const;
};

/// Takes (x·d, y·d, d, 1) of a CornerVertex (x, y in half pixels, d its depth) into the world.
glm::mat4 worldFromCorner(const kit::View& view);

/// Rebuilds a mesh from depth image I and, for the hybrid method, its offset image H: the same
/// view, moved by half a pixel to the lower left (viewOf with offset (−½, −½)), so that H's pixel
/// (x, y) is the lower left corner of I's pixel (x, y); corners beyond H's last row and column are
/// missing. `triangleNormals` holds the unit normal of every triangle of the scene (vec4 each, by
/// id − 1): n of Algorithm 4 is the normal of the sample's triangle.
class Reconstructor {
  public:
    Reconstructor(const gl::ShaderLibrary& shaders, const ReconstructionSettings& settings);

    /// Waits for the device once, for the counts. Throws UnsupportedError for meshes beyond the
    /// limit of a storage block, std::bad_alloc.
    ReconstructedMesh reconstruct(const kit::DepthImage& image, const kit::DepthImage* offsetImage,
                                  const gl::Buffer& triangleNormals);

  private:
    void resizeScratch(glm::ivec2 imageSizePx);
    void setGeometry(const gl::Program& program, const kit::View& view) const;
    /// Vertices, triangles and samples of the mesh.
    glm::uvec4 countElements(const kit::View& view, const gl::Resources& images);
    void emit(const ReconstructedMesh& mesh, const gl::Resources& images);

    ReconstructionSettings settings_;
    gl::Pass classify_, count_;
    kit::PrefixSum scan_;
    gl::Pass emit_;

    // A texel a corner, where up to four pixels meet: (width + 1) × (height + 1).
    glm::ivec2 cornersSize_{0};
    int runsPerRow_ = 0;
    gl::Texture flags_;   // R16UI, what classify_ decided
    gl::Texture places_;  // R32UI, places of the corner's vertices and triangles in its run
    gl::Buffer runs_;     // uvec4 a run of corners: counts, then places; behind them the totals
};

/// The normals that Reconstructor takes. Throws UnsupportedError where they are beyond the limit of
/// a storage block.
gl::Buffer triangleNormals(const scene::Mesh& flattened, const gl::DeviceLimits& limits);

/// The mesh in world space, read back: for simplification.
scene::Mesh toWorldMesh(const ReconstructedMesh& mesh);

}  // namespace gfxrepro::soft_shadows
