// glTF 2.0. tinygltf parses the file; what it leaves unchecked (every index, every range, the node
// tree) is checked here and in load_gltf_accessor.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "engine/scene/gltf_extras.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_gltf_file.h"
#include "engine/scene/load_gltf_parts.h"
#include "engine/scene/load_text.h"
#include "engine/scene/topology.h"

namespace gfxrepro::scene {
namespace {

/// What a glTF mesh became.
struct Parts {
    std::vector<int> meshes;  // into Scene::meshes
    std::vector<PointCloud> clouds;
    Box bounds;
};

/// Which vertices of an accessor are drawn.
struct PositionUses {
    std::vector<bool> isUsed;
    bool byTriangles = false, byPoints = false;
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
    /// The anchor's offset is subtracted from everything in world space.
    SceneBuilder(const gltf::File& file, Anchor& anchor, LeftOut& leftOut)
        : file_(file),
          anchor_(anchor),
          offset_(anchor.offset),
          isMoved_(offset_ != glm::dvec3(0.0)),
          leftOut_(leftOut),
          accessors_(file),
          lights_(file) {}

    Scene build() {
        textureUses_ = gltf::addMaterials(file_, accessors_, scene_, leftOut_);
        for (const tinygltf::Mesh& mesh : model().meshes) {
            for (const tinygltf::Primitive& primitive : mesh.primitives) {
                for (const auto& [name, accessor] : primitive.attributes) ++readers_[accessor];
            }
        }
        std::vector<bool> isPosed(model().meshes.size(), false);  // by each of its nodes
        for (const tinygltf::Node& node : model().nodes) {
            const bool hasMesh = node.mesh >= 0 && node.mesh < static_cast<int>(isPosed.size());
            if (hasMesh && (node.skin >= 0 || !node.weights.empty())) isPosed[node.mesh] = true;
        }
        for (int i = 0; i < static_cast<int>(isPosed.size()); ++i) {
            if (!isPosed[i]) partsOf({i, -1, model().meshes[i].weights});
        }
        worldFromNode_.resize(model().nodes.size());
        exactFromNode_.resize(model().nodes.size());
        for (const int root : roots()) visit(root);
        for (const int node : drawn_) addContent(model().nodes[node], node, *worldFromNode_[node]);
        if (scene_.triangleCount() == 0 && scene_.points.positions.empty()) {
            fail("no triangles or points in the scene");
        }
        for (const std::size_t camera : unaimed_) aim(scene_.cameras[camera], scene_.bounds());
        lights_.moveTo(scene_);
        if (!model().scenes.empty()) {
            const auto& from = model().scenes[std::max(model().defaultScene, 0)];
            scene_.paths = gltf::pathsIn(from.extras, offset_, leftOut_);
        }
        for (const auto& [accessor, uses] : positionUses_) {
            leftOut_.add(!uses.byPoints     ? "a vertex that no triangle uses"
                         : uses.byTriangles ? "a vertex that no triangle and no point uses"
                                            : "a vertex that no point uses",
                         std::ranges::count(uses.isUsed, false));
        }
        leftOut_.add(
            "a node that is not in the scene",
            std::ranges::count(worldFromNode_, false, &std::optional<glm::mat4>::has_value));
        if (largestColour_ > 1.001F && model().asset.generator != "gfxrepro") {
            scene_.warnings.push_back(fmt::format(
                "vertex colours reach {:g}, above the 1 of glTF; they are taken as they are",
                largestColour_));
        }
        scene_.filesBeside = file_.opened;
        return std::move(scene_);
    }

  private:
    const tinygltf::Model& model() const { return file_.model; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(file_.name + ": " + message);
    }

    // ---- meshes

    /// A mesh as one of its nodes has it: nodes with the same share what it becomes.
    struct PosedMesh {
        int mesh = 0;
        int skin = -1;
        std::vector<double> weights;  // of morph targets

        auto operator<=>(const PosedMesh&) const = default;
    };

