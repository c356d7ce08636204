// Real models: what other programs counted in them, less the vertices that no triangle uses (1,113
// of the bunny, 2 of the small dragon).

#include <algorithm>

#include "engine/scene/load.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

struct Known {
    const char* file;
    std::size_t vertices;  // that triangles use
    std::size_t triangles;
    glm::vec3 min;  // to three decimals
    glm::vec3 max;
};

void PrintTo(const Known& known, std::ostream* out) {
    *out << known.file;
}

/// All that the file holds, as it stands there (bounds before the node matrices).
struct Measured {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    Box box;
};

Measured measured(const Scene& scene) {
    Measured result{scene.points.positions.size(), 0, scene.points.bounds()};
    for (const Mesh& mesh : scene.meshes) {
        result.vertices += mesh.positions.size();
        result.triangles += mesh.triangles.size();
        result.box.add(mesh.bounds());
        const auto isInside = [&](const glm::uvec3& triangle) {
            return std::max({triangle.x, triangle.y, triangle.z}) < mesh.positions.size();
        };
        EXPECT_TRUE(std::all_of(mesh.triangles.begin(), mesh.triangles.end(), isInside));
    }
    return result;
}

class LoadAssets : public testing::TestWithParam<Known> {};

TEST_P(LoadAssets, HaveTheirKnownCounts) {
    const Known& known = GetParam();
    const auto path = test::asset(known.file);
    if (!path) GTEST_SKIP() << "the asset " << known.file << " is missing";
    const Scene scene = loadScene(*path);
    const Measured found = measured(scene);
    EXPECT_EQ(found.vertices, known.vertices);
    EXPECT_EQ(found.triangles, known.triangles);
    if (known.min != known.max) {
        const float tolerance = 0.0005F * 1.01F;  // half of the last decimal printed
        EXPECT_TRUE(glm::all(
            glm::lessThanEqual(glm::abs(found.box.min - known.min), glm::vec3(tolerance))));
        EXPECT_TRUE(glm::all(
            glm::lessThanEqual(glm::abs(found.box.max - known.max), glm::vec3(tolerance))));
    }
    EXPECT_EQ(scene.origin.sha256.size(), 64U);
}

INSTANTIATE_TEST_SUITE_P(
    Files, LoadAssets,
    testing::Values(
        Known{"bunny/bun_zipper.ply", 34834, 69451, {-0.095, 0.033, -0.062}, {0.061, 0.187, 0.059}},
        Known{"dragon/dragon_vrip.ply",
              437645,
              871414,
              {-0.108, 0.053, -0.05},
              {0.097, 0.197, 0.041}},
        Known{"dragon/dragon_vrip_res4.ply",
              5203,
              11102,
              {-0.108, 0.053, -0.05},
              {0.095, 0.196, 0.041}},
        Known{"buddha/buddha_100k.obj",
              49950,
              100000,
              {-0.461, -1.002, -0.324},
              {0.352, 0.978, 0.49}},
        Known{"blade/turbineblade.ply",
              99519,
              199034,
              {-10.929, -5.967, 106.086},
              {11.588, 9.066, 148.86}},
        Known{"lion/lion_takanawa_points.ply",
              341989,
              0,
              {-4.985, 1.039, -3.445},
              {-0.789, 6.723, 1.123}},
        Known{"living-room/grey_white_room.glb",
              119519,
              143163,
              {-0.513, -0.003, -3.635},
              {5.123, 2.879, 0.593}},
        Known{"bathroom/salle_de_bain.glb",
              437356,
              653694,
              {-13.75, -6.413, -11.639},
              {12.642, 16.11, 17.62}},
        Known{"dining-room/breakfast_room.glb",
              142720,
              269538,
              {-6.353, -1.521, -4.542},
              {5.263, 7.903, 9.888}},
        Known{"city/delft.ply", 18262, 36267, {0.468, 0.999, 0.548}, {524.839, 328.636, 17.846}},
        Known{"living-room/obj/Mesh012.obj", 6485, 12708, {}, {}},
        Known{"gltf/gltf_transform_core/BoxTextured_glTF/BoxTextured.gltf", 24, 12, {}, {}},
        Known{"gltf/gltf_transform_core/Box_glTF-Binary/Box.glb", 24, 12, {}, {}},
        Known{"gltf/gltf_transform_core/Box_glTF-Embedded/Box.gltf", 24, 12, {}, {}},
        Known{"gltf/gltf_transform_functions/TwoCubes.glb", 48, 24, {}, {}}));

TEST(LoadRoom, HasTexturesMaterialsAndACamera) {
    const auto path = test::asset("living-room/grey_white_room.glb");
    if (!path) GTEST_SKIP() << "the asset living-room/grey_white_room.glb is missing";
    const Scene scene = loadGltf(*path);
    EXPECT_EQ(scene.materials.size(), 19U);
    EXPECT_EQ(scene.textures.size(), 4U);
    EXPECT_EQ(scene.cameras.size(), 1U);
}

}  // namespace
}  // namespace gfxrepro::scene
