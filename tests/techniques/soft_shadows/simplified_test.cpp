// Fewer triangles, the surface within the error, borders untouched.
#include "techniques/soft_shadows/shadow_casters.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "engine/scene/topology.h"
#include "tests/support/topology.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::soft_shadows {
namespace {

namespace shapes = voxelization::shapes;

/// n × n quads over the unit square of the xy plane, z by `height`.
template <class Height>
scene::Mesh grid(unsigned n, Height&& height) {
    scene::Mesh mesh;
    for (unsigned y = 0; y <= n; ++y) {
        for (unsigned x = 0; x <= n; ++x) {
            const glm::vec2 p = glm::vec2(x, y) / static_cast<float>(n);
            mesh.positions.emplace_back(p, height(p));
        }
    }
    for (unsigned y = 0; y < n; ++y) {
        for (unsigned x = 0; x < n; ++x) {
            const unsigned a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(c, d, a);
        }
    }
    return mesh;
}

using Point = std::tuple<float, float, float>;

std::set<Point> borderPoints(const scene::Mesh& mesh) {
    const auto table = scene::edgesOf(mesh.triangles, scene::weldedByPosition(mesh.positions));
    std::set<Point> points;
    for (const std::uint32_t corner : table.firstCorner) {
        if (table.nextCorner[corner] != scene::kNone) continue;
        for (const std::uint32_t i : {corner % 3, (corner + 1) % 3}) {
            const glm::vec3 p = mesh.positions[mesh.triangles[corner / 3][static_cast<int>(i)]];
            points.emplace(p.x, p.y, p.z);
        }
    }
    return points;
}

double areaOf(const scene::Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a,
                                             glm::dvec3(mesh.positions[t.z]) - a));
    }
    return area;
}

TEST(SimplifiedTest, APlaneLosesAllButItsBorder) {
    const scene::Mesh mesh = grid(32, [](const glm::vec2&) { return 0.0F; });
    const SimplifiedMesh result = simplified(mesh, {.triangleRatio = 0.01F, .maxErrorM = 1e-3F});
    // 128 points on the border allow no fewer than 126 triangles.
    EXPECT_GE(result.mesh.triangles.size(), 126U);
    EXPECT_LT(result.mesh.triangles.size(), 300U);
    EXPECT_EQ(borderPoints(mesh).size(), 128U);
    EXPECT_EQ(borderPoints(result.mesh), borderPoints(mesh));
    EXPECT_NEAR(areaOf(result.mesh), 1.0, 1e-6);
    EXPECT_LE(result.errorM, 1e-3F);
    EXPECT_EQ(scene::topologyOf(result.mesh).components, 1U);
}

TEST(SimplifiedTest, ASphereStaysWithinTheError) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(1.0F, 2.0F, 3.0F), 2.0F, 5);
    for (const float ratio : {0.5F, 0.1F}) {
        const SimplifiedMesh result = simplified(mesh, {.triangleRatio = ratio, .maxErrorM = 0.1F});
        const double kept = static_cast<double>(result.mesh.triangles.size()) /
                            static_cast<double>(mesh.triangles.size());
        EXPECT_NEAR(kept, ratio, 0.01);
        EXPECT_GT(result.errorM, 0.0F);
        EXPECT_LE(result.errorM, 0.1F);
        EXPECT_TRUE(scene::topologyOf(result.mesh).isClosed());
        EXPECT_TRUE(scene::topologyOf(result.mesh).isOriented());
        for (const glm::uvec3& t : result.mesh.triangles) {
            const glm::vec3 middle = (result.mesh.positions[t.x] + result.mesh.positions[t.y] +
                                      result.mesh.positions[t.z]) /
                                     3.0F;
            EXPECT_NEAR(glm::distance(middle, glm::vec3(1.0F, 2.0F, 3.0F)), 2.0F, 0.1F);
        }
    }
}

TEST(SimplifiedTest, TheErrorEndsItBeforeTheRatio) {
    const scene::Mesh mesh =
        grid(32, [](const glm::vec2& p) { return 0.1F * std::sin(20.0F * p.x * p.y); });
    const SimplifiedMesh coarse = simplified(mesh, {.triangleRatio = 0.0F, .maxErrorM = 0.05F});
    const SimplifiedMesh fine = simplified(mesh, {.triangleRatio = 0.0F, .maxErrorM = 0.001F});
    EXPECT_LE(fine.errorM, 0.001F);
    EXPECT_LE(coarse.errorM, 0.05F);
    EXPECT_LT(coarse.mesh.triangles.size(), fine.mesh.triangles.size());
    EXPECT_LT(fine.mesh.triangles.size(), mesh.triangles.size());
}

TEST(SimplifiedTest, TheRatioOneKeepsAll) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0.0F), 1.0F, 2);
    const SimplifiedMesh result = simplified(mesh, {.triangleRatio = 1.0F, .maxErrorM = 1.0F});
    EXPECT_EQ(result.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(result.mesh.positions.size(), mesh.positions.size());
    EXPECT_EQ(result.errorM, 0.0F);
}

TEST(SimplifiedTest, NothingStaysNothing) {
    const SimplifiedMesh result = simplified(scene::Mesh{}, {});
    EXPECT_TRUE(result.mesh.triangles.empty());
    EXPECT_TRUE(result.mesh.positions.empty());
    EXPECT_EQ(result.errorM, 0.0F);
}

}  // namespace
}  // namespace gfxrepro::soft_shadows
