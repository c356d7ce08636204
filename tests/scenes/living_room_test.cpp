
#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>

#include "engine/core/hash.h"
#include "engine/scene/animation.h"
#include "scenes/indoor/parts.h"
#include "scenes/registry.h"
#include "tests/support/support.h"
#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

Scene room(const std::string& yaml = "{}", std::uint64_t seed = 1) {
    Params params(parseYaml(yaml, "t.yaml"), "generator 'living_room'");
    return findGenerator(registeredGenerators(), "living_room", {}).generate(params, seed);
}

/// The default one, made once.
const Scene& theRoom() {
    static const Scene scene = room();
    return scene;
}

struct Counts {
    std::size_t diffuse = 0, reflective = 0, reflectors = 0;
};

Counts countsOf(const Scene& scene) {
    Counts counts;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes.at(static_cast<std::size_t>(instance.mesh));
        const Material& material = scene.materials.at(static_cast<std::size_t>(mesh.material));
        if (material.metallic > 0.0F) {
            EXPECT_EQ(material.roughness, 0.0F) << mesh.name;
            EXPECT_LT(material.metallic, 1.0F) << mesh.name;
            counts.reflective += mesh.triangles.size();
            ++counts.reflectors;
        } else {
            EXPECT_EQ(material.roughness, 1.0F) << mesh.name;
            counts.diffuse += mesh.triangles.size();
        }
    }
    return counts;
}

