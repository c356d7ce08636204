#include "techniques/reflections/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

#include "engine/core/error.h"
#include "engine/image/srgb.h"

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
    const int transmissiveCount = dropTransmissive(scene_);
    if (transmissiveCount > 0) {
        warn(fmt::format("{} of {} objects let light through and are left out", transmissiveCount,
                         scene.instances.size()));
    }
    for (scene::Mesh& mesh : scene_.meshes) {
        if (mesh.isFlat) mesh = scene::withTriangleNormals(mesh);
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
    const auto masked = std::ranges::count_if(
        scene_.materials, [](const scene::Material& each) { return each.alphaCutoff > 0.0F; });
    if (masked > 0) warn(fmt::format("materials whose alphaMode MASK cuts no holes: {}", masked));
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
        layers.samplings.push_back(samplingOf(scene_, texture));
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

namespace {

/// How much of each of the texels first, first + 1, … a resampled one covers; the sum is 1.
struct Cover {
    int first = 0;
    std::vector<float> weights;
};

std::vector<Cover> coversOf(int fromSize, int toSize) {
    std::vector<Cover> covers(static_cast<std::size_t>(toSize));
    const double scale = static_cast<double>(fromSize) / toSize;
    for (int i = 0; i < toSize; ++i) {
        const double begin = i * scale;
        const double end = begin + scale;
        Cover& cover = covers[static_cast<std::size_t>(i)];
        cover.first = std::min(static_cast<int>(begin), fromSize - 1);
        for (int from = cover.first; from < fromSize && (from < end || from == cover.first);
             ++from) {
            const double overlap = std::min(end, from + 1.0) - std::max(begin, double(from));
            cover.weights.push_back(static_cast<float>(std::max(overlap, 0.0) / scale));
        }
    }
    return covers;
}

image::Image8 toBytes(const image::ImageF& values) {
    image::Image8 bytes(values.width(), values.height(), values.channels());
    std::transform(
        values.values().begin(), values.values().end(), bytes.values().begin(), [](float value) {
            return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
        });
    return bytes;
}

/// 4 channels, with an alpha of 1 where there was none.
image::Image8 withAlpha(const image::Image8& image) {
    if (image.channels() == 4) return image;
    image::Image8 result(image.width(), image.height(), 4);
    const std::uint8_t* from = image.values().data();
    for (std::size_t i = 0; i < result.values().size(); i += 4, from += 3) {
        std::copy_n(from, 3, result.values().begin() + static_cast<std::ptrdiff_t>(i));
        result.values()[i + 3] = 255;
    }
    return result;
}

}  // namespace

std::array<float, 256> decodingOf(TexelKind kind) {
    if (kind == TexelKind::Colours) return image::srgbDecoding();
    std::array<float, 256> decoding{};
    for (std::size_t i = 0; i < decoding.size(); ++i) {
        decoding[i] = static_cast<float>(i) / 255.0F;
    }
    return decoding;
}

image::Image8 textureLayer(const image::Image8& image, int sizePx, TexelKind kind) {
    GFXREPRO_ASSERT(image.channels() >= 3 && !image.empty());
    if (image.width() == sizePx && image.height() == sizePx) return withAlpha(image);
    const std::array<float, 256> decoding = decodingOf(kind);
    const auto value = [&](int x, int y, int channel) {
        if (channel < 3) return decoding[image.at(x, y, channel)];
        return image.channels() > 3 ? static_cast<float>(image.at(x, y, 3)) / 255.0F : 1.0F;
    };
    // Across first, then down.
    const std::vector<Cover> across = coversOf(image.width(), sizePx);
    image::ImageF rows(sizePx, image.height(), 4);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < sizePx; ++x) {
            const Cover& cover = across[static_cast<std::size_t>(x)];
            for (int channel = 0; channel < 4; ++channel) {
                int from = cover.first;
                for (const float weight : cover.weights) {
                    rows.at(x, y, channel) += weight * value(from++, y, channel);
                }
            }
        }
    }
    const std::vector<Cover> down = coversOf(image.height(), sizePx);
    image::ImageF layer(sizePx, sizePx, 4);
    for (int y = 0; y < sizePx; ++y) {
        const Cover& cover = down[static_cast<std::size_t>(y)];
        int from = cover.first;
        for (const float weight : cover.weights) {
            const std::span<const float> source = rows.row(from++);
            std::transform(source.begin(), source.end(), layer.row(y).begin(), layer.row(y).begin(),
                           [&](float add, float sum) { return sum + weight * add; });
        }
    }
    return kind == TexelKind::Colours ? image::toSrgb8(layer) : toBytes(layer);
}

