#include "techniques/clustered_reflections/detail_levels.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>
#include <map>
#include <span>

namespace gfxrepro::clustered_reflections {
namespace {

using reflections::ObjectGeometry;

/// More are several parts, so that what is near makes fine only itself.
constexpr std::size_t kPartTriangles = 4096;
/// A level of so few is not made coarser, and one that saves less than a tenth is not kept.
constexpr std::size_t kFewTriangles = 24;
constexpr std::size_t kMostLevels = 12;
/// Of the scene's diagonal: how far from the surface white lies, seen as shape.
constexpr float kLiftOfWhite = 0.2F;

using Indices = std::vector<std::uint32_t>;

/// The vertices of some triangles, numbered from 0; those alike in everything are one.
struct LocalMesh {
    std::vector<std::uint32_t> vertices;  // of the geometry
    std::vector<glm::vec3> lifted;        // their places, moved by their colours
    Indices indices;
};

std::vector<float> valuesOf(const glm::vec3& value) {
    return {value.x, value.y, value.z};
}

LocalMesh localMesh(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
                    float liftOfWhite) {
    LocalMesh mesh;
    std::map<std::vector<float>, std::uint32_t> known;
    struct Weld {
        glm::vec3 normal{0.0F}, color{0.0F};
        float count = 0.0F;
    };
    std::map<std::vector<float>, Weld> welds;
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangle[corner];
            std::vector<float> key = valuesOf(geometry.positions[vertex]);
            Weld& weld = welds[key];
            for (const glm::vec3& value : {geometry.normals[vertex], geometry.colors[vertex],
                                           glm::vec3(geometry.texcoords[vertex], 0.0F)}) {
                const std::vector<float> more = valuesOf(value);
                key.insert(key.end(), more.begin(), more.end());
            }
            const auto [at, isNew] =
                known.emplace(std::move(key), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (isNew) {
                mesh.vertices.push_back(vertex);
                weld.normal += geometry.normals[vertex];
                weld.color += geometry.colors[vertex];
                weld.count += 1.0F;
            }
            mesh.indices.push_back(at->second);
        }
    }
    // Vertices at one place move alike: no seam opens.
    for (const std::uint32_t vertex : mesh.vertices) {
        const Weld& weld = welds[valuesOf(geometry.positions[vertex])];
        const float length = glm::length(weld.normal);
        const glm::vec3 up = length > 1e-6F ? weld.normal / length : glm::vec3(0.0F);
        const glm::vec3 color = weld.color / weld.count;
        const float light = (color.r + color.g + color.b) / 3.0F;
        mesh.lifted.push_back(geometry.positions[vertex] + liftOfWhite * light * up);
    }
    return mesh;
}

/// The corners in the order in which the triangle's normal points to the side of its vertices'.
glm::uvec3 wound(const ObjectGeometry& geometry, const glm::uvec3& triangle) {
    const auto& positions = geometry.positions;
    const glm::vec3 normal = glm::cross(positions[triangle.y] - positions[triangle.x],
                                        positions[triangle.z] - positions[triangle.x]);
    const glm::vec3 lit =
        geometry.normals[triangle.x] + geometry.normals[triangle.y] + geometry.normals[triangle.z];
    return glm::dot(normal, lit) < 0.0F ? glm::uvec3(triangle.x, triangle.z, triangle.y) : triangle;
}

/// Appends triangles in an order of places, cut into chunks.
void addChunks(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
               std::uint32_t object, DetailLevels& levels) {
    if (triangles.empty()) return;
    Indices sorted(3 * triangles.size());
    // Whole vertex arrays would be sorted once a level: the part's range of them is enough.
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), last = 0;
    for (const glm::uvec3& triangle : triangles) {
        first = std::min({first, triangle.x, triangle.y, triangle.z});
        last = std::max({last, triangle.x, triangle.y, triangle.z});
    }
    Indices indices;
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) indices.push_back(triangle[corner] - first);
    }
    meshopt_spatialSortTriangles(sorted.data(), indices.data(), indices.size(),
                                 &geometry.positions[first].x, last - first + 1, sizeof(glm::vec3));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const glm::uvec3 corners = wound(
            geometry, glm::uvec3(sorted[3 * t], sorted[3 * t + 1], sorted[3 * t + 2]) + first);
        if (t % kChunkTriangles == 0) {
            const std::size_t count = std::min<std::size_t>(kChunkTriangles, triangles.size() - t);
            levels.chunks.push_back({static_cast<std::uint32_t>(levels.triangles.size()),
                                     static_cast<std::uint32_t>(count), object, 0});
        }
        levels.triangles.emplace_back(corners, object);
    }
}

