#include "techniques/reflections/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

#include "engine/core/error.h"
#include "techniques/reflections/reflector_parts.h"

namespace gfxrepro::reflections {

namespace {

constexpr int kMostReflectors = 0xFFFF;    // 16 bits of the G-buffer
constexpr float kPlanarTolerance = 1e-3F;  // see Object::isPlanar
constexpr float kHangingBelowTop = 0.05F;  // of the box's height: the light that is made up
constexpr float kMadeUpLightIntensity = 0.9F;

const scene::Mesh& meshOf(const scene::Scene& scene, const scene::Instance& instance) {
    return scene.meshes[static_cast<std::size_t>(instance.mesh)];
}

/// Leaves out the instances that let light through; motions follow their instances. Returns how
/// many it were.
int dropTransmissive(scene::Scene& scene) {
    std::vector<scene::Instance> kept;
    std::vector<int> newIndex;
    for (const scene::Instance& instance : scene.instances) {
        const bool isKept = !isTransmissive(materialOf(scene, meshOf(scene, instance)));
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

/// Unit normals of all vertices, those that the mesh has where they are usable.
std::vector<glm::vec3> repairedNormals(const scene::Mesh& mesh) {
    std::vector<glm::vec3> normals = mesh.normals;
    normals.resize(mesh.positions.size(), glm::vec3(0.0F));
    if (!std::all_of(normals.begin(), normals.end(), isUsable)) {
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

ReflectiveScene::ReflectiveScene(const scene::Scene& scene, const ReflectorRule& rule,
                                 TextureFilter filter)
    : scene_(scene), rule_(rule), filter_(filter) {
    for (const std::string& line : scene_.warnings) warn(line);
    const int transmissiveCount = dropTransmissive(scene_);
    if (transmissiveCount > 0) {
        warn(fmt::format("{} of {} objects let light through and are left out", transmissiveCount,
                         scene.instances.size()));
    }
    std::vector<PartOrigin> parts;
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        parts.push_back({static_cast<int>(i), false});
    }
    if (rule.splitsParts) {
        parts = splitIntoParts(scene_, [&](const scene::Mesh& mesh) {
            return isSmooth(scene_, mesh, rule.maxRoughness);
        });
    }
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        addObject(scene_.instances[i]);
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
    addLights();
    fillLayers(textureLayers_);
    fillLayers(valueLayers_);
}

void ReflectiveScene::addLights() {
    lights_ = scene_.lights;
    if (lights_.size() > kMaxLights) {
        warn(fmt::format("{} lights; the first {} are taken", lights_.size(), kMaxLights));
        lights_.resize(kMaxLights);
    }
    if (lights_.empty()) {
        warn("it has no light; one is hung below the top of its box (what shines lights nothing)");
        lights_.push_back(madeUpLight(boundsWorld_));
    }
}

void ReflectiveScene::warn(const std::string& what) {
    warnings_.push_back(fmt::format("scene '{}': {}", scene_.name, what));
}

void ReflectiveScene::printWarnings() const {
    for (const std::string& line : warnings_) fmt::print(stderr, "warning: {}\n", line);
}

void ReflectiveScene::printEmptyView() {
    if (hasWarnedOfEmptyView_) return;
    hasWarnedOfEmptyView_ = true;
    fmt::print(stderr,
               "warning: scene '{}': a frame shows no reflector; no errors are measured of it\n",
               scene_.name);
}

int ReflectiveScene::layerOf(Layers& layers, int texture) {
    const auto found = std::find(layers.textures.begin(), layers.textures.end(), texture);
    const auto layer = static_cast<int>(found - layers.textures.begin());
    if (found == layers.textures.end()) layers.textures.push_back(texture);
    return layer;
}

void ReflectiveScene::fillLayers(Layers& layers) {
    const auto imageOf = [&](int texture) -> const image::Image8& {
        return scene_.textures[static_cast<std::size_t>(texture)];
    };
    int largest = kLeastLayerSizePx;
    for (const int texture : layers.textures) {
        largest = std::max({largest, imageOf(texture).width(), imageOf(texture).height()});
    }
    const auto bytesOf = [&](int sizePx) {
        return 4 * layers.textures.size() * static_cast<std::size_t>(sizePx) *
               static_cast<std::size_t>(sizePx);
    };
    int sizePx = largest >= kMostLayerSizePx
                     ? kMostLayerSizePx
                     : static_cast<int>(std::bit_ceil(static_cast<unsigned>(largest)));
    while (sizePx > kLeastLayerSizePx && bytesOf(sizePx) > kMostLayersBytes) sizePx /= 2;
    const auto reduced =
        std::count_if(layers.textures.begin(), layers.textures.end(), [&](int texture) {
            return std::max(imageOf(texture).width(), imageOf(texture).height()) > sizePx;
        });
    if (reduced > 0) {
        warn(fmt::format("{} of {} {} textures are reduced to {} texels a side; the largest has {}",
                         reduced, layers.textures.size(),
                         layers.kind == TexelKind::Colours ? "colour" : "material", sizePx,
                         largest));
    }
    for (const int texture : layers.textures) {
        layers.levels.front().push_back(textureLayer(imageOf(texture), sizePx, layers.kind));
    }
    if (filter_ == TextureFilter::FinestLevel || layers.textures.empty()) return;
    for (; sizePx > 1; sizePx /= 2) {
        std::vector<image::Image8> coarser;
        for (const image::Image8& layer : layers.levels.back()) {
            coarser.push_back(halvedLayer(layer, layers.kind));
        }
        layers.levels.push_back(std::move(coarser));
    }
}

void ReflectiveScene::addObject(const scene::Instance& instance) {
    const scene::Mesh& mesh = meshOf(scene_, instance);
    const scene::Material material = materialOf(scene_, mesh);
    Object object;
    object.baseColor = glm::vec3(material.baseColor);
    object.emissive = material.emissive;
    if (isTextured(mesh, material.baseColorTexture)) {
        object.textureLayer = layerOf(textureLayers_, material.baseColorTexture);
    }
    if (isTextured(mesh, material.emissiveTexture)) {
        object.emissiveLayer = layerOf(textureLayers_, material.emissiveTexture);
    }
    if (isTextured(mesh, material.normalTexture)) {
        object.normalLayer = layerOf(valueLayers_, material.normalTexture);
        object.normalScale = material.normalScale;
    }
    addReflection(mesh, material, object);
    addGeometry(mesh, object);
    objects_.push_back(object);
}

void ReflectiveScene::addReflection(const scene::Mesh& mesh, const scene::Material& material,
                                    Object& object) {
    if (!isSmooth(scene_, mesh, rule_.maxRoughness)) return;
    object.reflectivity = reflectivityOf(material, material.metallic);
    object.glossiness = in255ths(material.roughness);
    if (isTextured(mesh, material.metallicRoughnessTexture)) {
        object.metallicRoughnessLayer = layerOf(valueLayers_, material.metallicRoughnessTexture);
        object.metallic = material.metallic;
        object.roughness = material.roughness;
        object.headOnReflectivity = headOnReflectivity(material.indexOfRefraction);
        object.maxRoughness = rule_.maxRoughness;
        object.hasOneGlossiness = false;
        object.reflector = ++reflectorCount_;
    } else if (object.reflectivity > 0.0F) {
        object.reflector = ++reflectorCount_;
    }
}

void ReflectiveScene::addGeometry(const scene::Mesh& mesh, Object& object) {
    const auto firstVertex = static_cast<std::uint32_t>(geometry_.positions.size());
    object.firstTriangle = static_cast<std::uint32_t>(geometry_.triangles.size());
    object.triangleCount = static_cast<std::uint32_t>(mesh.triangles.size());
    object.boundsMesh = mesh.bounds();

    const std::vector<glm::vec3> normals = repairedNormals(mesh);
    if (object.reflector != 0) {
        object.isPlanar = object.normalLayer < 0 &&
                          isPlanar(mesh.positions, normals, glm::length(object.boundsMesh.size()));
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

bool ReflectiveScene::hasMaterialTextures() const {
    return std::any_of(objects_.begin(), objects_.end(), [](const Object& object) {
        return object.metallicRoughnessLayer >= 0 || object.normalLayer >= 0 ||
               object.emissiveLayer >= 0;
    });
}

float ReflectiveScene::diagonalM() const {
    return glm::length(boundsWorld_.size());
}

void ReflectiveScene::setGlossiness(float glossiness) {
    GFXREPRO_ASSERT(glossiness >= 0.0F && glossiness <= 1.0F);
    for (Object& object : objects_) {
        if (object.reflector == 0) continue;
        object.glossiness = in255ths(glossiness);
        object.hasOneGlossiness = true;
    }
}

}  // namespace gfxrepro::reflections
