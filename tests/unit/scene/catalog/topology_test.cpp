#include "tests/support/topology.h"

#include <gtest/gtest.h>

namespace gfxrepro::scene {
namespace {

Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
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
