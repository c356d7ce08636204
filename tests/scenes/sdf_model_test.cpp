#include "engine/scene/generators.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "engine/core/hash.h"
#include "scenes/models/shapes.h"
#include "scenes/registry.h"
#include "tests/support/support.h"
#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

Scene sampled(const std::string& yaml, std::uint64_t seed = 1) {
    Params params(parseYaml(yaml, "t.yaml"), "generator 'sdf_model'");
    return findGenerator(registeredGenerators(), "sdf_model", {}).generate(params, seed);
}

std::string digestOfMesh(const Mesh& mesh) {
    return sha256(std::as_bytes(std::span(mesh.positions))) +
           sha256(std::as_bytes(std::span(mesh.normals))) +
           sha256(std::as_bytes(std::span(mesh.triangles)));
}

class ModelShape : public testing::TestWithParam<const char*> {};

TEST_P(ModelShape, IsClosedManifoldOutwardAndOfTheWantedCounts) {
    const std::string shape = GetParam();
    const Scene scene = sampled("{shape: " + shape + ", triangles: 12346, vertices: 7000}", 3);
    ASSERT_EQ(scene.meshes.size(), 1U);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.name, shape);
    EXPECT_EQ(mesh.triangles.size(), 12346U);
    EXPECT_EQ(mesh.positions.size(), 7000U);
    EXPECT_EQ(mesh.normals.size(), 7000U);

    const Topology topology = topologyOf(mesh);
    EXPECT_EQ(topology.boundaryEdges, 0U);
    EXPECT_EQ(topology.nonManifoldEdges, 0U);
    EXPECT_EQ(topology.nonManifoldVertices, 0U);
    EXPECT_EQ(topology.misorientedEdges, 0U);
    EXPECT_EQ(topology.degenerateTriangles, 0U);
    EXPECT_GT(signedVolume(mesh), 0.1);

    const Box box = mesh.bounds();
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(box.min[axis], -1.25F);
        EXPECT_LT(box.max[axis], 1.25F);
    }
    EXPECT_GT(std::max({box.size().x, box.size().y, box.size().z}), 1.6F);
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions[t.x];
        EXPECT_GT(glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a)), 0.0F);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ModelShape,
                         testing::Values("blade", "brain", "buddha", "bunny", "dragon", "duck",
                                         "hand", "head", "hip", "hugo", "linked_tori", "lion",
                                         "sphere", "torus", "wagner"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Generators, SameBytesOnEveryMachine) {
    // Only operations that IEEE 754 rounds exactly are used: a difference here is a changed
    // generator (then kGeneratorVersion goes up) or a compiler that reorders floating point.
    EXPECT_EQ(sha256(digestOfMesh(sampled("{shape: bunny, triangles: 3000}").meshes[0])),
              "ca7fdfa3d10d7f8669bc4cb2a180e3e3d472db9adb66f8dcb8bb63e3d6bae78f");
    const auto brain = [](std::uint64_t seed) {
        return digestOfMesh(
            sampled("{shape: brain, triangles: 6000, vertices: 4000}", seed).meshes[0]);
    };
    EXPECT_NE(brain(1), brain(2));
}

TEST(Generators, AnalyticBodiesHaveTheirVolumesAndGenus) {
    constexpr double kPi = std::numbers::pi;
    const Mesh sphere = sampled("{shape: sphere, triangles: 20000}").meshes[0];
    EXPECT_NEAR(signedVolume(sphere), 4.0 / 3.0 * kPi, 0.01);
    for (const glm::vec3& normal : sphere.normals) EXPECT_NEAR(glm::length(normal), 1.0F, 1e-5F);
    for (const glm::vec3& p : sphere.positions) EXPECT_NEAR(glm::length(p), 1.0F, 4e-3F);

    const Mesh torus = sampled("{shape: torus, triangles: 20000}").meshes[0];
    EXPECT_NEAR(signedVolume(torus), 2.0 * kPi * kPi * 0.7 * 0.3 * 0.3, 0.01);
    const Topology ring = topologyOf(torus);
    EXPECT_EQ(ring.vertices + ring.triangles, ring.edges);  // genus 1

    const Mesh rings = sampled("{shape: linked_tori, triangles: 20000}").meshes[0];
    EXPECT_EQ(topologyOf(rings).components, 2U);
    EXPECT_NEAR(signedVolume(rings), 2.0 * 2.0 * kPi * kPi * 0.5 * 0.12 * 0.12, 0.01);
}

