#include "techniques/reflections/gpu_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

namespace {

/// Object of shaders/objects.glsl.
struct ObjectRecord {
    glm::mat4 worldFromMesh;
    glm::mat4 normalFromMesh;
    glm::vec4 baseColor;
    glm::vec4 emissive;
    glm::ivec4 layers;
    glm::vec4 reflection;
    std::int32_t textureLayer;
    std::uint32_t surface;
    std::uint32_t padding[2];
};
static_assert(offsetof(ObjectRecord, layers) == 160 &&
              offsetof(ObjectRecord, textureLayer) == 192 && sizeof(ObjectRecord) == 208);

/// Lights of shaders/shading.glsl, std140.
struct LightRecord {
    glm::vec4 position;
    glm::vec4 intensity;
};
static_assert(sizeof(LightRecord) == 32);

/// scene::normalMatrix(), scaled so that small instances do not underflow.
glm::mat4 normalMatrix(const glm::mat4& worldFromMesh) {
    const glm::mat3 cofactors = scene::normalMatrix(glm::mat3(worldFromMesh));
    float largest = 0.0F;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            largest = std::max(largest, std::abs(cofactors[column][row]));
        }
    }
    return glm::mat4(largest > 0.0F ? cofactors / largest : cofactors);
}

scene::Box transformed(const scene::Box& box, const glm::mat4& matrix) {
    scene::Box result;
    if (box.isEmpty()) return result;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point((corner & 1) != 0 ? box.max.x : box.min.x,
                              (corner & 2) != 0 ? box.max.y : box.min.y,
                              (corner & 4) != 0 ? box.max.z : box.min.z);
        result.add(glm::vec3(matrix * glm::vec4(point, 1.0F)));
    }
    return result;
}

std::uint32_t packed255ths(float value) {
    return static_cast<std::uint32_t>(std::lround(255.0F * value));
}

/// In a record, a layer with how it is read.
constexpr int kWrapBit = 16, kNearestBit = 20;

std::int32_t withSampling(int layer, const std::vector<scene::Sampling>& samplings) {
    if (layer < 0) return layer;
    const scene::Sampling& sampling = samplings[static_cast<std::size_t>(layer)];
    return layer | static_cast<int>(sampling.u) << kWrapBit |
           static_cast<int>(sampling.v) << (kWrapBit + 2) |
           (sampling.isNearest ? 1 << kNearestBit : 0);
}

ObjectRecord recordOf(const ReflectiveScene& scene, const Object& object, const glm::mat4& pose) {
    ObjectRecord record{};
    record.worldFromMesh = pose;
    record.normalFromMesh = normalMatrix(pose);
    record.baseColor = glm::vec4(object.baseColor, 0.0F);
    record.emissive = glm::vec4(object.emissive, object.normalScale);
    const auto colours = [&](int layer) { return withSampling(layer, scene.textureSamplings()); };
    const auto values = [&](int layer) { return withSampling(layer, scene.valueSamplings()); };
    record.textureLayer = colours(object.textureLayer);
    record.layers = {values(object.metallicRoughnessLayer), values(object.normalLayer),
                     colours(object.emissiveLayer), object.hasOneGlossiness ? 1 : 0};
    record.reflection = {object.metallic, object.roughness, object.headOnReflectivity,
                         object.maxRoughness};
    if (object.reflector != 0) {
        record.surface = static_cast<std::uint32_t>(object.reflector) |
                         packed255ths(object.reflectivity) << 16 |
                         packed255ths(object.glossiness) << 24;
    }
    return record;
}

gl::Buffer lightsBuffer(std::span<const scene::PointLight> lights) {
    GFXREPRO_ASSERT(lights.size() <= kMaxLights);
    std::array<LightRecord, kMaxLights> records{};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        records[i] = {glm::vec4(lights[i].position, lights[i].radiusM),
                      glm::vec4(lights[i].intensity, 0.0F)};
    }
    return gl::Buffer::of(std::span<const LightRecord>(records));
}

