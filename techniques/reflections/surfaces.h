// What reflections see of a scene: objects with their surfaces, shaded the same way by every
// method, on the device (shaders/shading.glsl) and here.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "techniques/reflections/reflectors.h"

namespace gfxrepro::reflections {

/// What the first three channels of a texture are.
enum class TexelKind {
    Colours,  // sRGB
    Values,   // as they are: roughness and metalness, normals
};

/// From the 256 values of a channel to linear ones, 0 to 1.
std::array<float, 256> decodingOf(TexelKind kind);

/// An image (3 or 4 channels) as a square of `sizePx` with 4: each texel is the mean (of colours in
/// linear light) of the part of the image that it covers. The same size stays as it is.
image::Image8 textureLayer(const image::Image8& image, int sizePx,
                           TexelKind kind = TexelKind::Colours);

/// The same at half the width and height: each texel is the mean of four. The image has 4 channels
/// and an even size.
image::Image8 halvedLayer(const image::Image8& layer, TexelKind kind = TexelKind::Colours);

enum class TextureFilter {
    Footprint,    // averaged over what a sample, a texel or a ray covers, by levels half as fine
    FinestLevel,  // as they are
};

/// At most so many lights of a scene are taken, the first, and a warning tells of the others; where
/// it has none, one hangs under the top of its box.
constexpr int kMaxLights = 64;

/// What is seen where nothing is.
constexpr glm::vec3 kBackground(0.18F, 0.20F, 0.24F);

/// One instance of the scene, or a part of it. Its triangles are firstTriangle … + triangleCount −
/// 1 of scene::flattened(scene).
struct Object {
    std::uint32_t firstTriangle = 0;
    std::uint32_t triangleCount = 0;
    scene::Box boundsMesh;            // of its vertices, in mesh space
    glm::vec3 baseColor{0.8F};        // linear, times texture and vertex colour
    glm::vec3 emissive{0.0F};         // linear
    int textureLayer = -1;            // into ReflectiveScene::textureLevels(); -1: none
    int emissiveLayer = -1;           // the same
    int metallicRoughnessLayer = -1;  // into ReflectiveScene::valueLevels(); -1: none
    int normalLayer = -1;             // the same
    float normalScale = 1.0F;
    // Factors of metallicRoughnessLayer, the least s, and the largest roughness that reflects.
    float metallic = 0.0F, roughness = 1.0F, headOnReflectivity = 0.0F, maxRoughness = 0.0F;
    bool hasOneGlossiness = true;  // false: each texel of metallicRoughnessLayer has its own
    int reflector = 0;             // 1 … reflectorCount(); 0: diffuse
    int wholeReflector = 0;        // 1 … wholeReflectorCount(): the object that it is a part of
    bool isConcave = false;        // a part that is, seen from where its normals point
    // Without metallicRoughnessLayer, which says it a texel:
    float reflectivity = 0.0F;  // s of [xie2017] Algorithm 6
    float glossiness = 0.0F;    // g of [xie2017] Algorithm 6
    bool isPlanar = false;      // reflectors: all normals the same, to 1e-3, and all vertices in
                                // one plane, to 1e-3 of the diagonal of boundsMesh; no normal
                                // texture

    bool isTextured() const { return textureLayer >= 0; }
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

/// Textures as layers of an array, in levels: each half as wide as the one before, the last of one
/// texel; the first alone where textures are not filtered. A level holds an image a layer.
using TextureLevels = std::vector<std::vector<image::Image8>>;

/// A scene prepared for reflections. Objects whose material lets light through (transmission above
/// one half) are left out, and a warning says how many: nothing here refracts.
class ReflectiveScene {
  public:
    /// Texture layers are squares, all of an array of one size, a power of two that holds the
    /// largest image; images are resampled to it (box filter). At most kMostLayerSizePx, and less
    /// where an array would take more than kMostLayersBytes, its coarser levels (a third more) not
    /// counted: a warning tells of larger images.
    static constexpr int kLeastLayerSizePx = 512, kMostLayerSizePx = 2048;
    static constexpr std::size_t kMostLayersBytes = std::size_t{1} << 29;

    /// `scene` has triangles. Throws UnsupportedError for more reflectors than the G-buffer numbers
    /// (65535).
    explicit ReflectiveScene(const scene::Scene& scene, const ReflectorRule& rule = {},
                             TextureFilter filter = TextureFilter::Footprint);

