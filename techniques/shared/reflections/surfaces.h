// What reflections see of a scene: objects with their surfaces, shaded the same way by every
// method, on the device (shaders/shading.glsl) and here.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "runner/image/image.h"
#include "runner/scene/scene.h"

namespace gfxrepro::reflections {

/// Which materials reflect, and how. A material reflects when its roughness is at most
/// `maxRoughness`; its reflectivity s is then its metalness, but at least what its index of
/// refraction reflects head-on; its glossiness g is its roughness, 0 a mirror. Both count as the
/// G-buffer keeps them, in 255ths; s of 0 does not reflect.
struct ReflectorRule {
    float maxRoughness = 0.4F;
    /// The smooth parts of an object are reflectors (and Objects) of their own; see
    /// reflector_parts.h.
    bool splitsParts = false;
};

/// At most so many lights of a scene are taken; where it has none, one hangs under the top of its
/// box.
constexpr int kMaxLights = 4;

/// What is seen where nothing is.
constexpr glm::vec3 kBackground(0.18F, 0.20F, 0.24F);

/// One instance of the scene, or a part of it. Its triangles are firstTriangle … + triangleCount −
/// 1 of scene::flattened(scene).
struct Object {
    std::uint32_t firstTriangle = 0;
    std::uint32_t triangleCount = 0;
    scene::Box boundsMesh;      // of its vertices, in mesh space
    glm::vec3 baseColor{0.8F};  // linear, times texture and vertex colour
    glm::vec3 emissive{0.0F};   // linear
    int textureLayer = -1;      // into ReflectiveScene::textureLayers(); -1: none
    int reflector = 0;          // 1 … reflectorCount(); 0: diffuse
    int wholeReflector = 0;     // 1 … wholeReflectorCount(): the object that it is a part of
    bool isConcave = false;     // a part that is, seen from where its normals point
    float reflectivity = 0.0F;  // s of [xie2017] Algorithm 6
    float glossiness = 0.0F;    // g of [xie2017] Algorithm 6
    bool isPlanar = false;      // reflectors: all normals the same, to 1e-3, and all vertices in
                                // one plane, to 1e-3 of the diagonal of boundsMesh
};

/// Vertices and triangles of all objects, in mesh space, in the order of scene::flattened(). Every
/// array is full: white where a mesh has no colours, (0, 0) where it has no texture coordinates,
/// area-weighted normals where it has none or where they are not finite or zero. Triangles wind as
/// in their mesh, also those of mirrored instances.
struct ObjectGeometry {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec3> colors;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> objectOfTriangle;
};

/// A scene prepared for reflections. Objects whose material lets light through (transmission above
/// one half) are left out, and counted: nothing here refracts.
class ReflectiveScene {
  public:
    /// Texture layers are squares of this size; images are resampled to it (box filter).
    static constexpr int kLayerSizePx = 512;

    /// Throws Error for a scene without triangles, UnsupportedError for more reflectors than the
    /// G-buffer numbers (65535).
    explicit ReflectiveScene(const scene::Scene& scene, const ReflectorRule& rule = {});

    /// Without what was left out; its instances are the objects, in order.
    const scene::Scene& scene() const { return scene_; }
    std::span<const Object> objects() const { return objects_; }
    const ObjectGeometry& geometry() const { return geometry_; }
    const std::vector<image::Image8>& textureLayers() const {
        return textureLayers_;
    }  // RGBA, sRGB
    std::span<const scene::PointLight> lights() const { return lights_; }
    int reflectorCount() const { return reflectorCount_; }
    int wholeReflectorCount() const { return wholeReflectorCount_; }  // objects, not their parts
    /// Throws Error where reflectorCount() is 0: for methods that measure reflectors only.
    void requireReflectors() const;
    int transmissiveCount() const { return transmissiveCount_; }  // objects left out
    /// Vertices of reflectors whose normals were missing, not finite or zero.
    int repairedNormalCount() const { return repairedNormalCount_; }
    const scene::Box& boundsWorld() const { return boundsWorld_; }  // rest pose
    float diagonalM() const;

    /// Overrides every reflector's glossiness, 0 to 1; before GpuObjects are made of the scene.
    void setGlossiness(float glossiness);

    /// Albedo at a point of a triangle: base colour · texture (bilinear, level 0) · vertex colour.
    /// `barycentric` weighs vertices 1 and 2.
    glm::vec3 albedoAt(std::uint32_t triangle, const glm::vec2& barycentric) const;
    /// The interpolated normal in mesh space, not of unit length.
    glm::vec3 normalMeshAt(std::uint32_t triangle, const glm::vec2& barycentric) const;

  private:
    void addObject(const scene::Instance& instance, std::vector<int>& layerOfTexture);
    void addGeometry(const scene::Mesh& mesh, Object& object);
    glm::vec3 texelsAt(int layer, const glm::vec2& texcoord) const;

    scene::Scene scene_;
    ReflectorRule rule_;
    std::vector<Object> objects_;
    ObjectGeometry geometry_;
    std::vector<image::Image8> textureLayers_;
    std::array<float, 256> srgbDecoding_;
    std::vector<scene::PointLight> lights_;
    scene::Box boundsWorld_;
    int reflectorCount_ = 0, wholeReflectorCount_ = 0, transmissiveCount_ = 0,
        repairedNormalCount_ = 0;
};

/// Light that leaves a diffuse surface, without shadows, clamped to [0, 1]:
///
///     albedo · (0.30 + 0.10·N.y + Σ intensity · max(N·L, 0) / (1 + (d / radius)²)) + emissive
///
/// `normalWorld` is of unit length and turned to the viewer. It does not depend on the viewer
/// otherwise, so that a surface looks the same directly and in every mirror.
glm::vec3 shadeDiffuse(std::span<const scene::PointLight> lights, const glm::vec3& positionWorld,
                       const glm::vec3& normalWorld, const glm::vec3& albedo,
                       const glm::vec3& emissive);

}  // namespace gfxrepro::reflections