gl::Texture layersTexture(const TextureLevels& levels, GLenum format) {
    // A sampler needs a texture, also where no object asks for one.
    const bool isEmpty = levels.front().empty();
    const int sizePx = isEmpty ? 1 : levels.front().front().width();
    const auto layerCount = isEmpty ? 1 : static_cast<int>(levels.front().size());
    gl::Texture texture = gl::Texture::make2DArray(format, glm::ivec2(sizePx), layerCount,
                                                   static_cast<int>(levels.size()));
    for (std::size_t level = 0; level < levels.size(); ++level) {
        std::vector<std::uint8_t> texels;
        for (const image::Image8& layer : levels[level]) {
            texels.insert(texels.end(), layer.values().begin(), layer.values().end());
        }
        if (isEmpty) texels.assign(4, 255);
        texture.upload(GL_RGBA, GL_UNSIGNED_BYTE, texels.data(), static_cast<int>(level));
    }
    // Shaders mix levels themselves: shaders/shading.glsl.
    texture.setFilter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    texture.setWrap(GL_REPEAT);
    return texture;
}

}  // namespace

gl::Defines objectDefines() {
    gl::Defines defines = gpu_scene::attributeDefines();
    defines["kMatrix"] = static_cast<int>(kMatrixAttribute);
    defines["kObjectIndex"] = static_cast<int>(kObjectIndexAttribute);
    return defines;
}

gl::Defines surfaceDefines(const ReflectiveScene& scene) {
    gl::Defines defines = objectDefines();
    defines["FILTERS_TEXTURES"] = scene.textureFilter() == TextureFilter::Footprint ? 1 : 0;
    defines["LIGHT_COUNT"] = static_cast<int>(scene.lights().size());
    defines["MATERIAL_TEXTURES"] = scene.hasMaterialTextures() ? 1 : 0;
    defines["MAX_LIGHTS"] = kMaxLights;
    defines["NEAREST_BIT"] = kNearestBit;
    const auto isOther = [](const scene::Sampling& each) { return each != scene::Sampling{}; };
    defines["SAMPLINGS"] = std::ranges::any_of(scene.textureSamplings(), isOther) ||
                                   std::ranges::any_of(scene.valueSamplings(), isOther)
                               ? 1
                               : 0;
    defines["TEXTURES"] = std::ranges::any_of(scene.objects(), &Object::isTextured) ? 1 : 0;
    defines["WRAP_BIT"] = kWrapBit;
    defines["WRAP_MIRROR"] = static_cast<int>(scene::Sampling::Wrap::Mirror);
    defines["WRAP_REPEAT"] = static_cast<int>(scene::Sampling::Wrap::Repeat);
    return defines;
}

