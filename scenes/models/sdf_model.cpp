#include <algorithm>
#include <cmath>

#include "engine/core/random.h"
#include "engine/scene/refine.h"
#include "scenes/models/shapes.h"

namespace gfxrepro::scene {
namespace {

using ShapeOf = sdf::Shape (*)(std::uint32_t seed);

constexpr Choice<ShapeOf> kModelShapes[] = {
    {shapes::blade, "blade", "turbine blade: twisted airfoil on a root block"},
    {shapes::brain, "brain", "two hemispheres with gyri, cerebellum and stem"},
    {shapes::buddha, "buddha", "sitting figure on a lotus"},
    {shapes::bunny, "bunny", "sitting rabbit"},
    {shapes::dragon, "dragon", "long body with crest, legs and horns"},
    {shapes::duck, "duck", "rubber duck"},
    {shapes::hand, "hand", "open hand, palm to the front"},
    {shapes::head, "head", "human head with neck"},
    {shapes::hip, "hip", "hip bone with socket and foramen"},
    {shapes::hugo, "hugo", "standing man"},
    {shapes::linkedTori, "linked_tori", "two rings through each other"},
    {shapes::lion, "lion", "sitting lion on a plinth"},
    {shapes::sphere, "sphere", "radius 1"},
    {shapes::torus, "torus", "radius 0.7, tube 0.3"},
    {shapes::wagner, "wagner", "bust with beret"},
};

/// Half the side of the grid's cube; every shape lies inside.
constexpr float kExtent = 1.3F;

/// A closed mesh of at most `most` triangles, but not far below, so that little is left to
/// refinement.
Mesh polygonizedBelow(const sdf::Shape& shape, std::size_t most) {
    // The count grows with the square of the resolution, which a coarse grid is enough to
    // calibrate; thin parts that it misses make the guess too high. A small mesh is worth several
    // attempts.
    constexpr float kCoarseSpacing = 2.0F * kExtent / 32.0F;
    const auto coarseCount =
        static_cast<float>(sdf::polygonized(shape, kExtent, kCoarseSpacing).triangles.size());
    for (float share = most < 200'000 ? 0.95F : 0.5F; share > 0.05F; share *= 0.9F) {
        const float spacing =
            kCoarseSpacing * std::sqrt(coarseCount / (share * static_cast<float>(most)));
        Mesh mesh = sdf::polygonized(shape, kExtent, spacing);
        if (!mesh.triangles.empty() && mesh.triangles.size() <= most) return mesh;
    }
    throw Error("no grid gives this shape with at most " + std::to_string(most) + " triangles");
}

/// Gives corners of triangles their own copies of vertices until there are `vertexCount`: real
/// models are cut open along seams of their scans and parts. Positions stay, so the surface does.
void addSeams(Mesh& mesh, std::size_t vertexCount, std::uint64_t seed) {
    std::vector<std::uint32_t> uses(mesh.positions.size(), 0);
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) ++uses[t[i]];
    }
    const std::size_t first = Random(seed).index(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        glm::uvec3& triangle = mesh.triangles[(first + k) % mesh.triangles.size()];
        for (int i = 0; i < 3; ++i) {
            if (mesh.positions.size() == vertexCount) return;
            std::uint32_t& vertex = triangle[i];
            if (uses[vertex] == 1) continue;
            --uses[vertex];
            mesh.positions.push_back(mesh.positions[vertex]);
            mesh.normals.push_back(mesh.normals[vertex]);
            vertex = static_cast<std::uint32_t>(mesh.positions.size() - 1);
            uses.push_back(1);
        }
    }
}

}  // namespace

Scene sdfModel(Params& params, std::uint64_t seed) {
    const ShapeOf shapeOf =
        params.getEnum("shape", shapes::sphere, kModelShapes, {"what is modelled"});
    const int triangles = params.getInt(
        "triangles", 10'000, {"exact count; even, for the surface is closed", "", 500, 20e6});
    const int vertices = params.getInt(
        "vertices", 0,
        {"exact count; more than the surface needs are made by seams; 0: as many as it needs", "",
         0, 60e6});
    constexpr double kAsMade[] = {1.0, 1.0, 1.0};
    const std::vector<double> stretch = params.getVector(
        "stretch", kAsMade, {"factors along x, y and z; the counts stay", "", 0.1, 10});
    params.finish();
    if (triangles % 2 != 0) {
        throw Error(params.locationOf("triangles"),
                    "triangles: " + std::to_string(triangles) +
                        " is odd, but a closed surface has an even number");
    }

    const auto triangleCount = static_cast<std::size_t>(triangles);
    Mesh mesh = polygonizedBelow(shapeOf(static_cast<std::uint32_t>(seed)), triangleCount);
    const glm::vec3 factors(stretch[0], stretch[1], stretch[2]);
    for (glm::vec3& position : mesh.positions) position *= factors;
    mesh.normals = vertexNormals(mesh);
    mesh = refinedTo(std::move(mesh), triangles);
    const std::size_t least = mesh.positions.size();
    if (vertices != 0) {
        const auto vertexCount = static_cast<std::size_t>(vertices);
        if (vertexCount < least || vertexCount > 3 * triangleCount) {
            throw Error(params.locationOf("vertices"),
                        "vertices: " + std::to_string(vertices) + " cannot be had with " +
                            std::to_string(triangles) + " triangles of this shape; allowed: 0 or " +
                            std::to_string(least) + " to " + std::to_string(3 * triangleCount));
        }
        addSeams(mesh, vertexCount, seed);
    }
    mesh.name = params.resolved().find("shape")->text();
    return sceneOf(std::move(mesh));
}

}  // namespace gfxrepro::scene
