#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "tests/unit/scene/catalog/generated_scene.h"

namespace gfxrepro::scene {
namespace {

Scene sized(const std::string& name, int triangles, std::uint64_t seed = 1) {
    return generated(name, "{triangles: " + std::to_string(triangles) + "}", seed);
}

struct Case {
    const char* name;
    int triangles;
};

class CityOrTree : public testing::TestWithParam<Case> {};

TEST_P(CityOrTree, HasItsCountAndSoundMeshes) {
    const auto [name, triangles] = GetParam();
    const Scene scene = sized(name, triangles, 5);
    EXPECT_GE(scene.triangleCount(), static_cast<std::size_t>(0.98 * triangles));
    EXPECT_LE(scene.triangleCount(), static_cast<std::size_t>(1.02 * triangles));
    for (const Mesh& mesh : scene.meshes) {
        SCOPED_TRACE(mesh.name);
        expectSoundMesh(mesh);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, CityOrTree,
    testing::Values(Case{"city", 5000}, Case{"city", 7000}, Case{"city", 10'000},
                    Case{"city", 16'000}, Case{"city", 25'000}, Case{"city", 50'000},
                    Case{"city", 130'000}, Case{"city", 1'000'000}, Case{"tree", 10'000},
                    Case{"tree", 25'000}, Case{"tree", 47'001}, Case{"tree", 113'000},
                    Case{"tree", 400'000}, Case{"tree", 2'000'000}),
    [](const auto& info) {
        return std::string(info.param.name) + std::to_string(info.param.triangles);
    });

TEST(CityAndTree, DefaultsAreTheThesis) {
    EXPECT_NEAR(static_cast<double>(generated("city", "{}").triangleCount()), 50e3, 1e3);
    EXPECT_NEAR(static_cast<double>(generated("tree", "{}").triangleCount()), 113e3, 2.26e3);
}

TEST(CityAndTree, EverySeedMeetsTheCount) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        EXPECT_NEAR(static_cast<double>(sized("city", 50'000, seed).triangleCount()), 50e3, 1e3);
        EXPECT_NEAR(static_cast<double>(sized("city", 5000, seed).triangleCount()), 5e3, 100);
        EXPECT_NEAR(static_cast<double>(sized("tree", 10'000, seed).triangleCount()), 10e3, 200);
    }
}

TEST(CityAndTree, AnotherSeedIsAnotherScene) {
    for (const char* name : {"city", "tree"}) {
        EXPECT_EQ(digestOf(sized(name, 12'000, 1)), digestOf(sized(name, 12'000, 1)));
        EXPECT_NE(digestOf(sized(name, 12'000, 1)), digestOf(sized(name, 12'000, 2)));
    }
}

TEST(CityAndTree, SameBytesOnEveryMachine) {
    // A difference here is a changed generator (then kGeneratorVersion goes up) or a compiler that
    // reorders floating point.
    EXPECT_EQ(digestOf(generated("city", "{}")),
              "49d3d1a96d1cf18e0660c3a4d829df93c35070a589e75f624a029178e2a98305");
    EXPECT_EQ(digestOf(generated("tree", "{}")),
              "ff0e3fa079f3e061f6f4e1de497bd8178b1f7837ff681ed65c0d4c2f19b4b648");
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

TEST(CityAndTree, LeavesAreDoubleSidedAndAllElseIsNot) {
    const Scene scene = sized("tree", 12'000);
    for (const Mesh& mesh : scene.meshes) {
        EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(mesh.material)).isDoubleSided,
                  mesh.name == "leaves");
    }
    for (const Material& material : sized("city", 5000).materials) {
        EXPECT_FALSE(material.isDoubleSided);
    }
}

TEST(CityAndTree, BadParametersAreLocated) {
    EXPECT_EQ(test::errorText([] { generated("city", "{triangles: 4999}"); }),
              "t.yaml:1:13: generator 'city': triangles is 4999; allowed: 5000 … 1000000");
    EXPECT_EQ(test::errorText([] { generated("city", "{blocks: 4}"); }),
              "t.yaml:1:2: generator 'city': unknown parameter 'blocks'; allowed: triangles");
    EXPECT_EQ(test::errorText([] { generated("tree", "{triangles: 2000001}"); }),
              "t.yaml:1:13: generator 'tree': triangles is 2000001; allowed: 10000 … 2000000");
    EXPECT_EQ(test::errorText([] { generated("tree", "{leafs: 1}"); }),
              "t.yaml:1:2: generator 'tree': unknown parameter 'leafs'; allowed: triangles");
    EXPECT_EQ(test::errorText([] { generated("four_objects", "{triangles: 48}"); }),
              "t.yaml:1:2: generator 'four_objects': unknown parameter 'triangles'; it has none");
}

}  // namespace
}  // namespace gfxrepro::scene
