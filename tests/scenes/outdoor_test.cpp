// The outdoor generators bird_nest and grass.

#include <cmath>
#include <string>

#include "tests/scenes/generated_scene.h"
#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

Scene sized(const std::string& generator, int triangles, std::uint64_t seed = 1) {
    return generated(generator, "{triangles: " + std::to_string(triangles) + "}", seed);
}

struct Wanted {
    const char* generator;
    int triangles;
};

class NestOrGrass : public testing::TestWithParam<Wanted> {};

TEST_P(NestOrGrass, IsSoundWithExactlyTheWantedTriangles) {
    const Scene scene = sized(GetParam().generator, GetParam().triangles, 7);
    EXPECT_EQ(scene.triangleCount(), static_cast<std::size_t>(GetParam().triangles));
    for (const Mesh& mesh : scene.meshes) expectSoundMesh(mesh);
    EXPECT_EQ(scene.meshes.size(), scene.materials.size());
}

/// How far the scene reaches towards the picture's edges, 1 being an edge.
float fillOf(const Scene& scene, const Camera& camera, const glm::vec3& eye) {
    const glm::vec3 back = glm::normalize(eye - camera.target);
    const glm::vec3 right = glm::normalize(glm::cross(camera.up, back));
    const glm::vec3 above = glm::cross(back, right);
    const float slope = std::tan(0.5F * camera.verticalFovRad);
    float fill = 0.0F;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& p : mesh.positions) {
            const glm::vec3 offset = p - eye;
            const float depth = -glm::dot(offset, back);
            EXPECT_GT(depth, camera.nearM);
            EXPECT_LT(depth, camera.farM);
            fill = std::max({fill, std::abs(glm::dot(offset, right)) / (depth * slope),
                             std::abs(glm::dot(offset, above)) / (depth * slope)});
        }
    }
    return fill;
}

