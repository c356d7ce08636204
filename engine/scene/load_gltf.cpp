// glTF 2.0. tinygltf parses the file; what it leaves unchecked (every index, every range, the node
// tree) is checked here and in load_gltf_accessor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <utility>

#include "engine/scene/load.h"
#include "engine/scene/load_gltf_file.h"
#include "engine/scene/load_gltf_material.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene {
namespace {

/// What a glTF mesh became.
struct Parts {
    std::vector<int> meshes;  // into Scene::meshes
    std::vector<PointCloud> clouds;
    Box bounds;
};

std::vector<glm::uvec3> trianglesOf(const std::vector<std::uint32_t>& indices, int mode) {
    std::vector<glm::uvec3> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(indices.size() / 3);
        for (std::size_t i = 2; i < indices.size(); i += 3) {
            triangles.emplace_back(indices[i - 2], indices[i - 1], indices[i]);
        }
        return triangles;
    }
    for (std::size_t i = 2; i < indices.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            triangles.emplace_back(indices[i - 1], indices[i], indices[0]);
        } else {  // every second triangle of a strip is turned round
            triangles.emplace_back(indices[i - 2], indices[i - 1 + i % 2], indices[i - i % 2]);
        }
    }
    return triangles;
}

class SceneBuilder {
  public:
    explicit SceneBuilder(const gltf::File& file) : file_(file), accessors_(file), lights_(file) {}

    Scene build() {
        textureUses_ = gltf::addMaterials(file_, accessors_, scene_);
        for (std::size_t i = 0; i < model().meshes.size(); ++i) parts_.push_back(partsOf(i));
        wasVisited_.assign(model().nodes.size(), false);
        for (const int root : roots()) visit(root);
        if (scene_.triangleCount() == 0 && scene_.points.positions.empty()) {
            fail("no triangles or points in the scene");
        }
        for (const std::size_t camera : unaimed_) aim(scene_.cameras[camera], scene_.bounds());
        lights_.moveTo(scene_);
        return std::move(scene_);
    }

  private:
    const tinygltf::Model& model() const { return file_.model; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(file_.name + ": " + message);
    }

    // ---- meshes

    Parts partsOf(std::size_t meshIndex) {
        const tinygltf::Mesh& from = model().meshes[meshIndex];
        Parts parts;
        for (std::size_t i = 0; i < from.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = from.primitives[i];
            const bool isPoints = primitive.mode == TINYGLTF_MODE_POINTS;
            const bool isTriangles = primitive.mode >= TINYGLTF_MODE_TRIANGLES &&
                                     primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
            // Without positions an extension gives the geometry; lines have no surface.
            if (primitive.attributes.count("POSITION") == 0 || !(isPoints || isTriangles)) continue;
            const std::string where = fmt::format("mesh {} primitive {}", meshIndex, i);
            Mesh mesh = meshOf(primitive, where);
            const Box bounds = mesh.bounds();
            checkReach(glm::mat4(1.0F), bounds, where);
            parts.bounds.add(bounds);
            if (isPoints) {
                parts.clouds.push_back({std::move(mesh.positions),
                                        std::move(mesh.normals),
                                        {},
                                        std::move(mesh.colors)});
                continue;
            }
            mesh.name = from.name;
            mesh.triangles = checkedTriangles(primitive, mesh.positions.size(), where);
            if (mesh.triangles.empty()) continue;
            parts.meshes.push_back(static_cast<int>(scene_.meshes.size()));
            scene_.meshes.push_back(std::move(mesh));
        }
        return parts;
    }