    const Parts& partsOf(const PosedMesh& posed) {
        const auto [found, isNew] = parts_.try_emplace(posed);
        Parts& parts = found->second;
        if (!isNew) return parts;
        const tinygltf::Mesh& from = model().meshes[static_cast<std::size_t>(posed.mesh)];
        std::vector<glm::mat4> joints;
        if (posed.skin >= 0) {
            joints = gltf::jointMatrices(file_, accessors_, posed.skin, worldFromNode_);
        }
        for (std::size_t i = 0; i < from.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = from.primitives[i];
            const bool isPoints = primitive.mode == TINYGLTF_MODE_POINTS;
            const bool isTriangles = primitive.mode >= TINYGLTF_MODE_TRIANGLES &&
                                     primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
            // Without positions an extension gives the geometry; lines have no surface.
            if (primitive.attributes.count("POSITION") == 0 || !(isPoints || isTriangles)) {
                leftOut_.add(isPoints || isTriangles ? "a primitive without positions"
                                                     : "a primitive of lines");
                continue;
            }
            const std::string where = fmt::format("mesh {} primitive {}", posed.mesh, i);
            Mesh mesh = meshOf(primitive, posed, joints, where);
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
            if (mesh.triangles.empty()) continue;
            mesh.name = from.name;
            if (gltf::lengthExtra(from.extras, gltf::kSmooth)) mesh.isFlat = false;
            parts.meshes.push_back(static_cast<int>(scene_.meshes.size()));
            scene_.meshes.push_back(std::move(mesh));
        }
        return parts;
    }

    /// Triangles, the vertices that they use, posed, and the material.
    Mesh meshOf(const tinygltf::Primitive& primitive, const PosedMesh& posed,
                std::span<const glm::mat4> joints, const std::string& where) {
        Mesh mesh;
        mesh.material = primitive.material;
        if (mesh.material != -1) {
            gltf::elementOf(scene_.materials, mesh.material, "{}: {}: material {}", file_.name,
                            where, mesh.material);
        }
        const int positions = primitive.attributes.at("POSITION");
        const std::size_t count = accessors_.values<glm::vec3>(positions).size();
        if (count > std::numeric_limits<std::uint32_t>::max()) {
            fail(fmt::format("{}: {} vertices; at most 4294967295 are allowed", where, count));
        }
        std::vector<std::uint32_t> used;
        const bool isPoints = primitive.mode == TINYGLTF_MODE_POINTS;
        PositionUses& uses = positionUses_[positions];
        (isPoints ? uses.byPoints : uses.byTriangles) = true;
        if (isPoints) {
            used = checkedIndices(primitive, count, where);
            std::ranges::sort(used);
            used.erase(std::unique(used.begin(), used.end()), used.end());
        } else {
            const std::vector<std::uint32_t> indices = checkedIndices(primitive, count, where);
            mesh.triangles = trianglesOf(indices, primitive.mode);
            if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
                leftOut_.add("a corner behind the last triangle", indices.size() % 3);
            }
            used = usedVertices_.renumber(mesh.triangles, count);
        }
        uses.isUsed.resize(count, false);
        for (const std::uint32_t vertex : used) uses.isUsed[vertex] = true;

        const gltf::UsedPart part{primitive, count, used, fmt::format("{}: {}", file_.name, where)};
        mesh.positions = attribute<glm::vec3>(part, "POSITION");
        mesh.normals = attribute<glm::vec3>(part, "NORMAL");
        mesh.isFlat = !isPoints && mesh.normals.empty();
        for (glm::vec3& normal : mesh.normals) normal = unitNormal(normal);
        mesh.colors = attribute<glm::vec3>(part, "COLOR_0");
        for (const glm::vec3& c : mesh.colors)
            largestColour_ = std::max({largestColour_, c.r, c.g, c.b});
        if (isPoints && mesh.material >= 0) colourPoints(scene_.materials[mesh.material], mesh);
        const gltf::TextureUse use =
            mesh.material < 0 ? gltf::TextureUse{} : textureUses_[mesh.material];
        if (!isPoints) {
            mesh.texcoords =
                attribute<glm::vec2>(part, fmt::format("TEXCOORD_{}", use.texcoordSet).c_str());
            if (mesh.texcoords.empty() && mesh.material >= 0) {
                leftOut_.add(
                    fmt::format("a texture of a mesh without TEXCOORD_{}", use.texcoordSet),
                    gltf::textureCount(scene_.materials[mesh.material]));
            }
        }
        if (use.isTransformed) {
            for (glm::vec2& uv : mesh.texcoords) uv = use.transform * glm::vec3(uv, 1.0F);
        }
        for (std::size_t i = primitive.targets.size(); i < posed.weights.size(); ++i) {
            leftOut_.add("a weight of a morph target that is not there", posed.weights[i] != 0.0);
        }
        gltf::morph(accessors_, part, posed.weights, mesh);
        if (posed.skin >= 0) {
            leftOut_.add("weights that a skinned vertex lacks: the first joint holds it",
                         gltf::moveToJoints(accessors_, part, joints, mesh));
        }
        return mesh;
    }

