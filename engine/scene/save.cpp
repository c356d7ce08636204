#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "engine/scene/gltf_extras.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_ply_header.h"

namespace gfxrepro::scene {
namespace {

template <class T>
void appendBytes(std::string& to, const T& value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

// ---- PLY

/// The vertices of a mesh or of points; spans are empty or one a vertex.
struct PlyVertices {
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;
    std::span<const glm::vec2> texcoords;
    std::span<const glm::vec3> colors;
    std::span<const float> radii;
    glm::dvec3 offset{0.0};  // of the positions, which are doubles where there is one

    bool areDoubles() const { return offset != glm::dvec3(0.0); }
};

std::string plyHeader(const PlyVertices& vertices, std::size_t triangleCount) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    if (!vertices.colors.empty()) header += fmt::format("{}\n", ply::kLinearColours);
    const auto properties = [&header](std::initializer_list<std::string_view> names,
                                      std::string_view type = "float") {
        for (const std::string_view name : names) {
            header += fmt::format("property {} {}\n", type, name);
        }
    };
    header += fmt::format("element vertex {}\n", vertices.positions.size());
    properties({"x", "y", "z"}, vertices.areDoubles() ? "double" : "float");
    if (!vertices.normals.empty()) properties({"nx", "ny", "nz"});
    if (!vertices.texcoords.empty()) properties({"u", "v"});
    if (!vertices.colors.empty()) properties({"red", "green", "blue"});
    if (!vertices.radii.empty()) properties({"radius"});
    if (triangleCount > 0) {
        header += fmt::format("element face {}\n", triangleCount);
        header += "property list uchar uint vertex_indices\n";
    }
    return header + "end_header\n";
}

std::string plyContent(const PlyVertices& vertices, std::span<const glm::uvec3> triangles) {
    std::string content = plyHeader(vertices, triangles.size());
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
        if (vertices.areDoubles()) {
            appendBytes(content, glm::dvec3(vertices.positions[i]) + vertices.offset);
        } else {
            appendBytes(content, vertices.positions[i]);
        }
        if (!vertices.normals.empty()) appendBytes(content, vertices.normals[i]);
        if (!vertices.texcoords.empty()) appendBytes(content, vertices.texcoords[i]);
        if (!vertices.colors.empty()) appendBytes(content, vertices.colors[i]);
        if (!vertices.radii.empty()) appendBytes(content, vertices.radii[i]);
    }
    for (const glm::uvec3& triangle : triangles) {
        content += '\3';
        appendBytes(content, triangle);
    }
    return content;
}

// ---- GLB

tinygltf::Value numberText(float value) {
    return tinygltf::Value(static_cast<double>(value));
}

/// An extension object with one number in it, or none.
tinygltf::Value extension(const char* key, float value) {
    return tinygltf::Value(tinygltf::Value::Object{{key, numberText(value)}});
}

/// Of a node, with the scene's offset.
std::vector<double> matrixOf(const glm::mat4& matrix, const glm::dvec3& offset) {
    glm::dmat4 moved(matrix);
    moved[3] += glm::dvec4(offset, 0.0);
    return {glm::value_ptr(moved), glm::value_ptr(moved) + 16};
}

class GlbBuilder {
  public:
    explicit GlbBuilder(const Scene& scene) : scene_(scene) {
        model_.asset.version = "2.0";
        model_.asset.generator = "gfxrepro";
        model_.buffers.resize(1);
        model_.scenes.resize(1);
        model_.scenes[0].name = scene.name;
        model_.defaultScene = 0;
    }

    tinygltf::Model build() {
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
            addTexture(scene_.textures[i], samplingOf(scene_, static_cast<int>(i)));
        }
        for (const Material& material : scene_.materials) addMaterial(material);
        addMeshes();
        if (!scene_.points.positions.empty()) addPoints();
        for (const Camera& camera : scene_.cameras) addCamera(camera);
        for (const PointLight& light : scene_.lights) addLight(light);
        if (!scene_.paths.empty()) {
            model_.scenes[0].extras = gltf::pathsExtra(scene_.paths, scene_.offset);
        }
        std::sort(model_.extensionsUsed.begin(), model_.extensionsUsed.end());
        if (model_.buffers[0].data.empty()) model_.buffers.clear();
        return std::move(model_);
    }

