// Meshes from depth images: [xie2017] Algorithm 4 (hybrid) and the classic four-neighbour mesh.
#pragma once

#include <cstdint>
#include <span>

#include "runner/gl/device.h"
#include "runner/gl/program.h"
#include "runner/scene/scene.h"
#include "techniques/shared/depth_image.h"

namespace gfxrepro::soft_shadows {

enum class Reconstruction {
    Hybrid,   // a quad a sample, corners from the offset image H or from the sample's plane
    Classic,  // two triangles between four neighbouring samples, none across a discontinuity
};

struct ReconstructionSettings {
    Reconstruction method = Reconstruction::Hybrid;
    /// A corner (hybrid) or neighbour (classic) belongs to a sample when its depth differs from the
    /// depth of the sample's plane there by at most this many pixel footprints (the width of a
    /// pixel at the sample's depth). The thesis gives no threshold.
    float discontinuityPx = 4.0F;
    /// A plane-fitted corner lies at most this many footprints nearer or farther than its sample:
    /// bounds grazing planes, which the thesis does not discuss.
    float grazingLimitPx = 8.0F;
};

/// A reconstructed mesh on the device. A vertex is 8 bytes: a corner in the image's pixel
/// coordinates (x and y as 16-bit unsigned, in half pixels) and its depth along the view axis
/// (float); `worldFromCorner` of the view turns it into a point. Indices are 32-bit, two triangles
/// a quad: c₀c₁c₂, c₂c₃c₀. Order of vertices and triangles follows the image's rows.
struct ReconstructedMesh {
    depth_images::View view;
    gl::Buffer vertices;
    gl::Buffer indices;
    std::uint32_t vertexCount = 0;
    std::uint32_t triangleCount = 0;
    std::uint32_t sampleCount = 0;    // samples of the image
    std::uint32_t sharedCorners = 0;  // corners taken from H (hybrid)
    std::uint32_t fittedCorners = 0;  // corners from planes (hybrid)

    std::size_t sizeBytes() const;
};

/// Rebuilds a mesh from depth image I and, for the hybrid method, its offset image H: the same
/// view, moved by half a pixel to the lower left (viewOf with offset (−½, −½)), so that H's pixel
/// (x, y) is the lower left corner of I's pixel (x, y); corners beyond H's last row and column are
/// missing. `triangleNormals` holds the unit normal of every triangle of the scene (vec4 each, by
/// id − 1): n of Algorithm 4 is the normal of the sample's triangle.
class Reconstructor {
  public:
    Reconstructor(const gl::ShaderLibrary& shaders, const ReconstructionSettings& settings);
    ReconstructedMesh reconstruct(const depth_images::DepthImage& image,
                                  const depth_images::DepthImage* offsetImage,
                                  const gl::Buffer& triangleNormals);

  private:
    ReconstructionSettings settings_;
    gl::Program classify_, scan_, emit_;
};

/// The normals that Reconstructor takes. Throws UnsupportedError where they are beyond the limit of
/// a storage block.
gl::Buffer triangleNormals(const scene::Mesh& flattened, const gl::DeviceLimits& limits);

/// The mesh in world space, read back: for PLY files and for simplification.
scene::Mesh toWorldMesh(const ReconstructedMesh& mesh);

}  // namespace gfxrepro::soft_shadows