TEST(Generators, RestrictedShapesAgreeToTheLastBit) {
    const sdf::Shape dragon = shapes::dragon(1);
    sdf::Shape near;
    for (int i = 0; i < 200; ++i) {
        const auto spread = [i](int k) { return static_cast<float>((i * k) % 41) / 20.0F - 1.0F; };
        const glm::vec3 centre(0.5F * spread(7), spread(11), spread(17));
        if (!dragon.restrictTo(centre, 0.1F, near)) {
            EXPECT_GT(std::abs(dragon.distance(centre)), 0.0F);
            continue;
        }
        for (const glm::vec3& offset : {glm::vec3(0), {0.05F, 0.05F, -0.05F}, {-0.09F, 0, 0.01F}}) {
            EXPECT_EQ(near.distance(centre + offset), dragon.distance(centre + offset));
        }
    }
}

TEST(Generators, PolynomialSineIsASine) {
    for (int i = -100; i <= 100; ++i) {
        const float angle = 0.1F * static_cast<float>(i);
        EXPECT_NEAR(sdf::sine(angle), std::sin(angle), 3e-6F);
        EXPECT_NEAR(sdf::cosine(angle), std::cos(angle), 3e-6F);
    }
}

TEST(Generators, StretchKeepsTheCounts) {
    const Mesh made = sampled("{shape: torus, triangles: 1000}").meshes[0];
    const Mesh wide = sampled("{shape: torus, triangles: 1000, stretch: [2, 1, 0.5]}").meshes[0];
    EXPECT_EQ(wide.triangles.size(), made.triangles.size());
    const glm::vec3 before = made.bounds().size();
    const glm::vec3 after = wide.bounds().size();
    // A twentieth: which edges are halved to the count depends on their lengths.
    EXPECT_NEAR(after.x, 2.0F * before.x, 0.05F * after.x);
    EXPECT_NEAR(after.y, before.y, 0.05F * after.y);
    EXPECT_NEAR(after.z, 0.5F * before.z, 0.05F * after.z);
    for (const glm::vec3& normal : wide.normals) EXPECT_NEAR(glm::length(normal), 1.0F, 1e-5F);
}

TEST(Generators, BadParametersAreLocated) {
    EXPECT_EQ(errorText([] { sampled("{shape: sphere, triangles: 1001}"); }),
              "t.yaml:1:28: triangles: 1001 is odd, but a closed surface has an even number");
    EXPECT_EQ(errorText([] { sampled("{shape: sphere, triangles: 1200, vertices: 100}"); }),
              "t.yaml:1:44: vertices: 100 cannot be had with 1200 triangles of this shape; "
              "allowed: 0 or 602 to 3600");
    EXPECT_EQ(errorText([] { sampled("{shape: dargon}"); }),
              "t.yaml:1:9: generator 'sdf_model': shape is dargon; allowed: blade | brain | buddha "
              "| bunny | dragon | duck | hand | head | hip | hugo | linked_tori | lion | sphere | "
              "torus | wagner");
    EXPECT_EQ(errorText([] { sampled("{stretch: [1, 0, 1]}"); }),
              "t.yaml:1:11: generator 'sdf_model': stretch is [1, 0, 1]; allowed: a list of 3 "
              "numbers, each 0.1 … 10");
    EXPECT_EQ(errorText([] { sampled("{triangels: 1000}"); }),
              "t.yaml:1:2: generator 'sdf_model': unknown parameter 'triangels'; did you mean "
              "'triangles'?");
    EXPECT_EQ(errorText([] {
                  findGenerator(registeredGenerators(), "sdf_modle", {"s.yaml", 4, 9});
              }),
              "s.yaml:4:9: unknown generator 'sdf_modle'; did you mean 'sdf_model'? (there are: "
              "bathroom, bird_nest, city, cornell_box, four_objects, grass, living_room, "
              "object_on_plane, "
              "sdf_model, terrain, town_square, tree)");
}

}  // namespace
}  // namespace gfxrepro::scene
