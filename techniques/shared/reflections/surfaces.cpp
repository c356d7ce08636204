#include "techniques/shared/reflections/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runner/core/error.h"
#include "runner/image/srgb.h"
#include "techniques/shared/reflections/reflector_parts.h"
#include "techniques/shared/reflections/texture_layer.h"

namespace gfxrepro::reflections {

namespace {

constexpr int kMostReflectors = 0xFFFF;    // 16 bits of the G-buffer
constexpr float kTransmissive = 0.5F;      // materials above are left out
constexpr float kPlanarTolerance = 1e-3F;  // see Object::isPlanar
constexpr float kHangingBelowTop = 0.05F;  // of the box's height: the light that is made up
constexpr float kMadeUpLightIntensity = 0.9F;

scene::Material materialOf(const scene::Scene& scene, const scene::Mesh& mesh) {
    return mesh.material < 0 ? scene::Material{}
                             : scene.materials[static_cast<std::size_t>(mesh.material)];
}

const scene::Mesh& meshOf(const scene::Scene& scene, const scene::Instance& instance) {
    return scene.meshes[static_cast<std::size_t>(instance.mesh)];
}

/// Leaves out the instances that let light through; motions follow their instances. Returns how
/// many it were.
int dropTransmissive(scene::Scene& scene) {
    std::vector<scene::Instance> kept;
    std::vector<int> newIndex;
    for (const scene::Instance& instance : scene.instances) {
        const bool isKept =
            materialOf(scene, meshOf(scene, instance)).transmission <= kTransmissive;
        newIndex.push_back(isKept ? static_cast<int>(kept.size()) : -1);
        if (isKept) kept.push_back(instance);
    }
    const auto dropped = static_cast<int>(scene.instances.size() - kept.size());
    scene.instances = std::move(kept);
    std::vector<scene::Motion> motions;
    for (scene::Motion motion : scene.motions) {
        motion.instance = newIndex[static_cast<std::size_t>(motion.instance)];
        if (motion.instance >= 0) motions.push_back(motion);
    }
    scene.motions = std::move(motions);
    return dropped;
}

/// The part of light that a surface reflects head-on (Fresnel at normal incidence).
float headOnReflectivity(float indexOfRefraction) {
    const float ratio = (indexOfRefraction - 1.0F) / (indexOfRefraction + 1.0F);
    return ratio * ratio;
}

float in255ths(float value) {
    return std::round(255.0F * std::clamp(value, 0.0F, 1.0F)) / 255.0F;
}

bool isUsable(const glm::vec3& normal) {
    const float squared = glm::dot(normal, normal);
    return std::isfinite(squared) && squared > 0.0F;
}

/// The normal of some triangle at each vertex: for those around which the area-weighted ones cancel
/// out. Up where all triangles are degenerate: they show nowhere.
std::vector<glm::vec3> anyTriangleNormals(const scene::Mesh& mesh) {
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0F, 1.0F, 0.0F));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[triangle.x]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(mesh.positions[triangle.y]) - a,
                                             glm::dvec3(mesh.positions[triangle.z]) - a);
        const double length = glm::length(normal);
        if (!(length > 0.0)) continue;
        for (int corner = 0; corner < 3; ++corner) {
            normals[triangle[corner]] = glm::vec3(normal / length);
        }
    }
    return normals;
}

/// Unit normals of all vertices; counts those that the mesh did not have.
std::vector<glm::vec3> repairedNormals(const scene::Mesh& mesh, int& repairedCount) {
    std::vector<glm::vec3> normals = mesh.normals;
    normals.resize(mesh.positions.size(), glm::vec3(0.0F));
    repairedCount = static_cast<int>(
        std::count_if(normals.begin(), normals.end(), [](const auto& n) { return !isUsable(n); }));
    if (repairedCount > 0) {
        const std::vector<glm::vec3> weighted = scene::vertexNormals(mesh);
        const std::vector<glm::vec3> any = anyTriangleNormals(mesh);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            if (isUsable(normals[i])) continue;
            normals[i] = isUsable(weighted[i]) ? weighted[i] : any[i];
        }
    }
    for (glm::vec3& normal : normals) normal = glm::normalize(normal);
    return normals;
}

bool isPlanar(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
              float diagonal) {
    for (std::size_t i = 1; i < positions.size(); ++i) {
        if (glm::distance(normals[i], normals[0]) > kPlanarTolerance) return false;
        const float height = glm::dot(positions[i] - positions[0], normals[0]);
        if (std::abs(height) > kPlanarTolerance * diagonal) return false;
    }
    return true;
}

