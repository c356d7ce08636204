#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gfxrepro::scene {
namespace {

glm::vec3 transformedPoint(const glm::mat4& matrix, const glm::vec3& point) {
    return glm::vec3(matrix * glm::vec4(point, 1.0F));
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Which attributes every instanced mesh has, and the material if all have the same one.
struct CommonParts {
    bool normals = true;
    bool texcoords = true;
    bool colors = true;
    int material = -1;
};

CommonParts commonParts(const Scene& scene) {
    CommonParts common;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        common.normals &= !mesh.normals.empty();
        common.texcoords &= !mesh.texcoords.empty();
        common.colors &= !mesh.colors.empty();
        if (i == 0) common.material = mesh.material;
        if (mesh.material != common.material) common.material = -1;
    }
    return common;
}

void appendInstance(Mesh& result, const Mesh& mesh, const glm::mat4& worldFromMesh,
                    const CommonParts& common) {
    const auto firstVertex = static_cast<std::uint32_t>(result.positions.size());
    for (const glm::vec3& position : mesh.positions) {
        result.positions.push_back(transformedPoint(worldFromMesh, position));
    }
    if (common.normals) {
        const glm::mat3 toWorld = normalMatrix(glm::mat3(worldFromMesh));
        for (const glm::vec3& normal : mesh.normals) {
            result.normals.push_back(unitOrZero(toWorld * normal));
        }
    }
    if (common.texcoords) append(result.texcoords, mesh.texcoords);
    if (common.colors) append(result.colors, mesh.colors);
    // A mirror turns counter-clockwise into clockwise: turn it back.
    const bool isMirrored = glm::determinant(glm::mat3(worldFromMesh)) < 0.0F;
    for (glm::uvec3 triangle : mesh.triangles) {
        if (isMirrored) std::swap(triangle.y, triangle.z);
        result.triangles.push_back(triangle + firstVertex);
    }
}

}  // namespace

Box Mesh::bounds() const {
    Box box;
    for (const glm::vec3& position : positions) box.add(position);
    return box;
}

std::size_t Mesh::sizeBytes() const {
    return positions.size() * sizeof(glm::vec3) + normals.size() * sizeof(glm::vec3) +
           texcoords.size() * sizeof(glm::vec2) + colors.size() * sizeof(glm::vec3) +
           triangles.size() * sizeof(glm::uvec3);
}

Box PointCloud::bounds() const {
    Box box;
    for (const glm::vec3& position : positions) box.add(position);
    return box;
}

Box Scene::bounds() const {
    Box box = points.bounds();
    if (heights) box.add(heights->bounds());
    for (const Instance& instance : instances) {
        for (const glm::vec3& position : meshes[instance.mesh].positions) {
            box.add(transformedPoint(instance.worldFromMesh, position));
        }
    }
    return box;
}

std::size_t Scene::triangleCount() const {
    std::size_t count = 0;
    for (const Instance& instance : instances) count += meshes[instance.mesh].triangles.size();
    return count;
}

std::size_t Scene::vertexCount() const {
    std::size_t count = 0;
    for (const Instance& instance : instances) count += meshes[instance.mesh].positions.size();
    return count;
}

Material materialOf(const Scene& scene, const Mesh& mesh) {
    return mesh.material < 0 ? Material{}
                             : scene.materials[static_cast<std::size_t>(mesh.material)];
}

Sampling samplingOf(const Scene& scene, int texture) {
    const auto index = static_cast<std::size_t>(texture);
    return index < scene.samplings.size() ? scene.samplings[index] : Sampling{};
}

glm::vec3 unitOrZero(const glm::vec3& vector) {
    const float length = glm::length(vector);
    return length > 0.0F ? vector / length : glm::vec3(0.0F);
}

glm::mat3 normalMatrix(const glm::mat3& matrix) {
    const glm::mat3 cofactors(glm::cross(matrix[1], matrix[2]), glm::cross(matrix[2], matrix[0]),
                              glm::cross(matrix[0], matrix[1]));
    return glm::determinant(matrix) < 0.0F ? -cofactors : cofactors;
}

glm::dvec3 offsetOf(const Box& box) {
    constexpr double kFarDiagonals = 16.0, kFarM = 1e4;  // a float's step there: a millimetre
    constexpr double kVeryFarDiagonals = 4096.0;
    glm::dvec3 offset(0.0);
    if (box.isEmpty()) return offset;
    const glm::dvec3 low(box.min);
    const glm::dvec3 high(box.max);
    const double diagonal = glm::length(high - low);
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = std::max(std::abs(low[axis]), std::abs(high[axis]));
        const bool isFar = reach > kFarDiagonals * diagonal && reach >= kFarM;
        if (!isFar && reach <= kVeryFarDiagonals * diagonal) continue;
        // Floats of such a file may be steps apart: the diagonal is known no better than a step.
        const double known = std::max(diagonal, 1e-7 * reach);
        const double unit = std::pow(10.0, std::floor(std::log10(known)));
        offset[axis] = std::round(0.5 * (low[axis] + high[axis]) / unit) * unit;
    }
    return offset;
}