    /// Without what was left out; its instances are the objects, in order.
    const scene::Scene& scene() const { return scene_; }
    std::span<const Object> objects() const { return objects_; }
    const ObjectGeometry& geometry() const { return geometry_; }
    TextureFilter textureFilter() const { return filter_; }
    const TextureLevels& textureLevels() const {
        return textureLayers_.levels;
    }  // RGBA, sRGB: base colours and emission
    const TextureLevels& valueLevels() const {
        return valueLayers_.levels;
    }  // RGBA, linear: metallic-roughness and normals
    /// How each layer of the above is read beyond 0 … 1 and where its texels are magnified.
    const std::vector<scene::Sampling>& textureSamplings() const {
        return textureLayers_.samplings;
    }
    const std::vector<scene::Sampling>& valueSamplings() const { return valueLayers_.samplings; }
    /// Whether some object has a texture of roughness and metalness, of normals or of emission.
    bool hasMaterialTextures() const;
    std::span<const scene::PointLight> lights() const { return lights_; }
    int reflectorCount() const { return reflectorCount_; }
    int wholeReflectorCount() const { return wholeReflectorCount_; }  // objects, not their parts
    const scene::Box& boundsWorld() const { return boundsWorld_; }    // rest pose
    float diagonalM() const;

    /// What of the scene is not shown as it is: a line each, of the scene by name.
    const std::vector<std::string>& warnings() const { return warnings_; }
    /// To standard error, which the run's log keeps.
    void printWarnings() const;
    /// There, too, once: that a frame shows no reflector, so that there is nothing to measure.
    void printEmptyView();

    /// Overrides every reflector's glossiness, 0 to 1; before GpuObjects are made of the scene.
    void setGlossiness(float glossiness);

    /// Width in texture coordinates of what a beam covers of a triangle: `beamArea` is its
    /// cross-section there in m², `direction` the beam's, unit (shaders/shading.glsl). 0 where
    /// textures are not filtered.
    float footprintAt(std::uint32_t triangle, const glm::mat4& worldFromMesh,
                      const glm::vec3& direction, float beamArea) const;
    /// Albedo at a point of a triangle: base colour · texture · vertex colour. `barycentric` weighs
    /// vertices 1 and 2; the texture is averaged over `footprint` (bilinear, between two levels).
    glm::vec3 albedoAt(std::uint32_t triangle, const glm::vec2& barycentric,
                       float footprint = 0.0F) const;
    /// Emission at a point of a triangle, as albedoAt() has it.
    glm::vec3 emissiveAt(std::uint32_t triangle, const glm::vec2& barycentric,
                         float footprint = 0.0F) const;
    /// The interpolated normal in mesh space, not of unit length.
    glm::vec3 normalMeshAt(std::uint32_t triangle, const glm::vec2& barycentric) const;
    /// The normal that the object's normal texture gives, as texturedNormal() of
    /// shaders/shading.glsl: unit, in the world, of the side that is seen. `normalWorld` is the
    /// interpolated one, unit, on the mesh's outside.
    glm::vec3 texturedNormalAt(std::uint32_t triangle, const glm::vec2& barycentric,
                               const glm::mat4& worldFromMesh, const glm::vec3& normalWorld,
                               const glm::vec3& toViewer, float footprint = 0.0F) const;

  private:
    /// Textures in the order of their layers.
    struct Layers {
        TexelKind kind;
        std::vector<int> textures = {};  // of the scene
        std::vector<scene::Sampling> samplings = {};
        TextureLevels levels = {{}};
    };

    void addObject(const scene::Instance& instance);
    void addReflection(const scene::Mesh& mesh, const scene::Material& material, Object& object);
    void addGeometry(const scene::Mesh& mesh, Object& object);
    void addLights();
    void fillLayers(Layers& layers);
    void warn(const std::string& what);
    static int layerOf(Layers& layers, int texture);
    static glm::vec3 texelsAt(const Layers& layers, int layer, const glm::vec2& texcoord,
                              float footprint);

    scene::Scene scene_;
    ReflectorRule rule_;
    TextureFilter filter_;
    std::vector<Object> objects_;
    ObjectGeometry geometry_;
    Layers textureLayers_{TexelKind::Colours}, valueLayers_{TexelKind::Values};
    std::vector<std::string> warnings_;
    bool hasWarnedOfEmptyView_ = false;
    std::vector<scene::PointLight> lights_;
    scene::Box boundsWorld_;
    int reflectorCount_ = 0, wholeReflectorCount_ = 0;
};

/// Whether a normal is of the side that is not seen, as isTurnedAway() of shaders/shading.glsl.
inline bool isTurnedAway(const glm::vec3& normal, const glm::vec3& toViewer,
                         const glm::vec3& across) {
    return glm::dot(normal, toViewer) < 0.0F &&
           glm::dot(normal, across) * glm::dot(across, toViewer) <= 0.0F;
}

/// Light that leaves a diffuse surface, without shadows, clamped to [0, 1]:
///
///     albedo · (0.30 + 0.10·N.y + Σ intensity · max(N·L, 0) / (1 + (d / radius)²)) + emissive
///
/// `normalWorld` is of unit length, of the side that is seen. It does not depend on the viewer
/// otherwise, so that a surface looks the same directly and in every mirror.
glm::vec3 shadeDiffuse(std::span<const scene::PointLight> lights, const glm::vec3& positionWorld,
                       const glm::vec3& normalWorld, const glm::vec3& albedo,
                       const glm::vec3& emissive);

}  // namespace gfxrepro::reflections