image::Image8 halvedLayer(const image::Image8& layer, TexelKind kind) {
    GFXREPRO_ASSERT(layer.channels() == 4 && layer.width() % 2 == 0 && layer.height() % 2 == 0);
    const std::array<float, 256> decoding = decodingOf(kind);
    const std::array<float, 256> alphas = decodingOf(TexelKind::Values);
    image::ImageF half(layer.width() / 2, layer.height() / 2, 4);
    for (int y = 0; y < half.height(); ++y) {
        for (int x = 0; x < half.width(); ++x) {
            for (int channel = 0; channel < 4; ++channel) {
                const auto& decoded = channel < 3 ? decoding : alphas;
                const auto at = [&](int dx, int dy) {
                    return decoded[layer.at(2 * x + dx, 2 * y + dy, channel)];
                };
                half.at(x, y, channel) = 0.25F * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1));
            }
        }
    }
    return kind == TexelKind::Colours ? image::toSrgb8(half) : toBytes(half);
}

namespace {

constexpr float kLeastFacing = 1e-3F;  // as in texturedNormal() of shaders/shading.glsl

/// Between the texels of a level, or the nearest one, as fetchedTexel() of shaders/shading.glsl.
glm::vec3 texelOf(const image::Image8& texels, TexelKind kind, const scene::Sampling& sampling,
                  const glm::vec2& texcoord, bool isMagnified) {
    using Wrap = scene::Sampling::Wrap;
    static const std::array<float, 256> kColours = decodingOf(TexelKind::Colours);
    static const std::array<float, 256> kValues = decodingOf(TexelKind::Values);
    const std::array<float, 256>& decoding = kind == TexelKind::Colours ? kColours : kValues;
    const int sizePx = texels.width();
    const bool isNearest = isMagnified && sampling.isNearest;
    glm::ivec2 near, far;
    glm::vec2 fraction;
    for (int axis = 0; axis < 2; ++axis) {
        const Wrap wrap = axis == 0 ? sampling.u : sampling.v;
        float t = texcoord[axis];
        t = wrap == Wrap::Mirror   ? 1.0F - std::abs(t - 2.0F * std::floor(0.5F * t) - 1.0F)
            : wrap == Wrap::Repeat ? t - std::floor(t)
                                   : std::clamp(t, 0.0F, 1.0F);
        const float scaled = t * static_cast<float>(sizePx);
        const float place = isNearest ? std::floor(scaled) : scaled - 0.5F;
        const float lower = std::floor(place);
        fraction[axis] = place - lower;
        const auto wrapped = [&](int i) {
            return wrap == Wrap::Repeat ? (i + sizePx) % sizePx : std::clamp(i, 0, sizePx - 1);
        };
        near[axis] = wrapped(static_cast<int>(lower));
        far[axis] = wrapped(static_cast<int>(lower) + 1);
    }
    const auto texel = [&](int x, int y) {
        return glm::vec3(decoding[texels.at(x, y, 0)], decoding[texels.at(x, y, 1)],
                         decoding[texels.at(x, y, 2)]);
    };
    return glm::mix(glm::mix(texel(near.x, near.y), texel(far.x, near.y), fraction.x),
                    glm::mix(texel(near.x, far.y), texel(far.x, far.y), fraction.x), fraction.y);
}

}  // namespace

float ReflectiveScene::footprintAt(std::uint32_t triangle, const glm::mat4& worldFromMesh,
                                   const glm::vec3& direction, float beamArea) const {
    if (filter_ == TextureFilter::FinestLevel) return 0.0F;
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const auto edge = [&](const auto& values, int corner) {
        return values[corners[corner]] - values[corners.x];
    };
    const glm::mat3 turned(worldFromMesh);
    const glm::vec3 areaWorld =
        glm::cross(turned * edge(geometry_.positions, 1), turned * edge(geometry_.positions, 2));
    const glm::vec2 first = edge(geometry_.texcoords, 1), second = edge(geometry_.texcoords, 2);
    const float areaTexture = first.x * second.y - first.y * second.x;
    const float facing = std::max(std::abs(glm::dot(areaWorld, direction)), 1e-30F);
    return std::sqrt(beamArea * std::abs(areaTexture) * glm::length(areaWorld)) / facing;
}

