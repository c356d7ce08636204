// Meshes and scenes on the device: the only place that knows both scene/ and gl/.
#pragma once

#include <span>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "engine/image/image.h"
#include "engine/scene/scene.h"

namespace gfxrepro::gpu_scene {

/// Attribute locations, the same in every technique's shaders.
enum Attribute : unsigned { kPosition = 0, kNormal = 1, kTexcoord = 2, kColor = 3 };

/// The locations as defines for shaders: `layout(location = kPosition) in vec3 …`.
gl::Defines attributeDefines();

/// A mesh's vertex buffers (tightly packed floats, one buffer an attribute) and indices. An
/// attribute that the mesh does not have is an empty buffer and disabled in the vertex array.
struct GpuMesh {
    gl::VertexArray vertexArray;
    gl::Buffer positions, normals, texcoords, colors, indices;
    int triangleCount = 0;

    /// Throws std::bad_alloc when the device's memory does not hold it.
    explicit GpuMesh(const scene::Mesh& mesh);
    /// Draws triangles [first, first + count) with the current program; gl_PrimitiveID counts from
    /// 0 at `first`.
    void draw(int first, int count) const;
    void draw() const { draw(0, triangleCount); }
};

/// The rasterized look at a scene, by the formula of raycast::renderPreview, vertex colours
/// included: one sample at each pixel's centre, 3 linear channels, rows from the top. Points are
/// not drawn. `shaders` holds gpu_scene/preview.*.glsl. Throws Error for shaders, UnsupportedError
/// for sizes beyond limits.
image::ImageF renderPreview(const scene::Scene& scene, const scene::Camera& camera, int width,
                            int height, const gl::ShaderLibrary& shaders);

}  // namespace gfxrepro::gpu_scene
