
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/scenes/generated_scene.h"

namespace gfxrepro::scene {
namespace {

Scene grown(const std::string& name, int triangles, std::uint64_t seed = 1) {
    return generated(name, "{triangles: " + std::to_string(triangles) + "}", seed);
}

struct Case {
    const char* name;
    int triangles;
};

class CityOrTree : public testing::TestWithParam<Case> {};

TEST_P(CityOrTree, HasItsCountAndSoundMeshes) {
    const auto [name, triangles] = GetParam();
    const Scene scene = grown(name, triangles, 5);
    EXPECT_EQ(scene.triangleCount(), static_cast<std::size_t>(triangles));
    for (const Mesh& mesh : scene.meshes) {
        SCOPED_TRACE(mesh.name);
        expectSoundMesh(mesh);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, CityOrTree,
    testing::Values(Case{"city", 5000}, Case{"city", 7000}, Case{"city", 10'000},
                    Case{"city", 16'000}, Case{"city", 25'001}, Case{"city", 50'000},
                    Case{"city", 130'000}, Case{"city", 1'000'000}, Case{"tree", 10'000},
                    Case{"tree", 25'000}, Case{"tree", 47'002}, Case{"tree", 113'000},
                    Case{"tree", 400'000}, Case{"tree", 2'000'000}),
    [](const auto& info) {
        return std::string(info.param.name) + std::to_string(info.param.triangles);
    });

TEST(CityAndTree, DefaultsAreTheThesis) {
    EXPECT_EQ(generated("city", "{}").triangleCount(), 50'000U);
    EXPECT_EQ(generated("tree", "{}").triangleCount(), 113'000U);
}

TEST(CityAndTree, EverySeedMeetsTheCount) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        EXPECT_EQ(grown("city", 50'000, seed).triangleCount(), 50'000U);
        EXPECT_EQ(grown("city", 5000, seed).triangleCount(), 5000U);
        EXPECT_EQ(grown("tree", 10'000, seed).triangleCount(), 10'000U);
    }
}

/// Height of the highest surface above the origin, or a hand's breadth from it: edges may run
/// through the origin itself.
float heightOverCentre(const Scene& scene) {
    float highest = 0.0F;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 beside(0.11F, 0.0F, 0.07F);
            const glm::vec3 a = mesh.positions[t.x] - beside;
            const glm::vec3 b = mesh.positions[t.y] - beside;
            const glm::vec3 c = mesh.positions[t.z] - beside;
            const float ofC = a.x * b.z - a.z * b.x;
            const float ofA = b.x * c.z - b.z * c.x;
            const float ofB = c.x * a.z - c.z * a.x;
            // Seen from above, counter-clockwise is clockwise in (x, z).
            if (ofA >= 0.0F || ofB >= 0.0F || ofC >= 0.0F) continue;
            highest = std::max(highest, (ofA * a.y + ofB * b.y + ofC * c.y) / (ofA + ofB + ofC));
        }
    }
    return highest;
}

TEST(City, ABuildingStandsUnderItsCentre) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE(seed);
        EXPECT_GT(heightOverCentre(grown("city", 50'000, seed)), 20.0F);
        // Where buildings stand the densest, the lowest have 13 m.
        EXPECT_GT(heightOverCentre(generated("city", "{triangles: 100000, blocks: 5}", seed)),
                  13.0F);
    }
}

TEST(City, BlocksAndHeightsAreTakenAtAnyCount) {
    const Scene usual = generated("city", "{}");
    const auto widthOf = [](const Scene& scene) { return scene.bounds().size().x; };
    // Blocks of 60 m, streets of 15 m around them.
    EXPECT_NEAR(widthOf(usual), 3 * 75 + 15, 0.01F);
    for (const int blocks : {3, 5}) {
        const std::size_t count = blocks == 3 ? 50'000U : 100'000U;
        const Scene scene = generated("city", "{triangles: " + std::to_string(count) +
                                                  ", blocks: " + std::to_string(blocks) + "}");
        EXPECT_EQ(scene.triangleCount(), count);
        EXPECT_NEAR(widthOf(scene), static_cast<float>(blocks * 75 + 15), 0.01F);
    }
    EXPECT_EQ(digestOf(usual), digestOf(generated("city", "{blocks: 3}")));
    const Scene high = generated("city", "{building_height: 2}");
    const Scene low = generated("city", "{building_height: 0.5}");
    for (const Scene* scene : {&high, &low}) {
        EXPECT_EQ(scene->triangleCount(), 50'000U);
        for (const Mesh& mesh : scene->meshes) expectSoundMesh(mesh);
    }
    EXPECT_GT(heightOverCentre(high), 1.5F * heightOverCentre(usual));
    EXPECT_LT(heightOverCentre(low), 0.6F * heightOverCentre(usual));
}

std::size_t leavesOf(const Scene& scene) {
    // A leaf and its back have colours of their own, and no vertices in common with others.
    const Mesh& mesh = meshNamed(scene, "leaves");
    std::size_t count = 1;
    for (std::size_t i = 1; i < mesh.colors.size() / 2; ++i) {
        count += mesh.colors[i] != mesh.colors[i - 1];
    }
    return count;
}

TEST(Tree, LeavesShareTheTriangles) {
    EXPECT_EQ(leavesOf(generated("tree", "{leaves: 4000}")), 4000U);
    double areaBefore = 0.0;
    for (const int leaves : {400, 4000, 12'000, 15'000}) {
        SCOPED_TRACE(leaves);
        const Scene scene = generated("tree", "{leaves: " + std::to_string(leaves) + "}");
        EXPECT_EQ(scene.triangleCount(), 113'000U);
        const Mesh& mesh = meshNamed(scene, "leaves");
        expectSoundMesh(mesh);
        expectTwoSidedSheet(mesh);
        const double area = surfaceArea(mesh);
        EXPECT_GT(area, areaBefore);
        areaBefore = area;
    }
    const double usual = surfaceArea(meshNamed(generated("tree", "{}"), "leaves"));
    const double large = surfaceArea(meshNamed(generated("tree", "{leaf_size: 1.5}"), "leaves"));
    EXPECT_NEAR(large / usual, 2.25, 0.01);
}

TEST(Tree, ALeafMayBeOnePolygon) {
    EXPECT_EQ(digestOf(generated("tree", "{faces: two}")), digestOf(generated("tree", "{}")));
    const Scene two = generated("tree", "{leaves: 4000}");
    const Scene one = generated("tree", "{leaves: 4000, faces: one}");
    EXPECT_EQ(one.triangleCount(), 113'000U);
    const Mesh& leaves = meshNamed(one, "leaves");
    expectSoundMesh(leaves);
    // As many triangles on one side: leaves are as large, not twice.
    EXPECT_EQ(leaves.triangles.size(), meshNamed(two, "leaves").triangles.size());
    EXPECT_NEAR(surfaceArea(leaves) / surfaceArea(meshNamed(two, "leaves")), 0.5, 0.02);
    for (const Material& material : one.materials) EXPECT_FALSE(material.isDoubleSided);
}

TEST(CityAndTree, AnotherSeedIsAnotherScene) {
    for (const char* name : {"city", "tree"}) {
        EXPECT_NE(digestOf(grown(name, 12'000, 1)), digestOf(grown(name, 12'000, 2)));
    }
}

TEST(CityAndTree, SameBytesOnEveryMachine) {
    // A difference here is a changed generator (then kGeneratorVersion goes up) or a compiler that
    // reorders floating point.
    EXPECT_EQ(digestOf(generated("city", "{}")),
              "8bd79651bd492bd697ef62185ff4e5a472832f579ecbc4626dbfa17a866596e2");
    EXPECT_EQ(digestOf(generated("tree", "{}")),
              "2899ce6c44e19794b4a7d5001d2100b0d29e8d8294d16dd640b881f1e7f3c90d");
    EXPECT_EQ(digestOf(generated("four_objects", "{}")),
              "152c60892324cc5b3300066fd8c5d9121d416f68e3286e65fb354f309335d229");
}

/// Whether all vertices are in the square picture from `eye`, within `fill` of its half size.
bool isFramed(const Scene& scene, const glm::vec3& eye, float fill) {
    const Camera& camera = scene.cameras.at(0);
    const glm::vec3 forward = glm::normalize(camera.target - eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::vec3 up = glm::cross(right, forward);
    const float slope = fill * std::tan(0.5F * camera.verticalFovRad);
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& position : mesh.positions) {
            const glm::vec3 d = position - eye;
            const float depth = glm::dot(d, forward);
            if (depth <= 0.0F || std::abs(glm::dot(d, right)) > slope * depth ||
                std::abs(glm::dot(d, up)) > slope * depth) {
                return false;
            }
        }
    }
    return true;
}

TEST(CityAndTree, CamerasAndTheViewsAroundThemHoldTheScene) {
    for (const char* name : {"city", "tree", "four_objects"}) {
        SCOPED_TRACE(name);
        const Scene scene = generated(name, "{}");
        ASSERT_EQ(scene.cameras.size(), 1U);
        const Camera& camera = scene.cameras[0];
        EXPECT_TRUE(isFramed(scene, camera.position, 0.9F));
        // The corners of an upright equilateral triangle around it, half a diagonal wide.
        const glm::vec3 forward = glm::normalize(camera.target - camera.position);
        const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
        const glm::vec3 up = glm::cross(right, forward);
        const float sideM = 0.5F * glm::length(scene.bounds().size());
        const float heightM = sideM * std::sqrt(3.0F) / 2.0F;
        const glm::vec3 low = camera.position - up * (heightM / 3.0F);
        for (const glm::vec3& eye : {low - right * (0.5F * sideM), low + right * (0.5F * sideM),
                                     camera.position + up * (heightM * 2.0F / 3.0F)}) {
            EXPECT_TRUE(isFramed(scene, eye, 1.0F));
            const glm::vec3 outside = glm::max(scene.bounds().min - eye, eye - scene.bounds().max);
            EXPECT_GT(std::max({outside.x, outside.y, outside.z}), 0.0F);
        }
    }
}

TEST(CityAndTree, NothingIsDoubleSidedAndLeavesHaveTwoSides) {
    const Scene tree = grown("tree", 12'000);
    expectTwoSidedSheet(meshNamed(tree, "leaves"));
    for (const Scene& scene : {tree, grown("city", 5000)}) {
        for (const Material& material : scene.materials) EXPECT_FALSE(material.isDoubleSided);
    }
}

TEST(CityAndTree, BadParametersAreLocated) {
    EXPECT_EQ(refusalOf("city", "{triangles: 4999}"),
              "t.yaml:1:13: generator 'city': triangles is 4999; allowed: 5000 … 1000000");
    EXPECT_EQ(refusalOf("city", "{blocks: 4}"),
              "t.yaml:1:10: blocks: 4 is even, which puts a crossing under the city's centre; "
              "allowed: 0 and odd numbers");
    EXPECT_EQ(refusalOf("city", "{triangles: 20000, blocks: 9}"),
              "t.yaml:1:28: blocks: 9 × 9 blocks of such buildings have at least 227600 triangles, "
              "but 'triangles' is 20000");
    EXPECT_EQ(refusalOf("city", "{triangles: 500000, blocks: 1}"),
              "t.yaml:1:29: blocks: 1 × 1 blocks of such buildings have at most 22338 triangles, "
              "but 'triangles' is 500000");
    EXPECT_EQ(refusalOf("city", "{building_height: 0.4}"),
              "t.yaml:1:19: generator 'city': building_height is 0.4; allowed: 0.5 … 3");
    EXPECT_EQ(refusalOf("city", "{streets: 4}"),
              "t.yaml:1:2: generator 'city': unknown parameter 'streets'; allowed: triangles, "
              "blocks, building_height");
    EXPECT_EQ(refusalOf("tree", "{triangles: 2000001}"),
              "t.yaml:1:13: generator 'tree': triangles is 2000001; allowed: 10000 … 2000000");
    EXPECT_EQ(refusalOf("tree", "{triangles: 47001}"),
              "t.yaml:1:13: triangles: 47001 is odd, but a leaf has two sides, which takes an even "
              "number");
    EXPECT_EQ(refusalOf("tree", "{leaves: 30000}"),
              "t.yaml:1:10: leaves: 30000 take at least 120000 triangles, but 82418 are left of "
              "113000 beside wood and ground");
    EXPECT_EQ(refusalOf("tree", "{leaves: 41210, faces: one}"),
              "t.yaml:1:10: leaves: 41210 take at least 82420 triangles, but 82418 are left of "
              "113000 beside wood and ground");
    EXPECT_EQ(refusalOf("tree", "{faces: 3}"),
              "t.yaml:1:9: generator 'tree': faces is 3; allowed: one | two");
    EXPECT_EQ(refusalOf("tree", "{leaf_size: 0}"),
              "t.yaml:1:13: generator 'tree': leaf_size is 0; allowed: 0.2 … 5");
    EXPECT_EQ(refusalOf("tree", "{leafs: 1}"),
              "t.yaml:1:2: generator 'tree': unknown parameter 'leafs'; allowed: triangles, "
              "leaves, leaf_size, faces");
    EXPECT_EQ(refusalOf("four_objects", "{triangles: 48}"),
              "t.yaml:1:2: generator 'four_objects': unknown parameter 'triangles'; it has none");
}

}  // namespace
}  // namespace gfxrepro::scene
