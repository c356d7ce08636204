#include "scenes/shared/mesh_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

/// Vertex normals lie on the side that the winding calls the outside.
void expectNormalsAgree(const Mesh& mesh) {
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions[t.x];
        const glm::vec3 area = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(glm::length(mesh.normals[t[i]]), 1.0F, 1e-5F);
            EXPECT_GT(glm::dot(area, mesh.normals[t[i]]), 0.0F);
        }
    }
}

void expectClosed(const Mesh& mesh) {
    const Topology topology = topologyOf(mesh);
    EXPECT_TRUE(topology.isClosed());
    EXPECT_TRUE(topology.isManifold());
    EXPECT_TRUE(topology.isOriented());
    EXPECT_EQ(topology.degenerateTriangles, 0U);
    EXPECT_EQ(topology.components, 1U);
    EXPECT_EQ(topology.vertices + topology.triangles, topology.edges + 2);  // genus 0
}

TEST(MeshBuilder, BoxIsClosedAndHasItsVolume) {
    MeshBuilder builder;
    const auto axes =
        glm::mat3(glm::rotate(glm::mat4(1.0F), 0.7F, glm::normalize(glm::vec3(1.0F, 2.0F, -0.5F))));
    builder.addBox({3, -1, 2}, {0.5F, 1.0F, 2.0F}, axes);
    EXPECT_EQ(builder.triangleCount(), 12U);
    const Mesh mesh = builder.take("box", 4);
    EXPECT_EQ(mesh.name, "box");
    EXPECT_EQ(mesh.material, 4);
    expectNormalsAgree(mesh);
    EXPECT_NEAR(signedVolume(mesh), 8.0, 1e-4);
    expectClosed(mesh);
    builder.addBox({3, -1, 2}, {0.5F, 1.0F, 2.0F});
    const Mesh upright = builder.take("box", 0);
    expectClosed(upright);
    EXPECT_EQ(upright.bounds().min, glm::vec3(2.5F, -2.0F, 0.0F));
    EXPECT_EQ(upright.bounds().max, glm::vec3(3.5F, 0.0F, 4.0F));
}

TEST(MeshBuilder, StraightTubeIsAPrism) {
    MeshBuilder builder;
    const std::array<MeshBuilder::Station, 3> stations{
        {{{0, 0, 0}, 0.5F}, {{0, 0, 1}, 0.5F}, {{0, 0, 3}, 0.5F}}};
    builder.addTube(stations, 6, true);
    EXPECT_EQ(builder.triangleCount(), 2U * 6 * 2 + 2 * (6 - 2));
    const Mesh mesh = builder.take("tube", 0);
    expectClosed(mesh);
    expectNormalsAgree(mesh);
    const double hexagon = 1.5 * std::sqrt(3.0) * 0.25;
    EXPECT_NEAR(signedVolume(mesh), 3.0 * hexagon, 1e-5);
}

TEST(MeshBuilder, OpenTubeHasItsRimsAsBoundary) {
    MeshBuilder builder;
    const std::array<MeshBuilder::Station, 2> stations{{{{0, 0, 0}, 0.5F}, {{1, 2, 0}, 0.3F}}};
    builder.addTube(stations, 7, false);
    EXPECT_EQ(builder.triangleCount(), 2U * 7);
    EXPECT_EQ(topologyOf(builder.take("tube", 0)).boundaryEdges, 2U * 7);
}

TEST(MeshBuilder, BentTubesAreClosedInEveryDirection) {
    for (int kind = 0; kind < 12; ++kind) {
        MeshBuilder builder;
        std::vector<MeshBuilder::Station> stations;
        for (int i = 0; i <= 20; ++i) {  // helices, tapered; axes in all directions
            const float t = 0.3F * static_cast<float>(i);
            glm::vec3 p(std::cos(t), 0.2F * t, std::sin(t));
            for (int k = 0; k < kind % 3; ++k) p = {p.y, p.z, p.x};
            if (kind % 2 != 0) p.x = -p.x;
            if (kind >= 6) p = -p;
            stations.push_back({p, 0.15F - 0.005F * static_cast<float>(i)});
        }
        builder.addTube(stations, 5, true);
        EXPECT_EQ(builder.triangleCount(), 2U * 5 * 20 + 2 * (5 - 2));
        const Mesh mesh = builder.take("tube", 0);
        expectClosed(mesh);
        expectNormalsAgree(mesh);
        EXPECT_GT(signedVolume(mesh), 0.0);
    }
}

TEST(MeshBuilder, KeepsColoursAndOffsetsIndices) {
    MeshBuilder builder;
    builder.setColor({1, 0, 0});
    builder.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    builder.setColor({0, 0, 1});
    builder.addQuad({0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1});
    const Mesh mesh = builder.take("both", 2);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}, {3, 5, 6}}));
    EXPECT_EQ(mesh.colors[2], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.colors[3], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[6], glm::vec3(0, 0, 1));
    EXPECT_EQ(builder.triangleCount(), 0U);
    EXPECT_TRUE(builder.take("empty", 0).positions.empty());
}

}  // namespace
}  // namespace gfxrepro::scene