    /// The attributes and the material.
    Mesh meshOf(const tinygltf::Primitive& primitive, const std::string& where) {
        Mesh mesh;
        mesh.material = primitive.material;
        if (mesh.material != -1) {
            gltf::elementOf(scene_.materials, mesh.material, "{}: {}: material {}", file_.name,
                            where, mesh.material);
        }
        mesh.positions = accessors_.vectors<3>(primitive.attributes.at("POSITION"));
        const std::size_t count = mesh.positions.size();
        if (count > std::numeric_limits<std::uint32_t>::max()) {
            fail(fmt::format("{}: {} vertices; at most 4294967295 are allowed", where, count));
        }
        mesh.normals = attribute<3>(primitive, "NORMAL", count, where);
        for (glm::vec3& normal : mesh.normals) normal = unitNormal(normal);
        mesh.colors = attribute<3>(primitive, "COLOR_0", count, where);
        const gltf::TextureUse use =
            mesh.material < 0 ? gltf::TextureUse{} : textureUses_[mesh.material];
        mesh.texcoords =
            attribute<2>(primitive, fmt::format("TEXCOORD_{}", use.texcoordSet), count, where);
        if (use.isTransformed) {
            for (glm::vec2& uv : mesh.texcoords) uv = use.transform * glm::vec3(uv, 1.0F);
        }
        return mesh;
    }

    /// Empty when the primitive does not have it.
    template <int N>
    std::vector<glm::vec<N, float>> attribute(const tinygltf::Primitive& primitive,
                                              const std::string& name, std::size_t count,
                                              const std::string& where) {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return {};
        auto values = accessors_.vectors<N>(found->second, name == "COLOR_0");
        if (values.size() != count) {
            fail(fmt::format("{}: {} values of {} for {} vertices", where, values.size(), name,
                             count));
        }
        return values;
    }

    std::vector<glm::uvec3> checkedTriangles(const tinygltf::Primitive& primitive,
                                             std::size_t vertexCount, const std::string& where) {
        std::vector<std::uint32_t> indices;
        if (primitive.indices >= 0) {
            indices = accessors_.indices(primitive.indices);
        } else {
            indices.resize(vertexCount);
            for (std::size_t i = 0; i < vertexCount; ++i) {
                indices[i] = static_cast<std::uint32_t>(i);
            }
        }
        for (const std::uint32_t index : indices) {
            if (index >= vertexCount) {
                fail(fmt::format("{}: index {} is not one of the {} vertices", where, index,
                                 vertexCount));
            }
        }
        return trianglesOf(indices, primitive.mode);
    }

    // ---- nodes

    /// The default scene's, the first scene's, or, in a file without scenes, all nodes that are
    /// nobody's children.
    std::vector<int> roots() const {
        if (!model().scenes.empty()) {
            const int scene = std::max(model().defaultScene, 0);
            return gltf::elementOf(model().scenes, scene, "{}: scene {}", file_.name, scene).nodes;
        }
        std::vector<bool> isChild(model().nodes.size(), false);
        for (const tinygltf::Node& node : model().nodes) {
            for (const int child : node.children) {
                if (child >= 0 && static_cast<std::size_t>(child) < isChild.size()) {
                    isChild[static_cast<std::size_t>(child)] = true;
                }
            }
        }
        std::vector<int> nodes;
        for (std::size_t i = 0; i < isChild.size(); ++i) {
            if (!isChild[i]) nodes.push_back(static_cast<int>(i));
        }
        return nodes;
    }