TEST_P(NestOrGrass, FillsItsCameraAndStaysInFrontOfReferenceViews) {
    const Scene scene = sized(GetParam().generator, GetParam().triangles);
    ASSERT_EQ(scene.cameras.size(), 1U);
    const Camera& camera = scene.cameras[0];
    const float fill = fillOf(scene, camera, camera.position);
    EXPECT_GT(fill, 0.8F);
    EXPECT_LT(fill, 1.0F);
    // Corners of an equilateral triangle across the view, its side half the scene's diagonal.
    const float radius = 0.5F * glm::length(scene.bounds().size()) / std::sqrt(3.0F);
    const glm::vec3 back = glm::normalize(camera.position - camera.target);
    const glm::vec3 right = glm::normalize(glm::cross(camera.up, back));
    const glm::vec3 above = glm::cross(back, right);
    for (const glm::vec2 corner : {glm::vec2(0, 1), {0.866F, -0.5F}, {-0.866F, -0.5F}}) {
        const glm::vec3 eye = camera.position + radius * (corner.x * right + corner.y * above);
        EXPECT_LT(fillOf(scene, camera, eye), 1.1F);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, NestOrGrass,
                         testing::Values(Wanted{"bird_nest", 5000}, Wanted{"bird_nest", 20002},
                                         Wanted{"bird_nest", 66666}, Wanted{"bird_nest", 67000},
                                         Wanted{"bird_nest", 300004}, Wanted{"grass", 10000},
                                         Wanted{"grass", 10002}, Wanted{"grass", 56000},
                                         Wanted{"grass", 56002}, Wanted{"grass", 300000}),
                         [](const auto& info) {
                             return std::string(info.param.generator) + "_" +
                                    std::to_string(info.param.triangles);
                         });

TEST(NestAndGrass, DefaultsAreThePrintedCounts) {
    EXPECT_EQ(generated("bird_nest", "{}").triangleCount(), 67'000U);
    EXPECT_EQ(generated("grass", "{}").triangleCount(), 56'000U);
}

TEST(NestAndGrass, SameBytesOnEveryMachine) {
    EXPECT_EQ(digestOf(sized("bird_nest", 67'000)),
              "e12dfc037613eb3f31a8e0ad13b0d1ce3b661ddcf6f98b7fcb6b09933cf29fd0");
    EXPECT_EQ(digestOf(sized("grass", 56'000)),
              "cbb08cb1c24364a30e4d71bdabf41d71079b9ea8adca3018bd55c6d29f587305");
    for (const char* generator : {"bird_nest", "grass"}) {
        EXPECT_NE(digestOf(sized(generator, 20'000)), digestOf(sized(generator, 20'000, 2)));
    }
}

TEST(BirdNest, PartsAreClosedAndFaceOutwards) {
    const Scene scene = sized("bird_nest", 67'000);
    for (const Mesh& mesh : scene.meshes) {
        const Topology topology = topologyOf(mesh);
        EXPECT_TRUE(topology.isClosed()) << mesh.name;
        EXPECT_TRUE(topology.isManifold()) << mesh.name;
        EXPECT_TRUE(topology.isOriented()) << mesh.name;
        EXPECT_GT(signedVolume(mesh), 0.0) << mesh.name;
        EXPECT_FALSE(scene.materials[static_cast<std::size_t>(mesh.material)].isDoubleSided);
    }
    EXPECT_EQ(topologyOf(meshNamed(scene, "eggs")).components, 4U);
    EXPECT_EQ(topologyOf(meshNamed(scene, "branch")).components, 3U);
    const auto twigs = [](const Scene& of) {
        return topologyOf(meshNamed(of, "twigs")).components;
    };
    EXPECT_EQ(twigs(scene), 122U);
    EXPECT_GT(twigs(sized("bird_nest", 670'000)), 9U * twigs(scene));
    EXPECT_EQ(twigs(sized("bird_nest", 20'000)), 122U);  // coarser before they get fewer
}

TEST(BirdNest, TwigsShareTheTriangles) {
    for (const int count : {1, 20, 243, 974, 4000}) {
        SCOPED_TRACE(count);
        const Scene scene = generated("bird_nest", "{twigs: " + std::to_string(count) + "}");
        EXPECT_EQ(scene.triangleCount(), 67'000U);
        const Mesh& twigs = meshNamed(scene, "twigs");
        expectSoundMesh(twigs);
        const Topology topology = topologyOf(twigs);
        EXPECT_TRUE(topology.isClosed() && topology.isManifold() && topology.isOriented());
        EXPECT_EQ(topology.components, static_cast<std::size_t>(count));
    }
}

TEST(BirdNest, SidesOfTwigsAreFree) {
    const auto nest = [](int sides) {
        return generated("bird_nest", "{twigs: 120, sides: " + std::to_string(sides) + "}");
    };
    // Twigs of 536 triangles have ten sides of their own.
    EXPECT_EQ(digestOf(nest(10)), digestOf(nest(0)));
    for (const int sides : {3, 4, 24}) {
        SCOPED_TRACE(sides);
        const Scene scene = nest(sides);
        EXPECT_EQ(scene.triangleCount(), 67'000U);
        const Mesh& twigs = meshNamed(scene, "twigs");
        expectSoundMesh(twigs);
        const Topology topology = topologyOf(twigs);
        EXPECT_TRUE(topology.isClosed() && topology.isManifold() && topology.isOriented());
        EXPECT_EQ(topology.components, 120U);
        // Caps alone are flat: two a twig, each of as many triangles as it has sides, less two.
        const auto flat =
            static_cast<int>(std::ranges::count_if(twigs.triangles, [&twigs](const glm::uvec3& t) {
                return twigs.normals[t.x] == twigs.normals[t.y] &&
                       twigs.normals[t.x] == twigs.normals[t.z];
            }));
        const int ofCaps = 120 * 2 * (sides - 2);
        EXPECT_GE(flat, ofCaps);
        EXPECT_LT(flat, ofCaps + 2 * sides) << "what is less than a stretch may split some";
        EXPECT_NEAR(signedVolume(twigs) / signedVolume(meshNamed(nest(0), "twigs")), 1.0, 0.03);
    }
}

TEST(BirdNest, ThicknessIsIndependentOfTheNumberOfTwigs) {
    const auto woodIn = [](const std::string& yaml) {
        return signedVolume(meshNamed(generated("bird_nest", yaml), "twigs"));
    };
    const double reference = woodIn("{twigs: 500}");
    EXPECT_NEAR(woodIn("{twigs: 500, twig_thickness: 2}") / reference, 4.0, 0.02);
    EXPECT_NEAR(woodIn("{twigs: 1000}") / reference, 2.0, 0.2);
}

TEST(BirdNest, HoldsAsMuchWoodWhateverTheCount) {
    const auto volumeOf = [](int triangles) {
        return signedVolume(meshNamed(sized("bird_nest", triangles), "twigs"));
    };
    const double reference = volumeOf(67'000);
    EXPECT_NEAR(volumeOf(670'000) / reference, 1.0, 0.05);
    EXPECT_NEAR(volumeOf(20'000) / reference, 1.0, 0.15);  // few twigs: much chance
}

TEST(BirdNest, IsABowlWithRoomForTheEggs) {
    const Scene scene = sized("bird_nest", 67'000);
    const Mesh& twigs = meshNamed(scene, "twigs");
    std::size_t inside = 0;
    for (const glm::vec3& p : twigs.positions) {
        if (std::sqrt(p.x * p.x + p.z * p.z) < 0.4F && p.y > -0.2F) ++inside;
    }
    EXPECT_EQ(inside, 0U);
    const Box box = twigs.bounds();
    for (const int axis : {0, 2}) {
        EXPECT_GT(box.size()[axis], 1.8F);
        EXPECT_GT(box.min[axis], -1.25F);
        EXPECT_LT(box.max[axis], 1.25F);
    }
    EXPECT_GT(box.min.y, -1.2F);
    EXPECT_LT(box.max.y, 0.5F);
    const Box eggs = meshNamed(scene, "eggs").bounds();
    EXPECT_GT(eggs.min.y, -0.55F);
    EXPECT_LT(eggs.max.y, 0.0F);
}

/// Height of the ground above a place by brute force over its triangles.
float groundHeight(const Mesh& ground, const glm::vec3& place) {
    const auto cross2 = [](const glm::vec3& u, const glm::vec3& v) {
        return u.x * v.z - u.z * v.x;
    };
    for (const glm::uvec3& t : ground.triangles) {
        const glm::vec3 a = ground.positions[t.x];
        const glm::vec3 ab = ground.positions[t.y] - a;
        const glm::vec3 ac = ground.positions[t.z] - a;
        const glm::vec3 ap = place - a;
        const float v = cross2(ap, ac) / cross2(ab, ac);
        const float w = cross2(ab, ap) / cross2(ab, ac);
        if (v > -1e-4F && w > -1e-4F && v + w < 1.0001F) return a.y + v * ab.y + w * ac.y;
    }
    return std::numeric_limits<float>::quiet_NaN();
}

/// First vertex of every blade: its triangles share vertices with no other's.
std::vector<std::size_t> bladeStarts(const Mesh& blades) {
    std::vector<std::size_t> starts;
    unsigned used = 0;
    for (const glm::uvec3& t : blades.triangles) {
        if (t.x >= used) starts.push_back(t.x);
        used = std::max({used, t.x + 1, t.y + 1, t.z + 1});
    }
    return starts;
}

TEST(Grass, EveryBladeStandsOnTheGround) {
    const Scene scene = sized("grass", 56'000);
    const Mesh& blades = meshNamed(scene, "blades");
    const Mesh& ground = meshNamed(scene, "ground");
    const std::vector<std::size_t> starts = bladeStarts(blades);
    EXPECT_EQ(starts.size(), 2U * 1926);  // fronts and backs
    for (std::size_t i = 0; i < starts.size(); i += 7) {
        const glm::vec3 root =
            0.5F * (blades.positions[starts[i]] + blades.positions[starts[i] + 1]);
        EXPECT_NEAR(root.y, groundHeight(ground, root), 1e-5F);
    }
    expectTwoSidedSheet(blades);
    for (const Material& material : scene.materials) EXPECT_FALSE(material.isDoubleSided);
    for (const glm::vec3& normal : ground.normals) EXPECT_GT(normal.y, 0.7F);
    EXPECT_EQ(topologyOf(ground).boundaryEdges, 4U * 32);
}

TEST(Grass, BladesShareTheTriangles) {
    const auto areaOf = [](const Scene& scene) { return surfaceArea(meshNamed(scene, "blades")); };
    const double reference = areaOf(generated("grass", "{blades: 2000}"));
    // Odd and even numbers: one blade is cut off where the triangles' parity asks for it.
    for (const int count : {1, 499, 500, 4001, 4002, 8992}) {
        SCOPED_TRACE(count);
        const Scene scene = generated("grass", "{blades: " + std::to_string(count) + "}");
        EXPECT_EQ(scene.triangleCount(), 56'000U);
        const Mesh& blades = meshNamed(scene, "blades");
        expectSoundMesh(blades);
        expectTwoSidedSheet(blades);
        EXPECT_EQ(bladeStarts(blades).size(), 2U * static_cast<std::size_t>(count));
        // A blade has the width that it has, few or many.
        if (count > 400)
            EXPECT_NEAR(areaOf(scene) / reference, count / 2000.0, 0.08 * count / 2000);
    }
    EXPECT_NEAR(areaOf(generated("grass", "{blades: 2000, blade_width: 1.5}")) / reference, 1.5,
                0.001);
}

TEST(Grass, TrianglesOfABladeAreFree) {
    const Mesh shared = meshNamed(generated("grass", "{blades: 2000}"), "blades");
    for (const int ofBlade : {2, 4, 6, 26}) {
        SCOPED_TRACE(ofBlade);
        const Scene scene = generated(
            "grass", "{blades: 2000, blade_triangles: " + std::to_string(ofBlade) + "}", 3);
        EXPECT_EQ(scene.triangleCount(), 56'000U);
        const Mesh& blades = meshNamed(scene, "blades");
        expectSoundMesh(blades);
        expectTwoSidedSheet(blades);
        EXPECT_EQ(blades.triangles.size(), static_cast<std::size_t>(2000 * ofBlade));
        EXPECT_EQ(bladeStarts(blades).size(), 4000U);
        // As wide and as long as those that share what the ground leaves.
        EXPECT_NEAR(surfaceArea(blades) / surfaceArea(shared), 1.0, 0.3);
        // The same ground in more triangles.
        const Mesh& ground = meshNamed(scene, "ground");
        expectSoundMesh(ground);
        EXPECT_EQ(ground.bounds().max.y,
                  meshNamed(generated("grass", "{}", 3), "ground").bounds().max.y);
    }
}

TEST(Grass, DensityGrowsOnTheSameGround) {
    const Scene sparse = sized("grass", 56'000);
    const Scene dense = sized("grass", 2'048 + 4 * (56'000 - 2'048));
    EXPECT_EQ(digestOf(meshNamed(sparse, "ground").positions),
              digestOf(meshNamed(dense, "ground").positions));
    const auto areaOf = [](const Scene& scene) { return surfaceArea(meshNamed(scene, "blades")); };
    // Four times the blades at half the width and the same length.
    EXPECT_NEAR(areaOf(dense) / areaOf(sparse), 2.0, 0.05);
    for (const Scene* scene : {&sparse, &dense}) {
        const Box box = scene->bounds();
        EXPECT_GT(std::min(box.min.x, box.min.z), -1.8F);
        EXPECT_LT(std::max(box.max.x, box.max.z), 1.8F);
        EXPECT_GT(box.min.y, -0.1F);
        EXPECT_LT(box.max.y, 0.95F);
    }
}

TEST(NestAndGrass, BadParametersAreLocated) {
    EXPECT_EQ(refusalOf("bird_nest", "{triangles: 67001}"),
              "t.yaml:1:13: triangles: 67001 is odd, but twigs, eggs and branch are closed, which "
              "takes an even number");
    EXPECT_EQ(refusalOf("bird_nest", "{triangles: 4998}"),
              "t.yaml:1:13: generator 'bird_nest': triangles is 4998; allowed: 5000 … 4000000");
    EXPECT_EQ(refusalOf("grass", "{triangles: 9999}"),
              "t.yaml:1:13: generator 'grass': triangles is 9999; allowed: 10000 … 4000000");
    EXPECT_EQ(refusalOf("grass", "{triangles: many}"),
              "t.yaml:1:13: generator 'grass': triangles is many; allowed: a whole number, 10000 … "
              "4000000");
    EXPECT_EQ(refusalOf("grass", "{triangles: 56001}"),
              "t.yaml:1:13: triangles: 56001 is odd, but a blade has two sides, which takes an "
              "even number");
    EXPECT_EQ(refusalOf("grass", "{blades: 8993}"),
              "t.yaml:1:10: blades: 8993 take at least 53958 triangles, but 53952 are left of "
              "56000 beside the ground");
    EXPECT_EQ(refusalOf("grass", "{blade_width: 6}"),
              "t.yaml:1:15: generator 'grass': blade_width is 6; allowed: 0.2 … 5");
    EXPECT_EQ(refusalOf("grass", "{leaves: 7}"),
              "t.yaml:1:2: generator 'grass': unknown parameter 'leaves'; allowed: triangles, "
              "blades, blade_width, blade_triangles");
    EXPECT_EQ(refusalOf("grass", "{blade_triangles: 7}"),
              "t.yaml:1:19: blade_triangles: 7 is odd, but a blade has two sides, which takes an "
              "even number");
    EXPECT_EQ(refusalOf("grass", "{blades: 6745, blade_triangles: 8}"),
              "t.yaml:1:10: blades: 6745 take at least 53960 triangles, but 53952 are left of "
              "56000 beside the ground");
    EXPECT_EQ(refusalOf("bird_nest", "{twigs: 5000}"),
              "t.yaml:1:9: twigs: 5000 take at least 70000 triangles, but 64404 are left of 67000 "
              "beside eggs and branch");
    EXPECT_EQ(refusalOf("bird_nest", "{sides: 2}"),
              "t.yaml:1:9: sides: 2 enclose nothing; allowed: 0 and 3 … 24");
    EXPECT_EQ(refusalOf("bird_nest", "{twigs: 4000, sides: 4}"),
              "t.yaml:1:9: twigs: 4000 take at least 80000 triangles, but 64404 are left of 67000 "
              "beside eggs and branch");
    EXPECT_EQ(refusalOf("bird_nest", "{twig_thickness: 0.1}"),
              "t.yaml:1:18: generator 'bird_nest': twig_thickness is 0.1; allowed: 0.2 … 5");
}

}  // namespace
}  // namespace gfxrepro::scene