scene::PointLight madeUpLight(const scene::Box& box) {
    scene::PointLight light;
    light.position = box.centre();
    light.position.y = box.max.y - kHangingBelowTop * box.size().y;
    light.intensity = glm::vec3(kMadeUpLightIntensity);
    // Half the diagonal: the far corners still get a third of what is below the light.
    light.radiusM = std::max(0.5F * glm::length(box.size()), 1e-6F);  // one point: no 0 / 0
    return light;
}

}  // namespace

ReflectiveScene::ReflectiveScene(const scene::Scene& scene, const ReflectorRule& rule)
    : scene_(scene), rule_(rule), srgbDecoding_(image::srgbDecoding()) {
    transmissiveCount_ = dropTransmissive(scene_);
    if (scene_.triangleCount() == 0) {
        throw Error(fmt::format(
            "scene {}: reflections need triangles, it has none{}", scene_.name,
            transmissiveCount_ > 0
                ? fmt::format(" (transmissive objects left out: {})", transmissiveCount_)
                : std::string()));
    }
    std::vector<PartOrigin> parts;
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        parts.push_back({static_cast<int>(i), false});
    }
    if (rule.splitsParts) {
        parts = splitIntoParts(scene_, [&](const scene::Material& material) {
            return material.roughness <= rule.maxRoughness;
        });
    }
    std::vector<int> layerOfTexture(scene_.textures.size(), -1);
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        addObject(scene_.instances[i], layerOfTexture);
        if (objects_[i].reflector == 0) continue;
        if (i == 0 || parts[i].instance != parts[i - 1].instance) ++wholeReflectorCount_;
        objects_[i].wholeReflector = wholeReflectorCount_;
        objects_[i].isConcave = parts[i].isConcave;
    }
    if (reflectorCount_ > kMostReflectors) {
        throw UnsupportedError(fmt::format("scene {}: {} reflectors, at most {} can be told apart",
                                           scene_.name, reflectorCount_, kMostReflectors));
    }
    // Of the triangles' vertices only: points of a scene are not seen.
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        for (const glm::vec3& position : meshOf(scene_, scene_.instances[i]).positions) {
            boundsWorld_.add(
                glm::vec3(scene_.instances[i].worldFromMesh * glm::vec4(position, 1.0F)));
        }
    }
    lights_ = scene_.lights;
    if (lights_.size() > kMaxLights) lights_.resize(kMaxLights);
    if (lights_.empty()) lights_.push_back(madeUpLight(boundsWorld_));
}

void ReflectiveScene::requireReflectors() const {
    if (reflectorCount_ > 0) return;
    throw Error(
        fmt::format("scene '{}' has no reflectors: no material's roughness is at most {} "
                    "('reflector_roughness')",
                    scene_.name, rule_.maxRoughness));
}

void ReflectiveScene::addObject(const scene::Instance& instance, std::vector<int>& layerOfTexture) {
    const scene::Mesh& mesh = meshOf(scene_, instance);
    const scene::Material material = materialOf(scene_, mesh);
    Object object;
    object.baseColor = glm::vec3(material.baseColor);
    object.emissive = material.emissive;
    if (material.baseColorTexture >= 0 && !mesh.texcoords.empty()) {
        const auto texture = static_cast<std::size_t>(material.baseColorTexture);
        if (layerOfTexture[texture] < 0) {
            layerOfTexture[texture] = static_cast<int>(textureLayers_.size());
            textureLayers_.push_back(textureLayer(scene_.textures[texture], kLayerSizePx));
        }
        object.textureLayer = layerOfTexture[texture];
    }
    if (material.roughness <= rule_.maxRoughness) {
        object.reflectivity =
            in255ths(std::max(material.metallic, headOnReflectivity(material.indexOfRefraction)));
        object.glossiness = in255ths(material.roughness);
        if (object.reflectivity > 0.0F) object.reflector = ++reflectorCount_;
    }
    addGeometry(mesh, object);
    objects_.push_back(object);
}