  private:
    template <class T>
    int addView(std::span<const T> values, int target) {
        std::vector<unsigned char>& data = model_.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);  // accessors are aligned to their components
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = values.size_bytes();
        view.target = target;
        const auto* begin = reinterpret_cast<const unsigned char*>(values.data());
        data.insert(data.end(), begin, begin + values.size_bytes());
        model_.bufferViews.push_back(std::move(view));
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    int addAccessor(int view, std::size_t count, int type, int componentType) {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.count = count;
        accessor.type = type;
        accessor.componentType = componentType;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    template <int N>
    void addAttribute(tinygltf::Primitive& primitive, const char* name,
                      const std::vector<glm::vec<N, float>>& values) {
        if (values.empty()) return;
        const int view =
            addView(std::span<const glm::vec<N, float>>(values), TINYGLTF_TARGET_ARRAY_BUFFER);
        primitive.attributes[name] =
            addAccessor(view, values.size(), N == 2 ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3,
                        TINYGLTF_COMPONENT_TYPE_FLOAT);
    }

    /// With the bounds that glTF wants for positions.
    void addPositions(tinygltf::Primitive& primitive, const std::vector<glm::vec3>& positions,
                      const Box& bounds) {
        addAttribute(primitive, "POSITION", positions);
        tinygltf::Accessor& accessor = model_.accessors.back();
        accessor.minValues = {bounds.min.x, bounds.min.y, bounds.min.z};
        accessor.maxValues = {bounds.max.x, bounds.max.y, bounds.max.z};
    }

    void addMeshes() {
        std::vector<int> glbMesh;  // −1 for meshes without triangles, which glTF cannot hold
        for (const Mesh& mesh : scene_.meshes) {
            glbMesh.push_back(mesh.triangles.empty() ? -1 : static_cast<int>(model_.meshes.size()));
            if (mesh.triangles.empty()) continue;
            tinygltf::Primitive primitive;
            primitive.mode = TINYGLTF_MODE_TRIANGLES;
            primitive.material = mesh.material;
            addPositions(primitive, mesh.positions, mesh.bounds());
            addAttribute(primitive, "NORMAL", mesh.normals);
            addAttribute(primitive, "TEXCOORD_0", mesh.texcoords);
            addAttribute(primitive, "COLOR_0", mesh.colors);
            const int view = addView(std::span<const glm::uvec3>(mesh.triangles),
                                     TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
            primitive.indices = addAccessor(view, mesh.triangles.size() * 3, TINYGLTF_TYPE_SCALAR,
                                            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
            addMesh(mesh.name, std::move(primitive));
            if (mesh.normals.empty() && !mesh.isFlat) {  // glTF 2.0, Sec. 3.7.2.1: it would be
                model_.meshes.back().extras = gltf::numberExtra(gltf::kSmooth, 1.0);
            }
        }
        for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            if (glbMesh[instance.mesh] < 0) continue;
            tinygltf::Node& node = addNode();
            const auto motion =
                std::ranges::find(scene_.motions, static_cast<int>(i), &Motion::instance);
            if (motion != scene_.motions.end()) {
                node.extras = gltf::motionExtra(*motion, scene_.offset);
            }
            node.mesh = glbMesh[instance.mesh];
            if (instance.worldFromMesh != glm::mat4(1.0F) || isMoved()) {
                node.matrix = matrixOf(instance.worldFromMesh, scene_.offset);
            }
        }
    }

    void addPoints() {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_POINTS;
        addPositions(primitive, scene_.points.positions, scene_.points.bounds());
        addAttribute(primitive, "NORMAL", scene_.points.normals);
        addAttribute(primitive, "COLOR_0", scene_.points.colors);
        addMesh("points", std::move(primitive));
        tinygltf::Node& node = addNode();
        node.mesh = static_cast<int>(model_.meshes.size()) - 1;
        if (isMoved()) node.matrix = matrixOf(glm::mat4(1.0F), scene_.offset);
    }

    bool isMoved() const { return scene_.offset != glm::dvec3(0.0); }

    void addMesh(const std::string& name, tinygltf::Primitive primitive) {
        tinygltf::Mesh mesh;
        mesh.name = name;
        mesh.primitives.push_back(std::move(primitive));
        model_.meshes.push_back(std::move(mesh));
    }

    tinygltf::Node& addNode() {
        model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
        return model_.nodes.emplace_back();
    }

    void addTexture(const image::Image8& texture, const Sampling& sampling) {
        const std::string png = image::encodePng(texture);
        tinygltf::Image image;
        image.bufferView = addView(std::span<const char>(png), 0);
        image.mimeType = "image/png";
        model_.images.push_back(std::move(image));
        tinygltf::Texture& to = model_.textures.emplace_back();
        to.source = static_cast<int>(model_.images.size()) - 1;
        if (sampling == Sampling{}) return;
        constexpr int kWraps[] = {TINYGLTF_TEXTURE_WRAP_REPEAT,
                                  TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT,
                                  TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE};
        to.sampler = static_cast<int>(model_.samplers.size());
        tinygltf::Sampler& sampler = model_.samplers.emplace_back();
        sampler.wrapS = kWraps[static_cast<int>(sampling.u)];
        sampler.wrapT = kWraps[static_cast<int>(sampling.v)];
        if (sampling.isNearest) sampler.magFilter = TINYGLTF_TEXTURE_FILTER_NEAREST;
    }

    void addMaterial(const Material& from) {
        tinygltf::Material& to = model_.materials.emplace_back();
        tinygltf::PbrMetallicRoughness& pbr = to.pbrMetallicRoughness;
        to.name = from.name;
        pbr.baseColorFactor = {from.baseColor.r, from.baseColor.g, from.baseColor.b,
                               from.baseColor.a};
        pbr.metallicFactor = from.metallic;
        pbr.roughnessFactor = from.roughness;
        pbr.baseColorTexture.index = from.baseColorTexture;
        pbr.metallicRoughnessTexture.index = from.metallicRoughnessTexture;
        to.normalTexture.index = from.normalTexture;
        to.normalTexture.scale = from.normalScale;
        to.emissiveTexture.index = from.emissiveTexture;
        to.doubleSided = from.isDoubleSided;
        to.alphaMode = from.baseColor.a < 1.0F ? "BLEND" : "OPAQUE";
        if (from.alphaCutoff > 0.0F) {
            to.alphaMode = "MASK";
            to.alphaCutoff = from.alphaCutoff;
        }
        // The factor stays within 1; an extension holds what is above.
        const float strength = std::max({1.0F, from.emissive.r, from.emissive.g, from.emissive.b});
        const glm::dvec3 factor = glm::dvec3(from.emissive) / static_cast<double>(strength);
        to.emissiveFactor = {factor.r, factor.g, factor.b};
        const auto use = [&](const char* name, tinygltf::Value value) {
            to.extensions[name] = std::move(value);
            std::vector<std::string>& used = model_.extensionsUsed;
            if (std::find(used.begin(), used.end(), name) == used.end()) used.emplace_back(name);
        };
        if (strength > 1.0F) {
            use("KHR_materials_emissive_strength", extension("emissiveStrength", strength));
        }
        if (from.isUnlit) use("KHR_materials_unlit", tinygltf::Value(tinygltf::Value::Object{}));
        if (from.transmission > 0.0F) {
            use("KHR_materials_transmission", extension("transmissionFactor", from.transmission));
        }
        if (from.indexOfRefraction != Material{}.indexOfRefraction) {
            use("KHR_materials_ior", extension("ior", from.indexOfRefraction));
        }
    }

    void addCamera(const Camera& from) {
        tinygltf::Camera& to = model_.cameras.emplace_back();
        to.name = from.name;
        to.type = "perspective";
        to.perspective.yfov = from.verticalFovRad;
        to.perspective.znear = from.nearM;
        to.perspective.zfar = from.farM;
        const glm::vec3 back = glm::normalize(from.position - from.target);
        const glm::vec3 right = glm::normalize(glm::cross(from.up, back));
        tinygltf::Node& node = addNode();
        node.name = from.name;
        node.camera = static_cast<int>(model_.cameras.size()) - 1;
        const double targetM{glm::length(from.position - from.target)};
        node.extras = gltf::numberExtra(gltf::kTargetM, targetM);
        node.matrix = matrixOf({glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F),
                                glm::vec4(back, 0.0F), glm::vec4(from.position, 1.0F)},
                               scene_.offset);
    }

    void addLight(const PointLight& from) {
        const auto index = static_cast<int>(model_.lights.size());
        tinygltf::Light& to = model_.lights.emplace_back();
        to.type = "point";
        // A power of two, so that the product is what it was.
        const float most = std::max({from.intensity.r, from.intensity.g, from.intensity.b});
        to.intensity = most > 0.0F ? std::exp2(std::ceil(std::log2(double{most}))) : 1.0;
        const glm::dvec3 color = glm::dvec3(from.intensity) / to.intensity;
        to.color = {color.r, color.g, color.b};
        to.extras = gltf::numberExtra(gltf::kRadiusM, from.radiusM);
        tinygltf::Node& node = addNode();
        const glm::dvec3 position = glm::dvec3(from.position) + scene_.offset;
        node.translation = {position.x, position.y, position.z};
        node.extensions["KHR_lights_punctual"] =
            tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(index)}});
    }

    const Scene& scene_;
    tinygltf::Model model_;
};

