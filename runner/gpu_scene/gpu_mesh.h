// Meshes and scenes on the device: the only place that knows both scene/ and gl/.
#pragma once

#include <span>
#include <vector>

#include "runner/gl/objects.h"
#include "runner/gl/program.h"
#include "runner/image/image.h"
#include "runner/scene/scene.h"

namespace gfxrepro::gpu_scene {

/// Attribute locations, the same in every technique's shaders (defines with these names).
enum Attribute : unsigned { kPosition = 0, kNormal = 1, kTexcoord = 2, kColor = 3 };

/// A mesh's vertex buffers (tightly packed floats, one buffer an attribute) and indices.
struct GpuMesh {
    gl::Buffer positions, normals, texcoords, colors, indices;
    gl::VertexArray vertexArray;
    int triangleCount = 0;

    explicit GpuMesh(const scene::Mesh& mesh);
    /// Draws triangles [first, first + count).
    void draw(int first, int count) const;
    void draw() const { draw(0, triangleCount); }
    std::size_t sizeBytes() const;
};

/// The rasterized look at a scene, by the formula of raycast::renderPreview.
image::ImageF renderPreview(const scene::Scene& scene, const scene::Camera& camera, int width,
                            int height, const gl::ShaderLibrary& shaders);

}  // namespace gfxrepro::gpu_scene