glm::vec3 ReflectiveScene::texelsAt(const Layers& layers, int layer, const glm::vec2& texcoord,
                                    float footprint) {
    const auto last = static_cast<float>(layers.levels.size() - 1);
    const auto sizePx =
        static_cast<float>(layers.levels.front()[static_cast<std::size_t>(layer)].width());
    const float level = std::clamp(std::log2(std::max(footprint * sizePx, 1e-30F)), 0.0F, last);
    const auto finer = static_cast<std::size_t>(level);
    const auto at = [&](std::size_t ofLevel) {
        return texelOf(layers.levels[ofLevel][static_cast<std::size_t>(layer)], layers.kind,
                       layers.samplings[static_cast<std::size_t>(layer)], texcoord, level == 0.0F);
    };
    const float fraction = level - static_cast<float>(finer);
    return fraction == 0.0F ? at(finer) : glm::mix(at(finer), at(finer + 1), fraction);
}

glm::vec3 ReflectiveScene::albedoAt(std::uint32_t triangle, const glm::vec2& barycentric,
                                    float footprint) const {
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    const glm::vec3 albedo =
        object.baseColor * scene::interpolated(geometry_.colors, corners, barycentric);
    if (object.textureLayer < 0) return albedo;
    return albedo * texelsAt(textureLayers_, object.textureLayer,
                             scene::interpolated(geometry_.texcoords, corners, barycentric),
                             footprint);
}

glm::vec3 ReflectiveScene::emissiveAt(std::uint32_t triangle, const glm::vec2& barycentric,
                                      float footprint) const {
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    if (object.emissiveLayer < 0) return object.emissive;
    return object.emissive *
           texelsAt(
               textureLayers_, object.emissiveLayer,
               scene::interpolated(geometry_.texcoords, geometry_.triangles[triangle], barycentric),
               footprint);
}

glm::vec3 ReflectiveScene::texturedNormalAt(std::uint32_t triangle, const glm::vec2& barycentric,
                                            const glm::mat4& worldFromMesh,
                                            const glm::vec3& normalWorld, const glm::vec3& toViewer,
                                            float footprint) const {
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const auto edge = [&](int corner) {
        return glm::mat3(worldFromMesh) *
               (geometry_.positions[corners[corner]] - geometry_.positions[corners.x]);
    };
    const auto texcoordEdge = [&](int corner) {
        return geometry_.texcoords[corners[corner]] - geometry_.texcoords[corners.x];
    };
    const glm::vec3 first = edge(1), second = edge(2);
    const glm::vec2 uvFirst = texcoordEdge(1), uvSecond = texcoordEdge(2);
    const glm::vec3 texel =
        2.0F * texelsAt(valueLayers_, object.normalLayer,
                        scene::interpolated(geometry_.texcoords, corners, barycentric), footprint) -
        1.0F;
    const glm::vec3 acrossSecond = glm::cross(second, normalWorld);
    const glm::vec3 acrossFirst = glm::cross(normalWorld, first);
    const glm::vec3 alongU = acrossSecond * uvFirst.x + acrossFirst * uvSecond.x;
    const glm::vec3 alongV = acrossSecond * uvFirst.y + acrossFirst * uvSecond.y;
    const float squaredU = glm::dot(alongU, alongU), squaredV = glm::dot(alongV, alongV);
    glm::vec3 normal = normalWorld;
    if (std::min(squaredU, squaredV) > 0.0F) {
        const float side = glm::dot(glm::cross(first, second), normalWorld) < 0.0F ? -1.0F : 1.0F;
        const float scale = side * object.normalScale;
        normal = scale * (texel.x / std::sqrt(squaredU) * alongU -
                          texel.y / std::sqrt(squaredV) * alongV) +
                 texel.z * normalWorld;
        normal = glm::dot(normal, normal) > 0.0F ? glm::normalize(normal) : normalWorld;
    }
    if (isTurnedAway(normalWorld, toViewer, glm::cross(first, second))) normal = -normal;
    const float facing = glm::dot(normal, toViewer);
    if (facing < kLeastFacing) {
        normal = glm::normalize(normal + (kLeastFacing - facing) * toViewer);
    }
    return normal;
}

glm::vec3 ReflectiveScene::normalMeshAt(std::uint32_t triangle,
                                        const glm::vec2& barycentric) const {
    return scene::interpolated(geometry_.normals, geometry_.triangles[triangle], barycentric);
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