void addLevel(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
              float errorMesh, DetailLevels& levels) {
    DetailPart& part = levels.parts.back();
    const auto firstChunk = static_cast<std::uint32_t>(levels.chunks.size());
    addChunks(geometry, triangles, part.object, levels);
    const auto count = static_cast<std::uint32_t>(levels.chunks.size()) - firstChunk;
    levels.levels.push_back({errorMesh, firstChunk, count, 0});
    ++part.levelCount;
}

void addCoarserLevels(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
                      float liftOfWhite, bool isBorderKept, DetailLevels& levels) {
    const LocalMesh mesh = localMesh(geometry, triangles, liftOfWhite);
    const float* positions = &mesh.lifted.front().x;
    const float unitsPerError =
        meshopt_simplifyScale(positions, mesh.lifted.size(), sizeof(glm::vec3));
    const unsigned options = isBorderKept ? unsigned{meshopt_SimplifyLockBorder} : 0U;
    Indices indices = mesh.indices;
    float errorMesh = 0.0F;
    for (std::size_t level = 1; level < kMostLevels; ++level) {
        if (indices.size() / 3 <= kFewTriangles) return;
        Indices coarser(indices.size());
        float error = 0.0F;
        const std::size_t wanted = indices.size() / 6 * 3;
        coarser.resize(meshopt_simplify(coarser.data(), indices.data(), indices.size(), positions,
                                        mesh.lifted.size(), sizeof(glm::vec3), wanted, 1.0F,
                                        options, &error));
        if (coarser.empty() || coarser.size() > indices.size() / 10 * 9) return;
        indices = std::move(coarser);
        errorMesh += error * unitsPerError;
        std::vector<glm::uvec3> chosen;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            chosen.emplace_back(mesh.vertices[indices[i]], mesh.vertices[indices[i + 1]],
                                mesh.vertices[indices[i + 2]]);
        }
        addLevel(geometry, chosen, errorMesh, levels);
    }
}

void addPart(const reflections::ReflectiveScene& scene, std::span<const glm::uvec3> triangles,
             std::uint32_t object, bool isSimplified, bool isWhole, DetailLevels& levels) {
    scene::Box box;
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            box.add(scene.geometry().positions[triangle[corner]]);
        }
    }
    levels.parts.push_back({glm::vec4(box.centre(), 1.0F), glm::vec4(0.5F * box.size(), 0.0F),
                            object, static_cast<std::uint32_t>(levels.levels.size()), 0, 0});
    addLevel(scene.geometry(), triangles, 0.0F, levels);
    if (isSimplified) {
        addCoarserLevels(scene.geometry(), triangles, kLiftOfWhite * scene.diagonalM(), !isWhole,
                         levels);
    }
}

}  // namespace

DetailLevels detailLevels(const reflections::ReflectiveScene& scene, bool isSimplified) {
    DetailLevels levels;
    const ObjectGeometry& geometry = scene.geometry();
    for (std::uint32_t i = 0; i < scene.objects().size(); ++i) {
        const reflections::Object& object = scene.objects()[i];
        levels.firstChunkOfObject.push_back(static_cast<std::uint32_t>(levels.chunks.size()));
        const std::span<const glm::uvec3> all(&geometry.triangles[object.firstTriangle],
                                              object.triangleCount);
        if (all.size() <= kPartTriangles) {
            if (!all.empty()) addPart(scene, all, i, isSimplified, true, levels);
            continue;
        }
        // In an order of places, as the chunks: each part is a neighbourhood.
        DetailLevels order;
        addChunks(geometry, all, i, order);
        std::vector<glm::uvec3> sorted;
        for (const glm::uvec4& triangle : order.triangles) sorted.emplace_back(triangle);
        for (std::size_t at = 0; at < sorted.size(); at += kPartTriangles) {
            const std::size_t count = std::min(kPartTriangles, sorted.size() - at);
            addPart(scene, std::span(sorted).subspan(at, count), i, isSimplified, false, levels);
        }
    }
    levels.firstChunkOfObject.push_back(static_cast<std::uint32_t>(levels.chunks.size()));
    return levels;
}

}  // namespace gfxrepro::clustered_reflections