    /// Of a material points have the base colour alone.
    void colourPoints(const Material& material, Mesh& points) {
        Material plain;
        plain.name = material.name;
        plain.baseColor = material.baseColor;
        plain.isDoubleSided = material.isDoubleSided;
        if (material.metallic == 1.0F) plain.metallic = 1.0F;  // of a file that does not say it
        if (material != plain) leftOut_.add("what a material of points has beside its base colour");
        const glm::vec3 base(material.baseColor);
        if (base == glm::vec3(1.0F)) return;
        points.colors.resize(points.positions.size(), glm::vec3(1.0F));
        for (glm::vec3& color : points.colors) color *= base;
    }

    /// Empty when the primitive does not have it.
    template <class T>
    std::vector<T> attribute(const gltf::UsedPart& part, const char* name) {
        const auto found = part.primitive.attributes.find(name);
        if (found == part.primitive.attributes.end()) return {};
        const bool isColour = std::string_view(name) == "COLOR_0";
        const std::size_t count = accessors_.values<T>(found->second, isColour).size();
        if (isColour) requireColours(found->second);
        if (isColour && model().accessors[found->second].type == TINYGLTF_TYPE_VEC4) {
            const auto colours = accessors_.takenValues<glm::vec4>(found->second);
            const bool isSolid =
                std::ranges::all_of(colours, [](const glm::vec4& c) { return c.a >= 1.0F; });
            leftOut_.add("the alpha of vertex colours", isSolid ? 0 : 1);
        }
        const bool isWhole = part.used.size() == part.vertexCount && count == part.vertexCount;
        if (isWhole && readers_[found->second] == 1) {
            return accessors_.takenValues<T>(found->second, isColour);
        }
        accessors_.charge(part.used.size(), sizeof(T));
        return part.of(accessors_.values<T>(found->second, isColour), name);
    }