constexpr const char* kSurface = "the surface that points were taken of";

}  // namespace

std::vector<std::string> savePly(const std::filesystem::path& path, const Scene& scene) {
    LeftOut leftOut;
    leftOut.add("a camera", scene.cameras.size());
    leftOut.add("a camera path", scene.paths.size());
    leftOut.add("a height map", scene.heights ? 1 : 0);
    leftOut.add("a light", scene.lights.size());
    leftOut.add("a material", scene.materials.size());
    leftOut.add("a motion", scene.motions.size());
    leftOut.add("a texture", scene.textures.size());
    if (scene.triangleCount() > 0) {
        const Mesh mesh = flattened(scene);
        const auto countLost = [&](const char* what, auto attribute) {
            const bool isKept = !(mesh.*attribute).empty();
            const auto isThere = [&](const Mesh& one) { return !(one.*attribute).empty(); };
            leftOut.add(fmt::format("the {} of a mesh, as others have none", what),
                        isKept ? 0 : std::ranges::count_if(scene.meshes, isThere));
        };
        countLost("normals", &Mesh::normals);
        countLost("texture coordinates", &Mesh::texcoords);
        countLost("colours", &Mesh::colors);
        leftOut.add("that the triangles of a mesh are flat",
                    std::ranges::count_if(scene.meshes, &Mesh::isFlat));
        leftOut.add("a point beside triangles", scene.points.positions.size());
        const PlyVertices vertices{mesh.positions, mesh.normals, mesh.texcoords,
                                   mesh.colors,    {},           scene.offset};
        writeFileAtomic(path, plyContent(vertices, mesh.triangles));
        return leftOut.lines();
    }
    const PointCloud& points = scene.points;
    leftOut.add(kSurface, points.surface.triangles.empty() ? 0 : 1);
    if (points.positions.empty()) {
        throw Error("cannot write " + path.string() + ": the scene has no triangles and no points");
    }
    writeFileAtomic(
        path,
        plyContent(
            {points.positions, points.normals, {}, points.colors, points.radii, scene.offset}, {}));
    return leftOut.lines();
}

std::vector<std::string> saveGlb(const std::filesystem::path& path, const Scene& scene) {
    const tinygltf::Model model = GlbBuilder(scene).build();
    std::ostringstream stream;
    constexpr bool kPretty = false;
    constexpr bool kBinary = true;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, kPretty, kBinary)) {
        throw Error("cannot write " + path.string() + ": the scene cannot be expressed as glTF");
    }
    const std::string content = std::move(stream).str();
    if (content.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("cannot write " + path.string() + ": a GLB file holds at most 4 GiB");
    }
    writeFileAtomic(path, content);
    LeftOut leftOut;
    leftOut.add("a height map", scene.heights ? 1 : 0);
    leftOut.add("the radius of a point", scene.points.radii.size());
    leftOut.add(kSurface, scene.points.surface.triangles.empty() ? 0 : 1);
    return leftOut.lines();
}

}  // namespace gfxrepro::scene