void ReflectiveScene::addGeometry(const scene::Mesh& mesh, Object& object) {
    const auto firstVertex = static_cast<std::uint32_t>(geometry_.positions.size());
    object.firstTriangle = static_cast<std::uint32_t>(geometry_.triangles.size());
    object.triangleCount = static_cast<std::uint32_t>(mesh.triangles.size());
    object.boundsMesh = mesh.bounds();

    int repairedCount = 0;
    const std::vector<glm::vec3> normals = repairedNormals(mesh, repairedCount);
    if (object.reflector != 0) {
        repairedNormalCount_ += repairedCount;
        object.isPlanar = isPlanar(mesh.positions, normals, glm::length(object.boundsMesh.size()));
    }
    const std::size_t vertexCount = geometry_.positions.size() + mesh.positions.size();
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(geometry_.positions, mesh.positions);
    append(geometry_.normals, normals);
    append(geometry_.texcoords, mesh.texcoords);
    geometry_.texcoords.resize(vertexCount, glm::vec2(0.0F));
    append(geometry_.colors, mesh.colors);
    geometry_.colors.resize(vertexCount, glm::vec3(1.0F));
    for (const glm::uvec3& triangle : mesh.triangles) {
        geometry_.triangles.push_back(triangle + firstVertex);
    }
    geometry_.objectOfTriangle.resize(geometry_.triangles.size(),
                                      static_cast<std::uint32_t>(objects_.size()));
}

float ReflectiveScene::diagonalM() const {
    return glm::length(boundsWorld_.size());
}

void ReflectiveScene::setGlossiness(float glossiness) {
    GFXREPRO_ASSERT(glossiness >= 0.0F && glossiness <= 1.0F);
    for (Object& object : objects_) {
        if (object.reflector != 0) object.glossiness = in255ths(glossiness);
    }
}

namespace {

template <class T>
T interpolated(const std::vector<T>& values, const glm::uvec3& triangle,
               const glm::vec2& barycentric) {
    return (1.0F - barycentric.x - barycentric.y) * values[triangle.x] +
           barycentric.x * values[triangle.y] + barycentric.y * values[triangle.z];
}

}  // namespace

glm::vec3 ReflectiveScene::texelsAt(int layer, const glm::vec2& texcoord) const {
    const image::Image8& texels = textureLayers_[static_cast<std::size_t>(layer)];
    const glm::vec2 place = (texcoord - glm::floor(texcoord)) * float{kLayerSizePx} - 0.5F;
    const glm::vec2 low = glm::floor(place);
    const glm::vec2 fraction = place - low;
    const auto texel = [&](int dx, int dy) {
        // place is in [−½, size − ½]: one texel out of the layer at most.
        const int x = (static_cast<int>(low.x) + dx + kLayerSizePx) % kLayerSizePx;
        const int y = (static_cast<int>(low.y) + dy + kLayerSizePx) % kLayerSizePx;
        return glm::vec3(srgbDecoding_[texels.at(x, y, 0)], srgbDecoding_[texels.at(x, y, 1)],
                         srgbDecoding_[texels.at(x, y, 2)]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), fraction.x),
                    glm::mix(texel(0, 1), texel(1, 1), fraction.x), fraction.y);
}

glm::vec3 ReflectiveScene::albedoAt(std::uint32_t triangle, const glm::vec2& barycentric) const {
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    const glm::vec3 albedo =
        object.baseColor * interpolated(geometry_.colors, corners, barycentric);
    if (object.textureLayer < 0) return albedo;
    return albedo *
           texelsAt(object.textureLayer, interpolated(geometry_.texcoords, corners, barycentric));
}

glm::vec3 ReflectiveScene::normalMeshAt(std::uint32_t triangle,
                                        const glm::vec2& barycentric) const {
    return interpolated(geometry_.normals, geometry_.triangles[triangle], barycentric);
}

glm::vec3 shadeDiffuse(std::span<const scene::PointLight> lights, const glm::vec3& positionWorld,
                       const glm::vec3& normalWorld, const glm::vec3& albedo,
                       const glm::vec3& emissive) {
    glm::vec3 irradiance(0.30F + 0.10F * normalWorld.y);
    for (const scene::PointLight& light : lights) {
        const glm::vec3 toLight = light.position - positionWorld;
        const float distance = glm::length(toLight);
        // A point at the light itself has no direction to it: no 0 / 0.
        const float cosine =
            std::max(glm::dot(normalWorld, toLight) / std::max(distance, 1e-6F), 0.0F);
        const float ratio = distance / light.radiusM;
        irradiance += light.intensity * (cosine / (1.0F + ratio * ratio));
    }
    return glm::clamp(albedo * irradiance + emissive, 0.0F, 1.0F);
}

}  // namespace gfxrepro::reflections