    /// glTF 2.0, Sec. 3.7.2.1. Of other numbers nothing says of which whole they are parts.
    void requireColours(int accessor) const {
        const tinygltf::Accessor& colours = model().accessors[accessor];
        const bool isUnsigned = colours.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                colours.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
        if (colours.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return;
        if (isUnsigned && colours.normalized) return;
        fail(
            fmt::format("accessor {} has colours in integers that are not normalized; floats, or "
                        "normalized unsigned bytes or shorts are allowed",
                        accessor));
    }

    /// Of the vertices in their order; all of them where the file does not number any.
    std::vector<std::uint32_t> checkedIndices(const tinygltf::Primitive& primitive,
                                              std::size_t vertexCount, const std::string& where) {
        std::vector<std::uint32_t> indices;
        if (primitive.indices >= 0) {
            indices = accessors_.indices(primitive.indices);
        } else {
            indices.resize(vertexCount);
            std::iota(indices.begin(), indices.end(), 0U);
        }
        for (const std::uint32_t index : indices) {
            if (index >= vertexCount) {
                fail(fmt::format("{}: index {} is not one of the {} vertices", where, index,
                                 vertexCount));
            }
        }
        return indices;
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

    /// A node whose parent has been visited.
    struct Open {
        int node = 0;
        glm::mat4 worldFromParent{1.0F};
        glm::dmat4 exactFromParent{1.0};
        bool isVisible = true;
    };

    /// The tree below `root`, without recursion: files decide how deep it is. Transforms are
    /// composed in floats; where the scene is moved, in double until the offset is subtracted.
    void visit(int root) {
        std::vector<Open> open{{root, glm::mat4(1.0F), glm::translate(glm::dmat4(1.0), -offset_)}};
        while (!open.empty()) {
            const Open parent = open.back();
            open.pop_back();
            const int index = parent.node;
            const tinygltf::Node& node =
                gltf::elementOf(model().nodes, index, "{}: node {}", file_.name, index);
            std::optional<glm::mat4>& worldFromNode = worldFromNode_[index];
            if (worldFromNode) {
                fail(fmt::format("node {} has two parents or is its own ancestor", index));
            }
            const glm::dmat4 local = localMatrix(node, index);
            Open inner{0, parent.worldFromParent * glm::mat4(local), parent.exactFromParent * local,
                       parent.isVisible && isVisible(node)};
            if (isMoved_) inner.worldFromParent = glm::mat4(inner.exactFromParent);
            worldFromNode = inner.worldFromParent;
            exactFromNode_[index] = inner.exactFromParent;
            checkFinite(*worldFromNode, index);
            if (inner.isVisible) {
                drawn_.push_back(index);
            } else {
                leftOut_.add("a node that KHR_node_visibility hides");
            }
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                inner.node = *child;
                open.push_back(inner);
            }
        }
    }

    static bool isVisible(const tinygltf::Node& node) {
        const auto extension = node.extensions.find("KHR_node_visibility");
        if (extension == node.extensions.end() || !extension->second.Has("visible")) return true;
        const tinygltf::Value& visible = extension->second.Get("visible");
        return !visible.IsBool() || visible.Get<bool>();
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

    glm::dmat4 localMatrix(const tinygltf::Node& node, int index) {
        if (node.matrix.size() == 16) {
            return gltf::affine(glm::dmat4(glm::make_mat4(node.matrix.data())),
                                fmt::format("{}: node {}", file_.name, index));
        }
        glm::dmat4 matrix(1.0);
        if (node.translation.size() == 3) {
            matrix[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
        }
        if (node.rotation.size() == 4) {
            const glm::dvec4 xyzw = glm::make_vec4(node.rotation.data());
            const glm::dquat rotation(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
            if (std::abs(glm::length(rotation) - 1.0) > 1e-3)
                leftOut_.add("the length of a node's rotation, which is not 1");
            matrix *= glm::mat4_cast(glm::normalize(rotation));
        }
        if (node.scale.size() == 3) {
            const glm::dvec3 scale = glm::make_vec3(node.scale.data());
            for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
        }
        return matrix;
    }

    void addContent(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode) {
        if (node.camera >= 0) addCamera(node, index, worldFromNode);
        lights_.add(node, index, worldFromNode);
        if (node.mesh < 0) return;
        const tinygltf::Mesh& mesh = gltf::elementOf(
            model().meshes, node.mesh, "{}: node {}: mesh {}", file_.name, index, node.mesh);
        std::optional<Motion> motion = gltf::motionIn(node.extras, offset_, leftOut_);
        const Parts& parts =
            partsOf({node.mesh, node.skin, node.weights.empty() ? mesh.weights : node.weights});
        // Joints say where a skinned mesh is, whatever its node says.
        const bool isInWorld = node.skin >= 0;
        if (isInWorld && node.extensions.contains(kInstancing)) {
            leftOut_.add("the instances of a skinned node (EXT_mesh_gpu_instancing)");
        }
        const auto matrices = isInWorld ? std::vector{glm::mat4(1.0F)} : instanceMatrices(node);
        for (const glm::mat4& nodeFromInstance : matrices) {
            const glm::mat4 worldFromMesh =
                isInWorld ? glm::mat4(1.0F) : worldFromNode * nodeFromInstance;
            checkFinite(worldFromMesh, index);
            checkReach(worldFromMesh, parts.bounds, fmt::format("node {}", index));
            accessors_.charge(parts.meshes.size(), sizeof(Instance));
            for (const int part : parts.meshes) {
                if (motion) {
                    motion->instance = static_cast<int>(scene_.instances.size());
                    scene_.motions.push_back(*motion);
                }
                scene_.instances.push_back({part, worldFromMesh});
            }
            for (const PointCloud& cloud : parts.clouds) addPoints(cloud, worldFromMesh);
            if (!anchor_.counts || isInWorld) continue;
            const glm::dmat4 exact = exactFromNode_[index] * glm::dmat4(nodeFromInstance);
            for (const int part : parts.meshes) {
                anchor_.countJoined(scene_.meshes[part].positions, exact);
            }
            for (const PointCloud& cloud : parts.clouds) {
                anchor_.countJoined(cloud.positions, exact);
            }
        }
    }

    static constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

    /// One matrix an instance; without that extension the identity.
    std::vector<glm::mat4> instanceMatrices(const tinygltf::Node& node) {
        const auto extension = node.extensions.find(kInstancing);
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
        if (const int i = accessor("TRANSLATION"); i >= 0)
            translations = accessors_.values<glm::vec3>(i);
        if (const int i = accessor("ROTATION"); i >= 0) rotations = accessors_.values<glm::vec4>(i);
        if (const int i = accessor("SCALE"); i >= 0) scales = accessors_.values<glm::vec3>(i);
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

    /// Clouds join. One without colours is white among others; normals go where not all have them.
    void addPoints(const PointCloud& cloud, const glm::mat4& worldFromCloud) {
        PointCloud& points = scene_.points;
        const std::size_t before = points.positions.size();
        accessors_.charge(cloud.positions.size(), 3 * sizeof(glm::vec3));
        for (const glm::vec3& position : cloud.positions) {
            points.positions.emplace_back(worldFromCloud * glm::vec4(position, 1.0F));
        }
        if (before > 0 && points.normals.empty() != cloud.normals.empty()) {
            leftOut_.add("normals that not all points have",
                         points.normals.size() + cloud.normals.size());
            points.normals.clear();
        } else {
            const glm::mat3 toWorld = normalMatrix(glm::mat3(worldFromCloud));
            for (const glm::vec3& normal : cloud.normals) {
                points.normals.push_back(unitNormal(toWorld * normal));
            }
        }
        if (points.colors.empty() && cloud.colors.empty()) return;
        points.colors.resize(before, glm::vec3(1.0F));
        points.colors.insert(points.colors.end(), cloud.colors.begin(), cloud.colors.end());
        points.colors.resize(points.positions.size(), glm::vec3(1.0F));
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
        if (perspective.zfar != 0.0 && !(perspective.zfar > perspective.znear)) {
            fail(
                fmt::format("camera {}: zfar {} and znear {}; a zfar above znear, or none, is "
                            "allowed",
                            node.camera, perspective.zfar, perspective.znear));
        }
        Camera camera;
        camera.name = from.name.empty() ? node.name : from.name;
        camera.verticalFovRad = static_cast<float>(perspective.yfov);
        camera.nearM = static_cast<float>(perspective.znear);
        camera.farM = perspective.zfar > perspective.znear ? static_cast<float>(perspective.zfar)
                                                           : std::max(1000.0F, 1e5F * camera.nearM);
        camera.position = glm::vec3(worldFromNode[3]);
        const glm::vec3 forward = -unitNormal(glm::vec3(worldFromNode[2]));
        const std::optional<double> targetM = gltf::lengthExtra(node.extras, gltf::kTargetM);
        if (!targetM) unaimed_.push_back(scene_.cameras.size());
        camera.target = camera.position + static_cast<float>(targetM.value_or(1.0)) * forward;
        camera.up = unitNormal(glm::vec3(worldFromNode[1]));
        scene_.cameras.push_back(std::move(camera));
    }

    const gltf::File& file_;
    Anchor& anchor_;
    glm::dvec3 offset_;
    bool isMoved_;
    LeftOut& leftOut_;
    gltf::Accessors accessors_;
    gltf::Lights lights_;
    std::vector<gltf::TextureUse> textureUses_;
    std::map<PosedMesh, Parts> parts_;
    std::map<int, int> readers_;  // of each accessor: attributes of primitives
    UsedVertices usedVertices_;
    std::map<int, PositionUses> positionUses_;             // by their accessors
    std::vector<std::optional<glm::mat4>> worldFromNode_;  // of those visited
    std::vector<glm::dmat4> exactFromNode_;                // likewise, unrounded
    std::vector<int> drawn_;                               // in the order of their visits
    float largestColour_ = 0.0F;                           // of vertices
    std::vector<std::size_t> unaimed_;  // cameras whose file does not say how far they look
    Scene scene_;
};

}  // namespace

Scene loadGltf(const std::filesystem::path& path) {
    const gltf::File file = gltf::readFile(path);
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        leftOut = file.leftOut;
        return SceneBuilder(file, anchor, leftOut).build();
    });
}

}  // namespace gfxrepro::scene
