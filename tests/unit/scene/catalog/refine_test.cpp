
#include <algorithm>

#include "engine/scene/refine.h"
#include "tests/support/support.h"
#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

Mesh square() {
    return Mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                .texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

Mesh tetrahedron() {
    return Mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

double area(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x];
        sum += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a,
                                            glm::dvec3(mesh.positions[t.z]) - a));
    }
    return sum;
}

TEST(Refine, HalvesTheLongestEdgeFirst) {
    const Mesh mesh = refinedTo(square(), 4);
    ASSERT_EQ(mesh.triangles.size(), 4U);
    ASSERT_EQ(mesh.positions.size(), 5U);
    const auto middle = std::ranges::find(mesh.positions, glm::vec3(0.5F, 0.5F, 0));
    ASSERT_NE(middle, mesh.positions.end());  // on the diagonal
    EXPECT_EQ(mesh.texcoords[static_cast<std::size_t>(middle - mesh.positions.begin())],
              glm::vec2(0.5F, 0.5F));
    EXPECT_NEAR(area(mesh), 1.0, 1e-12);
}

TEST(Refine, PartsOfATriangleStayTogetherAndVerticesFollowTheirUse) {
    const Mesh mesh = refinedTo(square(), 200);
    std::uint32_t seen = 0;
    std::vector<bool> isUpper;
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            ASSERT_LE(triangle[corner], seen);
            seen = std::max(seen, triangle[corner] + 1);
        }
        const glm::vec3 centre = (mesh.positions[triangle[0]] + mesh.positions[triangle[1]] +
                                  mesh.positions[triangle[2]]) /
                                 3.0F;
        isUpper.push_back(centre.y > centre.x);
    }
    EXPECT_EQ(seen, mesh.positions.size());
    int changes = 0;
    for (std::size_t i = 1; i < isUpper.size(); ++i) changes += isUpper[i] != isUpper[i - 1];
    EXPECT_EQ(changes, 1);  // all of the first triangle, then all of the second
}

TEST(Refine, OpenMeshesReachEveryCount) {
    for (long long count = 2; count < 60; ++count) {
        const Mesh mesh = refinedTo(square(), count);
        EXPECT_EQ(static_cast<long long>(mesh.triangles.size()), count);
        const Topology topology = topologyOf(mesh);
        EXPECT_TRUE(topology.isManifold()) << count;
        EXPECT_TRUE(topology.isOriented()) << count;
        // A disc: no T-junction has opened a hole.
        EXPECT_EQ(topology.vertices + topology.triangles, topology.edges + 1) << count;
        EXPECT_NEAR(area(mesh), 1.0, 1e-6);
    }
}

TEST(Refine, ClosedMeshesStayClosedAndReachTheNextEvenCount) {
    for (const long long count : {4LL, 5LL, 6LL, 7LL, 100LL, 101LL, 5000LL}) {
        const Mesh mesh = refinedTo(tetrahedron(), count);
        EXPECT_EQ(static_cast<long long>(mesh.triangles.size()), count + count % 2);
        EXPECT_TRUE(topologyOf(mesh).isClosed());
        EXPECT_TRUE(topologyOf(mesh).isManifold());
        EXPECT_TRUE(topologyOf(mesh).isOriented());
        EXPECT_NEAR(signedVolume(mesh), 1.0 / 6.0, 1e-6);
    }
}

TEST(Refine, EdgesComeOutAboutEquallyLong) {
    const Mesh mesh = refinedTo(square(), 512);
    float longest = 0.0F;
    for (const glm::uvec3& t : mesh.triangles) {
        longest = std::max(longest, glm::distance(mesh.positions[t.x], mesh.positions[t.y]));
    }
    EXPECT_NEAR(longest, 1.0F / 16.0F, 1.0F / 32.0F);  // 512 right triangles: legs of 1/16
}