Mesh flattened(const Scene& scene) {
    if (scene.instances.size() == 1 && scene.instances[0].worldFromMesh == glm::mat4(1.0F)) {
        return scene.meshes[scene.instances[0].mesh];
    }
    const std::size_t vertexCount = scene.vertexCount();
    if (vertexCount > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("scene " + scene.name + ": " + std::to_string(vertexCount) +
                    " vertices do not fit into one mesh (at most 4294967295)");
    }
    const CommonParts common = commonParts(scene);
    Mesh result;
    result.name = scene.name;
    result.material = common.material;
    result.positions.reserve(vertexCount);
    if (common.normals) result.normals.reserve(vertexCount);
    if (common.texcoords) result.texcoords.reserve(vertexCount);
    if (common.colors) result.colors.reserve(vertexCount);
    result.triangles.reserve(scene.triangleCount());
    for (const Instance& instance : scene.instances) {
        appendInstance(result, scene.meshes[instance.mesh], instance.worldFromMesh, common);
    }
    return result;
}

Scene sceneOf(Mesh mesh) {
    Scene scene;
    scene.name = mesh.name;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({});
    return scene;
}

std::vector<glm::vec3> vertexNormals(const Mesh& mesh) {
    // In double precision, because the squared areas of small triangles vanish in floats.
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[triangle.x]);
        const glm::dvec3 b(mesh.positions[triangle.y]);
        const glm::dvec3 c(mesh.positions[triangle.z]);
        const glm::dvec3 twiceArea = glm::cross(b - a, c - a);
        for (int corner = 0; corner < 3; ++corner) sums[triangle[corner]] += twiceArea;
    }
    std::vector<glm::vec3> normals(sums.size(), glm::vec3(0.0F));
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double length = glm::length(sums[i]);
        if (length > 0.0) normals[i] = glm::vec3(sums[i] / length);
    }
    return normals;
}

Mesh withTriangleNormals(const Mesh& mesh) {
    Mesh result;
    result.name = mesh.name;
    result.material = mesh.material;
    const auto copy = [](const auto& from, auto& to, std::uint32_t vertex) {
        if (!from.empty()) to.push_back(from[vertex]);
    };
    for (const glm::uvec3& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(result.positions.size());
        result.triangles.emplace_back(first, first + 1, first + 2);
        for (int corner = 0; corner < 3; ++corner) {
            copy(mesh.positions, result.positions, triangle[corner]);
            copy(mesh.texcoords, result.texcoords, triangle[corner]);
            copy(mesh.colors, result.colors, triangle[corner]);
        }
    }
    result.normals = vertexNormals(result);
    return result;
}

Camera framingCamera(const Box& box, float aspect, glm::vec3 towardsEye) {
    Camera camera;
    camera.name = "framing";
    // Straight from above or below, north is at the top.
    if (towardsEye.x == 0.0F && towardsEye.z == 0.0F) camera.up = {0.0F, 0.0F, -1.0F};
    const glm::vec3 centre = box.isEmpty() ? glm::vec3(0.0F) : box.centre();
    const glm::vec3 half = 0.5F * box.size();
    const glm::vec3 back = glm::normalize(towardsEye);
    const glm::vec3 right = glm::normalize(glm::cross(camera.up, back));
    const glm::vec3 above = glm::cross(back, right);
    const float slopeY = std::tan(0.5F * camera.verticalFovRad);
    const float slopeX = slopeY * aspect;

    // The nearest eye that has every corner between its four side planes.
    float distance = 0.0F;
    float reach = 0.0F;  // half the box's depth along the view
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 offset = Box{-half, half}.corner(corner);
        const float ahead = glm::dot(offset, back);
        const float side = std::max(std::abs(glm::dot(offset, right)) / slopeX,
                                    std::abs(glm::dot(offset, above)) / slopeY);
        distance = std::max(distance, ahead + side);
        reach = std::max(reach, ahead);
    }
    constexpr float kMargin = 1.05F;  // a little air around the silhouette
    distance = distance > 0.0F ? distance * kMargin : 1.0F;

    camera.position = centre + distance * back;
    camera.target = centre;
    // Halving keeps rounding from cutting the nearest corner; the floor keeps depth usable when the
    // box touches the eye.
    camera.nearM = std::max(0.5F * (distance - reach), 1e-3F * distance);
    camera.farM = 1.5F * (distance + reach);
    return camera;
}

void addTerrainCameras(Scene& scene) {
    const HeightMap& map = *scene.heights;
    const Box box = map.bounds();
    const float greaterM = std::max(map.spacingM.x, map.spacingM.y);
    const float sideM = std::max({box.size().x, box.size().z, greaterM});
    Camera overview = framingCamera(box, 1.6F);
    overview.name = "overview";
    Camera flight;
    flight.name = "flight";
    const glm::ivec2 place(map.sizeSamples.x / 2, map.sizeSamples.y * 3 / 4);
    const glm::vec3 ground(static_cast<float>(place.x) * map.spacingM.x,
                           map.clampedHeightM(place.x, place.y),
                           static_cast<float>(place.y) * map.spacingM.y);
    const float aboveM = std::max(0.02F * sideM, 0.25F * box.size().y);
    flight.position = ground + glm::vec3(0.0F, aboveM, 0.0F);
    flight.target = flight.position + glm::vec3(0.0F, -0.25F, -1.0F) * (0.25F * sideM);
    flight.verticalFovRad = 0.7F;
    flight.nearM = std::min(0.05F * aboveM, greaterM);
    flight.farM = 2.0F * sideM + box.size().y;
    scene.cameras = {overview, flight};
}

}  // namespace gfxrepro::scene