TEST(LivingRoom, CountsAreTheThesis) {
    const Counts counts = countsOf(theRoom());
    EXPECT_EQ(counts.diffuse, 150'000U);
    EXPECT_EQ(counts.reflective, 130'000U);
    EXPECT_EQ(counts.reflectors, 25U);
}

TEST(LivingRoom, DiffuseCountIsExactAndTheReflectorsStay) {
    for (const int diffuse : {40'000, 63'000, 400'000}) {
        SCOPED_TRACE(diffuse);
        const Counts counts =
            countsOf(room("{diffuse_triangles: " + std::to_string(diffuse) + "}", 3));
        EXPECT_EQ(counts.diffuse, static_cast<std::size_t>(diffuse));
        EXPECT_EQ(counts.reflective, 130'000U);
    }
}

TEST(LivingRoom, MeshesAreSound) {
    const Scene& scene = theRoom();
    std::size_t degenerate = 0;
    for (const Mesh& mesh : scene.meshes) {
        SCOPED_TRACE(mesh.name);
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
        float worst = 0.0F;
        bool isFinite = true;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const float error = std::abs(glm::length(mesh.normals[i]) - 1.0F);
            if (!(error <= worst)) worst = error;  // the negation counts not-a-number
            for (int c = 0; c < 3; ++c) {
                isFinite &= std::abs(mesh.positions[i][c]) < 10.0F;
                isFinite &= mesh.colors[i][c] >= 0.0F && mesh.colors[i][c] <= 1.0F;
            }
            if (mesh.texcoords.empty()) continue;
            isFinite &= std::abs(mesh.texcoords[i].x) < 100.0F;
            isFinite &= std::abs(mesh.texcoords[i].y) < 100.0F;
        }
        EXPECT_LT(worst, 1e-4F);
        EXPECT_TRUE(isFinite);
        const Material& material = scene.materials.at(static_cast<std::size_t>(mesh.material));
        EXPECT_EQ(material.baseColorTexture >= 0 && mesh.texcoords.empty(), false);
        std::size_t turned = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions.at(t.x);
            const glm::vec3 b = mesh.positions.at(t.y);
            const glm::vec3 c = mesh.positions.at(t.z);
            const glm::vec3 area = glm::cross(b - a, c - a);
            const float longest =
                std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
            if (!(glm::length(area) > 1e-5F * longest * longest)) {
                ++degenerate;
                continue;
            }
            turned +=
                !(glm::dot(area, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) > 0.0F);
        }
        // Curled leaf tips, where smooth normals lag behind.
        EXPECT_LE(turned, mesh.triangles.size() / 500);
    }
    EXPECT_LE(degenerate, scene.triangleCount() / 1000);
}

TEST(LivingRoom, RoundReflectorsAreClosedAndFaceOutwards) {
    const Scene& scene = theRoom();
    const std::set<std::string> closed{"vase",
                                       "small_vase",
                                       "bowl",
                                       "pot_steel",
                                       "pot_copper",
                                       "ball",
                                       "arc_lamp_dish",
                                       "ceiling_lamp",
                                       "candlestick_left",
                                       "candlestick_right",
                                       "table_lamp_foot",
                                       "knot"};
    std::size_t found = 0;
    for (const Mesh& mesh : scene.meshes) {
        if (!closed.contains(mesh.name)) continue;
        SCOPED_TRACE(mesh.name);
        ++found;
        const Topology topology = topologyOf(mesh);
        EXPECT_TRUE(topology.isClosed());
        EXPECT_TRUE(topology.isOriented());
        EXPECT_EQ(topology.components, 1U);
        EXPECT_GT(signedVolume(mesh), 0.0);
    }
    EXPECT_EQ(found, closed.size());
}

TEST(LivingRoom, NothingButTheWindowsLeavesTheRoom) {
    for (const Mesh& mesh : theRoom().meshes) {
        if (mesh.name == "outdoors" || mesh.name == "paint") continue;
        SCOPED_TRACE(mesh.name);
        const Box box = mesh.bounds();
        EXPECT_GE(box.min.x, -3.6001F);
        EXPECT_LE(box.max.x, 3.6001F);
        EXPECT_GE(box.min.y, -1e-3F);
        EXPECT_LE(box.max.y, 2.8501F);
        EXPECT_GE(box.min.z, -2.9601F);  // a plant stands in the window
        EXPECT_LE(box.max.z, 2.9001F);
    }
}

TEST(LivingRoom, BallIsASphere) {
    const auto& meshes = theRoom().meshes;
    const auto ball = std::ranges::find(meshes, "ball", &Mesh::name);
    ASSERT_NE(ball, meshes.end());
    const glm::vec3 centre = ball->bounds().centre();
    for (std::size_t i = 0; i < ball->positions.size(); ++i) {
        const glm::vec3 out = ball->positions[i] - centre;
        ASSERT_NEAR(glm::length(out), 0.3F, 1e-3F);
        ASSERT_GT(glm::dot(glm::normalize(out), ball->normals[i]), 0.999F);
    }
}

TEST(LivingRoom, MotionsMoveNamedObjectsAndEndWhereTheyBegan) {
    const Scene& scene = theRoom();
    std::set<std::string> moving;
    for (const Motion& motion : scene.motions) {
        const auto instance = static_cast<std::size_t>(motion.instance);
        moving.insert(
            scene.meshes.at(static_cast<std::size_t>(scene.instances.at(instance).mesh)).name);
        const glm::mat4 quarter = posesAt(scene, 0.27).at(instance);
        EXPECT_GT(glm::length(quarter[3] - scene.instances[instance].worldFromMesh[3]) +
                      glm::length(quarter[0] - scene.instances[instance].worldFromMesh[0]),
                  0.01F);
        const glm::mat4 end = posesAt(scene, 1.0).at(instance);
        for (int c = 0; c < 4; ++c) {
            EXPECT_LT(glm::length(end[c] - scene.instances[instance].worldFromMesh[c]), 1e-4F);
        }
    }
    EXPECT_EQ(moving, (std::set<std::string>{"vase", "knot", "ball", "chair_oak"}));
}

std::string digestOfRoom(const Scene& scene) {
    std::string digests;
    const auto add = [&](const auto& values) {
        digests += sha256(std::as_bytes(std::span(values)));
    };
    for (const Mesh& mesh : scene.meshes) {
        add(mesh.positions);
        add(mesh.normals);
        add(mesh.texcoords);
        add(mesh.colors);
        add(mesh.triangles);
    }
    for (const image::Image8& texture : scene.textures) add(texture.values());
    return sha256(digests);
}

TEST(LivingRoom, SameBytesOnEveryMachine) {
    EXPECT_EQ(digestOfRoom(theRoom()),
              "3f18cec2a9e562f524de854e3ac06bfa126bdf2dd0d8001db5a08f44af6883d8");
    const std::string small = "{diffuse_triangles: 60000}";
    EXPECT_NE(digestOfRoom(room(small, 1)), digestOfRoom(room(small, 2)));
}

TEST(LivingRoom, BadParametersAreLocated) {
    EXPECT_EQ(errorText([] { room("{diffuse_triangles: 39999}"); }),
              "t.yaml:1:21: generator 'living_room': diffuse_triangles is 39999; allowed: 40000 … "
              "400000");
    EXPECT_EQ(errorText([] { room("{triangles: 9}"); }),
              "t.yaml:1:2: generator 'living_room': unknown parameter 'triangles'; allowed: "
              "diffuse_triangles");
}

TEST(IndoorParts, TurnedPartsMeetTheirVolumeAndCount) {
    MeshBuilder builder;
    const indoor::Outline cylinder{{0, 0}, {0.5F, 0}, {0.5F, 0}, {0.5F, 2}, {0.5F, 2}, {0, 2}};
    indoor::addTurned(builder, cylinder, 4000);
    EXPECT_LE(builder.triangleCount(), 4000U);
    EXPECT_GT(builder.triangleCount(), 3600U);
    const Mesh mesh = indoor::exactly(builder.take("cylinder", 0), 4000);
    EXPECT_EQ(mesh.triangles.size(), 4000U);
    EXPECT_NEAR(signedVolume(mesh), 0.5 * 3.14159265, 0.02);
    EXPECT_TRUE(topologyOf(mesh).isClosed());
}

TEST(IndoorParts, RoundedBoxesAreClosedWithoutAndWithBulge) {
    for (const glm::vec3& bulge : {glm::vec3(0.0F), glm::vec3(0.02F, 0.1F, 0.05F)}) {
        MeshBuilder builder;
        const indoor::RoundedBox box{.halfSize = {1.0F, 0.4F, 0.6F},
                                     .radius = 0.1F,
                                     .edgeCells = 4,
                                     .faceCells = 6,
                                     .bulge = bulge};
        indoor::addRoundedBox(builder, box, indoor::placed({1, 2, 3}, 0.4F));
        EXPECT_EQ(builder.triangleCount(), 12U * 14U * 14U);
        const Mesh mesh = builder.take("box", 0);
        const Topology topology = topologyOf(mesh);
        EXPECT_TRUE(topology.isClosed());
        EXPECT_TRUE(topology.isOriented());
        // The full box loses little at its edges, and gains by the bulge.
        const double full = 8.0 * 1.0 * 0.4 * 0.6;
        if (bulge.y > 0.0F) {
            EXPECT_GT(signedVolume(mesh), full);
        } else {
            EXPECT_NEAR(signedVolume(mesh), full, 0.05 * full);
            EXPECT_LT(signedVolume(mesh), full);
        }
    }
}

}  // namespace
}  // namespace gfxrepro::scene
