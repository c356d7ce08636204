// A scene in world space on the device, drawn with triangle ids.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/scene/scene.h"

namespace gfxrepro::kit {

/// Id of triangle t of scene::flattened(scene) is t + 1; 0 stands for "nothing". Throws
/// UnsupportedError when `triangleCount` triangles have more ids than 32 bits hold.
void requireIdsFor(std::uint64_t triangleCount);

/// All instances of a scene, put into the world, in the order of scene::flattened(). Vertices carry
/// position, normal (zero where the mesh has none: the shader takes the triangle's) and colour
/// (the material's base colour times the vertex's). Triangles of materials that are not
/// double-sided are culled from behind; alpha-tested texels (alphaCutoff) are discarded.
class DrawableScene {
  public:
    /// Uploads. Throws UnsupportedError for too many triangles (requireIdsFor), Error for a scene
    /// without triangles, std::bad_alloc when the device's memory does not hold it.
    explicit DrawableScene(const scene::Scene& scene);

    /// Draws everything with `pass` and `resources`. It takes the attributes at
    /// gpu_scene::Attribute (position, normal, texcoord, colour) and, where it has them, the
    /// uniforms `firstTriangle` (uint: gl_PrimitiveID counts from it) and `alphaCutoff` (float) and
    /// the sampler `baseColor`: a part's texture, or white. Sets culling for each part; all other
    /// state is the caller's.
    void draw(const gl::Pass& pass, const gl::Resources& resources) const;
    /// Positions only, without culling or textures: depth passes.
    void drawDepthOnly() const;

    std::uint64_t triangleCount() const { return triangleCount_; }
    /// Whether a part has a texture of base colours.
    bool hasTextures() const { return !textures_.empty(); }
    /// Whether a part may discard texels.
    bool isAlphaTested() const;
    /// Whether a mesh has no vertex normals.
    bool hasFlatParts() const { return hasFlatParts_; }
    const scene::Box& bounds() const { return bounds_; }

  private:
    /// Consecutive triangles that are drawn with one state.
    struct Part {
        std::uint32_t firstTriangle = 0;
        std::uint32_t triangleCount = 0;
        int texture = -1;  // into textures_
        float alphaCutoff = 0.0F;
        bool isDoubleSided = false;
    };
    void addPart(const Part& part);

    std::vector<Part> parts_;
    std::vector<gl::Texture> textures_;
    gl::Texture white_;
    gl::Buffer positions_, normals_, texcoords_, colors_, indices_;
    gl::VertexArray vertexArray_;
    std::uint64_t triangleCount_ = 0;
    bool hasFlatParts_ = false;
    scene::Box bounds_;
};

}  // namespace gfxrepro::kit