TEST(Refine, SeamsStayShutAndKeepTheirOwnAttributes) {
    Mesh mesh = tetrahedron();  // every triangle with its own vertices and normal
    Mesh seamed;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 normal = glm::normalize(glm::cross(
            mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
        const auto first = static_cast<unsigned>(seamed.positions.size());
        for (int i = 0; i < 3; ++i) {
            seamed.positions.push_back(mesh.positions[t[i]]);
            seamed.normals.push_back(normal);
        }
        seamed.triangles.emplace_back(first, first + 1, first + 2);
    }
    const Mesh refined = refinedTo(seamed, 300);
    EXPECT_EQ(refined.triangles.size(), 300U);
    EXPECT_TRUE(topologyOf(refined).isClosed());
    EXPECT_TRUE(topologyOf(refined).isManifold());
    for (const glm::uvec3& t : refined.triangles) {
        const glm::vec3 normal =
            glm::normalize(glm::cross(refined.positions[t.y] - refined.positions[t.x],
                                      refined.positions[t.z] - refined.positions[t.x]));
        for (int i = 0; i < 3; ++i) EXPECT_GT(glm::dot(normal, refined.normals[t[i]]), 0.999F);
    }
}

TEST(Refine, NonManifoldEdgesSplitAllTheirTriangles) {
    Mesh fans;  // three triangles around one edge, which is the longest
    fans.positions = {{0, -2, 0}, {0, 2, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    fans.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    const Mesh mesh = refinedTo(fans, 6);
    EXPECT_EQ(mesh.triangles.size(), 6U);
    EXPECT_EQ(mesh.positions.size(), 6U);
    EXPECT_EQ(topologyOf(mesh).nonManifoldEdges, 2U);
    EXPECT_EQ(refinedTo(fans, 4).triangles.size(), 4U);  // through an edge of the boundary
}

TEST(Refine, SurvivesDuplicateAndDegenerateTriangles) {
    Mesh mesh = square();
    mesh.triangles.push_back({0, 1, 2});
    mesh.triangles.push_back({1, 1, 2});
    const Mesh refined = refinedTo(mesh, 200);
    EXPECT_GE(refined.triangles.size(), 200U);
    EXPECT_LE(refined.triangles.size(), 202U);
    for (const glm::uvec3& t : refined.triangles) {
        for (int i = 0; i < 3; ++i) ASSERT_LT(t[i], refined.positions.size());
    }
}

TEST(Refine, RefusesCountsItCannotReach) {
    EXPECT_EQ(errorText([] { refinedTo(square(), 1); }),
              "cannot refine a mesh of 2 triangles to 1: it has more already");
    EXPECT_EQ(errorText([] { refinedTo(Mesh{}, 10); }),
              "cannot refine a mesh without triangles to 10");
}

TEST(Topology, TetrahedronIsClosedAndEnclosesASixth) {
    const Topology topology = topologyOf(tetrahedron());
    EXPECT_EQ(topology.vertices, 4U);
    EXPECT_EQ(topology.edges, 6U);
    EXPECT_EQ(topology.triangles, 4U);
    EXPECT_EQ(topology.components, 1U);
    EXPECT_TRUE(topology.isClosed());
    EXPECT_TRUE(topology.isManifold());
    EXPECT_TRUE(topology.isOriented());
    EXPECT_NEAR(signedVolume(tetrahedron()), 1.0 / 6.0, 1e-12);
}

TEST(Topology, WeldsByPositionAndTakesMinusZeroForZero) {
    Mesh mesh = tetrahedron();
    mesh.positions.push_back({-0.0F, 1, 0});  // vertex 2 again
    mesh.triangles[0].y = 4;
    EXPECT_EQ(topologyOf(mesh).vertices, 4U);
    EXPECT_TRUE(topologyOf(mesh).isClosed());
}

TEST(Topology, CountsHolesFlipsAndDegenerateTriangles) {
    Mesh mesh = tetrahedron();
    std::swap(mesh.triangles[3].x, mesh.triangles[3].y);
    EXPECT_EQ(topologyOf(mesh).misorientedEdges, 3U);
    mesh.triangles[3] = {1, 2, 2};
    const Topology topology = topologyOf(mesh);
    EXPECT_EQ(topology.degenerateTriangles, 1U);
    EXPECT_EQ(topology.triangles, 3U);
    EXPECT_EQ(topology.boundaryEdges, 3U);
}

TEST(Topology, FindsNonManifoldEdgesAndVertices) {
    Mesh fins = tetrahedron();
    fins.positions.push_back({1, 1, 1});
    fins.triangles.push_back({1, 2, 4});
    EXPECT_EQ(topologyOf(fins).nonManifoldEdges, 1U);

    // Two tetrahedra that touch in vertex 0 only.
    Mesh touching = tetrahedron();
    const Mesh other = tetrahedron();
    for (const glm::vec3& p : other.positions) touching.positions.push_back(-p);
    for (const glm::uvec3& t : other.triangles) touching.triangles.push_back(t + 4U);
    const Topology topology = topologyOf(touching);
    EXPECT_EQ(topology.nonManifoldEdges, 0U);
    EXPECT_EQ(topology.nonManifoldVertices, 1U);
    EXPECT_EQ(topology.components, 2U);
    EXPECT_FALSE(topology.isManifold());
}

TEST(Topology, EmptyMeshHasNothing) {
    const Topology topology = topologyOf(Mesh{});
    EXPECT_EQ(topology.vertices + topology.edges + topology.components, 0U);
}

}  // namespace

}  // namespace gfxrepro::scene