    /// The tree below `root`, without recursion: files decide how deep it is.
    void visit(int root) {
        std::vector<std::pair<int, glm::mat4>> open{{root, glm::mat4(1.0F)}};
        while (!open.empty()) {
            const auto [index, worldFromParent] = open.back();
            open.pop_back();
            const tinygltf::Node& node =
                gltf::elementOf(model().nodes, index, "{}: node {}", file_.name, index);
            if (wasVisited_[static_cast<std::size_t>(index)]) {
                fail(fmt::format("node {} has two parents or is its own ancestor", index));
            }
            wasVisited_[static_cast<std::size_t>(index)] = true;
            const glm::mat4 worldFromNode = worldFromParent * localMatrix(node, index);
            checkFinite(worldFromNode, index);
            addContent(node, index, worldFromNode);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                open.emplace_back(*child, worldFromNode);
            }
        }
    }

    void checkFinite(const glm::mat4& matrix, int node) const {
        const float* values = glm::value_ptr(matrix);
        if (!std::all_of(values, values + 16, [](float value) { return std::isfinite(value); })) {
            fail(fmt::format("node {}: the transform is not finite", node));
        }
    }

    /// No corner of the box of a node's or a primitive's coordinates may lie too far away.
    void checkReach(const glm::mat4& matrix, const Box& box, const std::string& where) const {
        for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
            const glm::vec3 at(matrix * glm::vec4(box.corner(corner), 1.0F));
            if (glm::all(glm::lessThanEqual(glm::abs(at), glm::vec3(kMaxCoordinate)))) continue;
            fail(fmt::format("{}: its box reaches to ({}, {}, {}); {:g} to {:g} are allowed", where,
                             at.x, at.y, at.z, -kMaxCoordinate, kMaxCoordinate));
        }
    }

    glm::mat4 localMatrix(const tinygltf::Node& node, int index) const {
        const auto has = [&](const std::vector<double>& values, std::size_t count) {
            if (!values.empty() && values.size() != count) {
                fail(fmt::format("node {}: {} numbers where {} are needed", index, values.size(),
                                 count));
            }
            return !values.empty();
        };
        if (has(node.matrix, 16)) return glm::mat4(glm::make_mat4(node.matrix.data()));
        glm::dmat4 matrix(1.0);
        if (has(node.translation, 3)) {
            matrix[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
        }
        if (has(node.rotation, 4)) {
            const glm::dvec4 xyzw = glm::make_vec4(node.rotation.data());
            matrix *= glm::mat4_cast(glm::dquat(xyzw.w, xyzw.x, xyzw.y, xyzw.z));
        }
        if (has(node.scale, 3)) {
            const glm::dvec3 scale = glm::make_vec3(node.scale.data());
            for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
        }
        return glm::mat4(matrix);
    }

    void addContent(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode) {
        if (node.camera >= 0) addCamera(node, index, worldFromNode);
        lights_.add(node, index, worldFromNode);
        if (node.mesh < 0) return;
        const Parts& parts = gltf::elementOf(parts_, node.mesh, "{}: node {}: mesh {}", file_.name,
                                             index, node.mesh);
        for (const glm::mat4& nodeFromInstance : instanceMatrices(node)) {
            const glm::mat4 worldFromMesh = worldFromNode * nodeFromInstance;
            checkFinite(worldFromMesh, index);
            checkReach(worldFromMesh, parts.bounds, fmt::format("node {}", index));
            accessors_.charge(parts.meshes.size(), sizeof(Instance));
            for (const int mesh : parts.meshes) scene_.instances.push_back({mesh, worldFromMesh});
            for (const PointCloud& cloud : parts.clouds) addPoints(cloud, worldFromMesh);
        }
    }

    /// EXT_mesh_gpu_instancing: one matrix an instance; without it the identity.
    std::vector<glm::mat4> instanceMatrices(const tinygltf::Node& node) {
        const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
        if (extension == node.extensions.end()) return {glm::mat4(1.0F)};
        const tinygltf::Value& attributes = extension->second.Get("attributes");
        const auto accessor = [&](const char* name) {
            return attributes.Has(name) && attributes.Get(name).IsInt()
                       ? attributes.Get(name).Get<int>()
                       : -1;
        };
        std::vector<glm::vec3> translations;
        std::vector<glm::vec4> rotations;
        std::vector<glm::vec3> scales;
        if (const int i = accessor("TRANSLATION"); i >= 0) translations = accessors_.vectors<3>(i);
        if (const int i = accessor("ROTATION"); i >= 0) rotations = accessors_.vectors<4>(i);
        if (const int i = accessor("SCALE"); i >= 0) scales = accessors_.vectors<3>(i);
        const std::size_t count = std::max({translations.size(), rotations.size(), scales.size()});
        for (const std::size_t size : {translations.size(), rotations.size(), scales.size()}) {
            if (size != 0 && size != count) fail("instance attributes differ in their counts");
        }
        accessors_.charge(count, sizeof(glm::mat4));
        std::vector<glm::mat4> matrices(count, glm::mat4(1.0F));
        for (std::size_t i = 0; i < count; ++i) {
            if (!translations.empty()) matrices[i][3] = glm::vec4(translations[i], 1.0F);
            if (!rotations.empty()) {
                const glm::vec4 q = rotations[i];
                matrices[i] *= glm::mat4_cast(glm::normalize(glm::quat(q.w, q.x, q.y, q.z)));
            }
            for (int axis = 0; axis < 3 && !scales.empty(); ++axis) {
                matrices[i][axis] *= scales[i][axis];
            }
        }
        return matrices;
    }

    /// Clouds join; an attribute that not all have is dropped.
    void addPoints(const PointCloud& cloud, const glm::mat4& worldFromCloud) {
        PointCloud& points = scene_.points;
        const bool isFirst = points.positions.empty();
        accessors_.charge(cloud.positions.size(), 3 * sizeof(glm::vec3));
        const bool normals = !cloud.normals.empty() && (isFirst || !points.normals.empty());
        const bool colors = !cloud.colors.empty() && (isFirst || !points.colors.empty());
        for (const glm::vec3& position : cloud.positions) {
            points.positions.emplace_back(worldFromCloud * glm::vec4(position, 1.0F));
        }
        const glm::mat3 toWorld = normalMatrix(glm::mat3(worldFromCloud));
        if (!normals) points.normals.clear();
        if (!colors) points.colors.clear();
        for (std::size_t i = 0; normals && i < cloud.normals.size(); ++i) {
            points.normals.push_back(unitNormal(toWorld * cloud.normals[i]));
        }
        if (colors) {
            points.colors.insert(points.colors.end(), cloud.colors.begin(), cloud.colors.end());
        }
    }

    /// glTF has no target: it lies where the axis passes the middle of the scene most closely, in
    /// front of the eye. One that looks away from the middle keeps its target at 1.
    static void aim(Camera& camera, const Box& box) {
        const glm::vec3 forward = camera.target - camera.position;
        const float distance = glm::dot(0.5F * (box.min + box.max) - camera.position, forward);
        if (distance > camera.nearM) camera.target = camera.position + distance * forward;
    }

    /// Perspective cameras only. Without a far plane, a thousand times the default one.
    void addCamera(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode) {
        const tinygltf::Camera& from = gltf::elementOf(
            model().cameras, node.camera, "{}: node {}: camera {}", file_.name, index, node.camera);
        if (from.type != "perspective") return;
        const tinygltf::PerspectiveCamera& perspective = from.perspective;
        constexpr double kPi = 3.14159265358979323846;
        if (!(perspective.yfov > 0.0 && perspective.yfov < kPi) || !(perspective.znear > 0.0)) {
            fail(fmt::format("camera {}: yfov {} and znear {}; 0 to pi and above 0 are allowed",
                             node.camera, perspective.yfov, perspective.znear));
        }
        Camera camera;
        camera.name = from.name.empty() ? node.name : from.name;
        camera.verticalFovRad = static_cast<float>(perspective.yfov);
        camera.nearM = static_cast<float>(perspective.znear);
        camera.farM = perspective.zfar > perspective.znear ? static_cast<float>(perspective.zfar)
                                                           : std::max(1000.0F, 1e5F * camera.nearM);
        camera.position = glm::vec3(worldFromNode[3]);
        const glm::vec3 forward = -unitNormal(glm::vec3(worldFromNode[2]));
        const double targetM = node.extras.Has(gltf::kTargetM)
                                   ? node.extras.Get(gltf::kTargetM).GetNumberAsDouble()
                                   : 0.0;
        if (!(targetM > 0.0)) unaimed_.push_back(scene_.cameras.size());
        camera.target =
            camera.position + (targetM > 0.0 ? static_cast<float>(targetM) : 1.0F) * forward;
        camera.up = unitNormal(glm::vec3(worldFromNode[1]));
        scene_.cameras.push_back(std::move(camera));
    }

    const gltf::File& file_;
    gltf::Accessors accessors_;
    gltf::Lights lights_;
    std::vector<gltf::TextureUse> textureUses_;
    std::vector<Parts> parts_;
    std::vector<bool> wasVisited_;
    std::vector<std::size_t> unaimed_;  // cameras whose file does not say how far they look
    Scene scene_;
};

}  // namespace

Scene loadGltf(const std::filesystem::path& path) {
    const gltf::File file = gltf::readFile(path);
    return SceneBuilder(file).build();
}

}  // namespace gfxrepro::scene
