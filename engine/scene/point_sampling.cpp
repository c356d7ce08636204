#include "engine/scene/point_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "engine/core/error.h"

namespace gfxrepro::scene {

namespace {

/// A triangle in the world with what is interpolated over it.
struct Surfel {
    glm::vec3 positions[3], normals[3], colors[3];
    double area = 0.0;
    bool isColored = false;
};

std::vector<Surfel> surfelsOf(const Scene& scene) {
    std::vector<Surfel> surfels;
    surfels.reserve(scene.triangleCount());
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const glm::mat3 linear(instance.worldFromMesh);
        const glm::mat3 toWorld = glm::transpose(glm::inverse(linear));
        const glm::vec3 base(materialOf(scene, mesh).baseColor);
        const bool isColored =
            !mesh.colors.empty() || (mesh.material >= 0 && base != glm::vec3(1.0F));
        const std::vector<glm::vec3> normals =
            mesh.normals.empty() ? vertexNormals(mesh) : mesh.normals;
        for (const glm::uvec3& triangle : mesh.triangles) {
            Surfel surfel;
            surfel.isColored = isColored;
            for (int k = 0; k < 3; ++k) {
                const std::size_t v = triangle[k];
                surfel.positions[k] =
                    glm::vec3(instance.worldFromMesh * glm::vec4(mesh.positions[v], 1.0F));
                surfel.colors[k] = mesh.colors.empty() ? base : base * mesh.colors[v];
            }
            const glm::vec3 cross = glm::cross(surfel.positions[1] - surfel.positions[0],
                                               surfel.positions[2] - surfel.positions[0]);
            surfel.area = 0.5 * static_cast<double>(glm::length(cross));
            for (int k = 0; k < 3; ++k) surfel.normals[k] = toWorld * normals[triangle[k]];
            surfels.push_back(surfel);
        }
    }
    return surfels;
}

template <class T>
T blended(const T (&values)[3], const glm::vec2& weights) {
    return values[0] * (1.0F - weights.x - weights.y) + values[1] * weights.x +
           values[2] * weights.y;
}

/// Element `index` of the R₂ sequence, folded into the triangle.
glm::vec2 barycentricsAt(std::size_t index) {
    constexpr double kPlastic = 1.32471795724474602596;
    const double i = static_cast<double>(index) + 0.5;
    double u = std::fmod(i / kPlastic, 1.0), v = std::fmod(i / (kPlastic * kPlastic), 1.0);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    return {static_cast<float>(u), static_cast<float>(v)};
}

/// 21 bits an axis, interleaved.
std::uint64_t mortonCode(const glm::vec3& unitPosition) {
    std::uint64_t code = 0;
    const glm::dvec3 scaled =
        glm::clamp(glm::dvec3(unitPosition), 0.0, 1.0) * static_cast<double>((1 << 21) - 1);
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::uint64_t>(scaled[axis]);
        for (int bit = 0; bit < 21; ++bit) code |= ((cell >> bit) & 1) << (3 * bit + axis);
    }
    return code;
}

}  // namespace

PointCloud sampledPoints(const Scene& scene, std::size_t count) {
    if (count == 0) throw Error("0 points wanted of a surface; allowed: at least 1");
    const std::vector<Surfel> surfels = surfelsOf(scene);
    double area = 0.0;
    for (const Surfel& surfel : surfels) area += surfel.area;
    if (!(area > 0.0)) {
        throw Error(fmt::format("scene '{}' has no surface to take points from", scene.name));
    }
    const double step = area / static_cast<double>(count);
    PointCloud points;
    points.positions.reserve(count);
    points.normals.reserve(count);
    points.colors.reserve(count);
    double passed = 0.0;  // area before the surfel
    bool isColored = false;
    for (const Surfel& surfel : surfels) {
        passed += surfel.area;
        // The last point is due by rounding even where the sum falls short of it.
        while (points.positions.size() < count &&
               (static_cast<double>(points.positions.size()) + 0.5) * step < passed) {
            const glm::vec2 weights = barycentricsAt(points.positions.size());
            const glm::vec3 normal = blended(surfel.normals, weights);
            const float length = glm::length(normal);
            points.positions.push_back(blended(surfel.positions, weights));
            points.normals.push_back(length > 0.0F ? normal / length : glm::vec3(0.0F));
            points.colors.push_back(blended(surfel.colors, weights));
            isColored = isColored || surfel.isColored;
        }
    }
    if (!isColored) points.colors.clear();
    // Small triangles in any order leave points nearly at random: discs of 4 times their share of
    // the area, up to 1.5 radii, leave e⁻⁹ of it bare; with 1.5 times the radius it would be e⁻⁵,
    // and close-ups would have pinholes.
    const double radius = 2.0 * std::sqrt(step / glm::pi<double>());
    points.radii.assign(points.positions.size(), static_cast<float>(radius));
    return points;
}

PointCloud thinnedPoints(const PointCloud& points, std::size_t count) {
    const std::size_t all = points.positions.size();
    if (count >= all) return points;
    const Box box = points.bounds();
    const glm::vec3 size = glm::max(box.size(), glm::vec3(1e-30F));  // flat clouds: any code
    std::vector<std::uint64_t> codes(all);
    for (std::size_t i = 0; i < all; ++i) {
        codes[i] = mortonCode((points.positions[i] - box.min) / size);
    }
    std::vector<std::size_t> order(all);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return codes[a] < codes[b]; });
    const auto grown = static_cast<float>(
        std::sqrt(static_cast<double>(all) / static_cast<double>(std::max<std::size_t>(count, 1))));
    PointCloud thinned;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = order[k * all / count];
        thinned.positions.push_back(points.positions[i]);
        if (!points.normals.empty()) thinned.normals.push_back(points.normals[i]);
        if (!points.radii.empty()) thinned.radii.push_back(points.radii[i] * grown);
        if (!points.colors.empty()) thinned.colors.push_back(points.colors[i]);
    }
    return thinned;
}

}  // namespace gfxrepro::scene
