// A ReflectiveScene on the device: one set of vertex buffers, a record an object.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "techniques/reflections/surfaces.h"

namespace gfxrepro::reflections {

/// Attribute location of the object's index: an instanced unsigned integer, so that one draw names
/// its object by base instance, and a multi-draw gives each its own.
constexpr unsigned kObjectIndexAttribute = 4;
/// Of the columns of worldFromMesh and of normalFromMesh, an instance each, too: draw() and
/// drawAll() have them, so that no vertex looks its object up.
constexpr unsigned kMatrixAttribute = 5;

/// Defines of gpu_scene::attributeDefines() and of the attributes above.
gl::Defines objectDefines();
/// Those, and what shading.glsl asks of the scene.
gl::Defines surfaceDefines(const ReflectiveScene& scene);

/// Whether objects have moved since it was last asked; the first time they have.
class PoseWatch {
  public:
    bool hasChanged(std::span<const glm::mat4> poses) {
        if (poses_ && std::ranges::equal(poses, *poses_)) return false;
        poses_.emplace(poses.begin(), poses.end());
        return true;
    }

  private:
    std::optional<std::vector<glm::mat4>> poses_;
};

class GpuObjects {
  public:
    /// `splitsDraws`: of a software device, which keeps every triangle of a draw until it is
    /// flushed.
    explicit GpuObjects(const ReflectiveScene& scene, bool splitsDraws = false);

    /// Puts the objects where they are now: one matrix an object, worldFromMesh.
    void setPoses(std::span<const glm::mat4> poses);

    /// Objects, lights and textures for passes that include objects.glsl and shading.glsl: base
    /// colours and emission, sRGB, and roughness, metalness and normals, linear.
    gl::Resources resources() const;
    /// In their order, without those whose box is wholly outside of one plane of the frustum.
    std::vector<std::uint32_t> within(const glm::mat4& clipFromWorld) const;
    /// Draws objects in their order with the program in use, in pieces of mostTrianglesPerDraw().
    /// Culling, depth test and target are the caller's.
    void draw(std::span<const std::uint32_t> objects) const;
    void drawAll() const;

    const ReflectiveScene& scene() const { return *scene_; }
    std::uint32_t objectCount() const { return objectCount_; }
    std::uint32_t triangleCount() const { return triangleCount_; }
    std::uint32_t mostTrianglesPerDraw() const;
    std::span<const glm::mat4> poses() const { return poses_; }
    std::span<const scene::Box> boundsWorld() const { return boundsWorld_; }  // in the present pose

    // For building acceleration structures on the device: tightly packed floats and 32-bit indices,
    // the object of each triangle, and the objects' records (objects.glsl).
    const gl::Buffer& positions() const { return positions_; }
    const gl::Buffer& normals() const { return normals_; }
    const gl::Buffer& texcoords() const { return texcoords_; }
    const gl::Buffer& colors() const { return colors_; }
    const gl::Buffer& indices() const { return indices_; }
    const gl::Buffer& objectOfTriangle() const { return objectOfTriangle_; }
    const gl::Buffer& records() const { return records_; }

  private:
    const ReflectiveScene* scene_;  // outlives this
    gl::Buffer positions_, normals_, texcoords_, colors_, indices_, objectOfTriangle_;
    gl::Buffer records_, lights_, objectIndices_;
    gl::Texture textureLayers_, valueLayers_;
    gl::VertexArray vertexArray_;
    std::vector<glm::mat4> poses_;
    std::vector<scene::Box> boundsWorld_;
    std::uint32_t objectCount_ = 0, triangleCount_ = 0;
    bool splitsDraws_;
};

}  // namespace gfxrepro::reflections
