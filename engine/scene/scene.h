// Scenes: triangle meshes with materials and instances, points, cameras. Right-handed, y up, metres
// unless a file says otherwise.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/height_map.h"

namespace gfxrepro::scene {

/// Axis-aligned box; empty until something is added.
struct Box {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    bool isEmpty() const { return min.x > max.x; }
    void add(const glm::vec3& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void add(const Box& box) {
        min = glm::min(min, box.min);
        max = glm::max(max, box.max);
    }
    glm::vec3 centre() const { return 0.5F * (min + max); }
    glm::vec3 size() const { return isEmpty() ? glm::vec3(0) : max - min; }
    /// 0 … 7: bits 0, 1 and 2 take the larger x, y and z.
    glm::vec3 corner(int index) const {
        return {index & 1 ? max.x : min.x, index & 2 ? max.y : min.y, index & 4 ? max.z : min.z};
    }
};

/// Triangles over shared vertices, counter-clockwise seen from outside. Attributes are empty or one
/// a vertex.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;    // unit length
    std::vector<glm::vec2> texcoords;  // glTF convention: v grows downwards
    std::vector<glm::vec3> colors;     // linear
    std::vector<glm::uvec3> triangles;
    int material = -1;  // into Scene::materials; -1: default grey
    bool isFlat =
        false;  // without normals, because triangles have their own: glTF 2.0 Sec. 3.7.2.1

    Box bounds() const;
    /// What the arrays hold.
    std::size_t sizeBytes() const;
};

/// Metallic-roughness, as glTF 2.0 defines it.
struct Material {
    std::string name;
    glm::vec4 baseColor{0.8F, 0.8F, 0.8F, 1.0F};  // linear
    float metallic = 0.0F;
    float roughness = 1.0F;
    glm::vec3 emissive{0.0F};
    // Into Scene::textures; −1: none. All read the mesh's one set of coordinates.
    int baseColorTexture = -1;          // sRGB, a factor of baseColor
    int metallicRoughnessTexture = -1;  // linear: G is a factor of roughness, B of metallic
    int normalTexture = -1;             // linear, tangent space: x along u, y against v
    float normalScale = 1.0F;           // of its x and y
    int emissiveTexture = -1;           // sRGB, a factor of emissive
    float alphaCutoff = 0.0F;           // 0: opaque
    bool isDoubleSided = false;
    bool isUnlit = false;
    float transmission = 0.0F;
    float indexOfRefraction = 1.5F;

    bool operator==(const Material&) const = default;
};

/// How a texture is read beyond 0 … 1 and between its texels.
struct Sampling {
    enum class Wrap { Repeat, Mirror, Clamp };
    Wrap u = Wrap::Repeat;
    Wrap v = Wrap::Repeat;
    bool isNearest = false;  // magnified: the nearest texel, not between them

    bool operator==(const Sampling&) const = default;
};

/// A mesh put into the world.
struct Instance {
    int mesh = 0;
    glm::mat4 worldFromMesh{1.0F};
};

/// Surface samples. Attributes are empty or one a point.
struct PointCloud {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<float> radii;
    std::vector<glm::vec3> colors;  // linear
    Mesh surface = {};  // that they were taken of, in world space (surfaceOf()); empty: not known
    Box whole = {};     // of the surface or the cloud that they were taken of; empty: their own