GpuObjects::GpuObjects(const ReflectiveScene& scene, bool splitsDraws)
    : scene_(&scene),
      positions_(gl::Buffer::of(scene.geometry().positions)),
      normals_(gl::Buffer::of(scene.geometry().normals)),
      texcoords_(gl::Buffer::of(scene.geometry().texcoords)),
      colors_(gl::Buffer::of(scene.geometry().colors)),
      indices_(gl::Buffer::of(scene.geometry().triangles)),
      objectOfTriangle_(gl::Buffer::of(scene.geometry().objectOfTriangle)),
      records_(scene.objects().size() * sizeof(ObjectRecord)),
      lights_(lightsBuffer(scene.lights())),
      textureLayers_(layersTexture(scene.textureLevels(), GL_SRGB8_ALPHA8)),
      valueLayers_(layersTexture(scene.valueLevels(), GL_RGBA8)),
      objectCount_(static_cast<std::uint32_t>(scene.objects().size())),
      triangleCount_(static_cast<std::uint32_t>(scene.geometry().triangles.size())),
      splitsDraws_(splitsDraws) {
    std::vector<std::uint32_t> indices(objectCount_);
    std::iota(indices.begin(), indices.end(), 0U);
    objectIndices_ = gl::Buffer::of(indices);
    vertexArray_.setAttribute(gpu_scene::kPosition, positions_, 3);
    vertexArray_.setAttribute(gpu_scene::kNormal, normals_, 3);
    vertexArray_.setAttribute(gpu_scene::kTexcoord, texcoords_, 2);
    vertexArray_.setAttribute(gpu_scene::kColor, colors_, 3);
    vertexArray_.setInstanceIndex(kObjectIndexAttribute, objectIndices_);
    vertexArray_.setIndices(indices_);
    vertexArray_.setInstanceColumns(kMatrixAttribute, records_, 4, 4, sizeof(ObjectRecord),
                                    offsetof(ObjectRecord, worldFromMesh));
    vertexArray_.setInstanceColumns(kMatrixAttribute + 4, records_, 3, 3, sizeof(ObjectRecord),
                                    offsetof(ObjectRecord, normalFromMesh));
    std::vector<glm::mat4> restPose;
    for (const scene::Instance& instance : scene.scene().instances) {
        restPose.push_back(instance.worldFromMesh);
    }
    setPoses(restPose);
}

void GpuObjects::setPoses(std::span<const glm::mat4> poses) {
    GFXREPRO_ASSERT_EQ(poses.size(), scene_->objects().size());
    poses_.assign(poses.begin(), poses.end());
    boundsWorld_.clear();
    std::vector<ObjectRecord> records;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Object& object = scene_->objects()[i];
        boundsWorld_.push_back(transformed(object.boundsMesh, poses[i]));
        records.push_back(recordOf(*scene_, object, poses[i]));
    }
    records_.write(std::span<const ObjectRecord>(records));
}

gl::Resources GpuObjects::resources() const {
    return {{"Objects", records_},
            {"Lights", lights_},
            {"textureLayers", textureLayers_},
            {"valueLayers", valueLayers_}};
}

std::vector<std::uint32_t> GpuObjects::within(const glm::mat4& clipFromWorld) const {
    const glm::mat4 rows = glm::transpose(clipFromWorld);
    const std::array<glm::vec4, 6> planes = {rows[3] + rows[0], rows[3] - rows[0],
                                             rows[3] + rows[1], rows[3] - rows[1],
                                             rows[3] + rows[2], rows[3] - rows[2]};
    std::vector<std::uint32_t> objects;
    for (std::uint32_t i = 0; i < objectCount_; ++i) {
        const scene::Box& box = boundsWorld_[i];
        if (box.isEmpty()) continue;
        const bool isInside = std::ranges::all_of(planes, [&](const glm::vec4& plane) {
            const glm::vec3 normal(plane);
            return glm::dot(normal, box.centre()) + plane.w +
                       glm::dot(glm::abs(normal), 0.5F * box.size()) >=
                   0.0F;
        });
        if (isInside) objects.push_back(i);
    }
    return objects;
}

std::uint32_t GpuObjects::mostTrianglesPerDraw() const {
    return kit::FlushedDraws(splitsDraws_).mostPrimitives();
}

void GpuObjects::draw(std::span<const std::uint32_t> objects) const {
    vertexArray_.bind();
    kit::FlushedDraws draws(splitsDraws_);
    for (const std::uint32_t index : objects) {
        const Object& object = scene_->objects()[index];
        draws.draw(object.firstTriangle, object.triangleCount,
                   [&](std::uint32_t first, std::uint32_t count) {
                       glDrawElementsInstancedBaseInstance(
                           GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                           kit::indexOffset(first), 1, index);
                   });
    }
}

void GpuObjects::drawAll() const {
    std::vector<std::uint32_t> all(objectCount_);
    std::iota(all.begin(), all.end(), 0U);
    draw(all);
}

}  // namespace gfxrepro::reflections
