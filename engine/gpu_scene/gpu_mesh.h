// Meshes and scenes on the device: the only place that knows both scene/ and gl/.
#pragma once

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

/// A texture of the scene as gl::Texture::fromImage() makes it of sRGB, read as its Sampling says.
gl::Texture uploadedTexture(const scene::Scene& scene, int texture);

/// A look at a scene: one sample at the centre of each pixel, 3 channels, linear, rows from the
/// top.
///
///     radiance = baseColor.rgb · color · texture(u, v).rgb · (0.15 + 0.85·|N·V|) + emissive
///
/// `color` is the interpolated vertex colour (linear), 1 where the mesh has none. N is the
/// interpolated vertex normal, the triangle's where that is missing or zero; V is the unit
/// direction to the camera (a headlight). The texture is decoded from sRGB texel by texel, filtered
/// bilinearly if its Sampling does not say otherwise, v downwards. Where baseColor.a · texture.a <
/// alphaCutoff what is behind shows. Background: (0.18, 0.20, 0.24). Points are not drawn.
/// `shaders` holds gpu_scene/preview.*.glsl. Throws Error for shaders, UnsupportedError for sizes
/// beyond limits.
image::ImageF renderPreview(const scene::Scene& scene, const scene::Camera& camera, int width,
                            int height, const gl::ShaderLibrary& shaders);

}  // namespace gfxrepro::gpu_scene