    Box bounds() const;  // of the positions
    /// What a camera frames: the same, however many points were taken.
    Box framed() const { return whole.isEmpty() ? bounds() : whole; }
};

/// A perspective camera that looks along −z of its own frame.
struct Camera {
    std::string name;
    glm::vec3 position{0.0F};
    glm::vec3 target{0.0F, 0.0F, -1.0F};
    glm::vec3 up{0.0F, 1.0F, 0.0F};
    float verticalFovRad = 0.7F;
    float nearM = 0.01F;
    float farM = 1000.0F;
};

/// A camera's way through key frames, from the first to the last.
struct CameraPath {
    std::string name;
    std::vector<Camera> keys;  // at least one; at equal steps of time
};

/// A light that shines the same in all directions. Its irradiance on a facing surface is
/// intensity / (1 + (distance / radiusM)²): finite everywhere, falling with the square far away.
struct PointLight {
    glm::vec3 position{0.0F};
    glm::vec3 intensity{1.0F};  // linear
    float radiusM = 1.0F;
};

/// Movement of one instance over a path's time 0 … 1: it turns about an axis through a pivot and
/// swings along a line.
struct Motion {
    int instance = 0;
    glm::vec3 pivot{0.0F};  // world, rest pose
    glm::vec3 axis{0.0F, 1.0F, 0.0F};
    float turnRad = 0.0F;     // over the whole time
    glm::vec3 swing{0.0F};    // metres from the rest pose, both ways
    float swingCount = 1.0F;  // full periods over the whole time
};

/// Where a scene came from: what a manifest row and a table row say.
struct Origin {
    enum class Kind { Real, StandIn, Generated };
    Kind kind = Kind::Generated;
    std::string description;  // "dragon/dragon_vrip.ply" or "generator statue, seed 5"
    std::string sha256;       // of the file; empty when generated
};

struct Scene {
    std::string name;
    Origin origin;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<image::Image8> textures;  // 3 or 4 channels; materials say how they are read
    std::vector<Sampling> samplings;      // of the first textures; the others have the default
    std::vector<Instance> instances;
    PointCloud points;
    std::optional<HeightMap> heights;  // terrain, beside which there may be meshes
    std::vector<Camera> cameras;
    std::vector<CameraPath> paths;
    std::vector<PointLight> lights;
    std::vector<Motion> motions;        // at most one an instance
    std::vector<std::string> warnings;  // what the loader left out; for the log
    /// What was subtracted from the file's coordinates, as they lie too far from the origin for
    /// floats. Everything above is relative to it.
    glm::dvec3 offset{0.0};
    /// What the loader opened beside the scene's own file.
    std::vector<std::filesystem::path> filesBeside;

    /// Of everything that is instanced, in world space, of the points and of the terrain.
    Box bounds() const;
    std::size_t triangleCount() const;  // instanced
    std::size_t vertexCount() const;    // instanced
};

/// A mesh's material, a plain one where it names none.
Material materialOf(const Scene& scene, const Mesh& mesh);

Sampling samplingOf(const Scene& scene, int texture);

/// For normals: the inverse transpose times |determinant|, by cofactors, which singular matrices
/// have, too.
glm::mat3 normalMatrix(const glm::mat3& matrix);

glm::vec3 unitOrZero(const glm::vec3& vector);

/// What to subtract from coordinates in this box before they become floats: the middle, in round
/// numbers, along each axis on which the box reaches farther from 0 than 16 of its diagonals and
/// 10 km, or than 4096 diagonals. Up to there a float tells a millimetre and some thousandth of the
/// diagonal, and files that belong together keep their places.
glm::dvec3 offsetOf(const Box& box);

/// All instances as one mesh in world space (attributes that not all have are dropped; normals by
/// the inverse transpose; mirrored instances keep their outside). A single instance with the
/// identity is a plain copy.
Mesh flattened(const Scene& scene);

/// Of a vertex attribute at weights of the triangle's vertices 1 and 2.
template <class T>
T interpolated(const std::vector<T>& values, const glm::uvec3& triangle, const glm::vec2& weights) {
    return values[triangle.x] * (1.0F - weights.x - weights.y) + values[triangle.y] * weights.x +
           values[triangle.z] * weights.y;
}

/// A scene of one mesh with one instance.
Scene sceneOf(Mesh mesh);

/// Area-weighted vertex normals (unit; zero for vertices without area).
std::vector<glm::vec3> vertexNormals(const Mesh& mesh);

/// The mesh with three vertices of its own for each triangle, and its normal (zero without area).
Mesh withTriangleNormals(const Mesh& mesh);

/// A view, three-quarter unless `towardsEye` (not zero) says where from, that holds the whole box
/// at this aspect ratio (width / height).
Camera framingCamera(const Box& box, float aspect, glm::vec3 towardsEye = {0.6F, 0.35F, 1.0F});

/// Two views of a height map: "overview" from the south-east above it, "flight" low over its middle
/// northwards. Their reach covers the whole map.
void addTerrainCameras(Scene& scene);

}  // namespace gfxrepro::scene
