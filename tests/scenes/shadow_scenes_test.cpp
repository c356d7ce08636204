// The generators object_on_plane and town_square.
#include "engine/core/files.h"
#include "scenes/terrain/terrain.h"
#include "tests/scenes/generated_scene.h"
#include "tests/support/support.h"
#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

TEST(ShadowScenes, MeshesAreSound) {
    for (const char* name : {"object_on_plane", "town_square"}) {
        for (const Mesh& mesh : generated(name, "{}").meshes) {
            if (mesh.name == "object") continue;  // polygonized: slivers, tested below
            SCOPED_TRACE(mesh.name);
            expectSoundMesh(mesh);
        }
    }
}

TEST(ShadowScenes, SameBytesOnEveryMachine) {
    EXPECT_EQ(digestOf(generated("object_on_plane", "{}")),
              "d1f5559e429724dbcb54bc36aed6b0d5186ff9e334afecfe591bca3255203e57");
    EXPECT_EQ(digestOf(generated("town_square", "{}")),
              "cd3cfd1d40cd8b70f727dcbe3d7d3b1f0bdc4777e4c15bb06df23445fd8e43e7");
    EXPECT_NE(digestOf(generated("town_square", "{}", 1)),
              digestOf(generated("town_square", "{}", 2)));
}

TEST(ObjectOnPlane, TheShapeStandsOnThePlaneAndPlatesFloatAboveIt) {
    const Scene scene = generated("object_on_plane", "{}");
    const float floor = meshNamed(scene, "plane").bounds().max.y;
    EXPECT_NEAR(meshNamed(scene, "object").bounds().min.y, floor, 1e-5F);
    EXPECT_NEAR(meshNamed(scene, "plates").bounds().min.y, floor + 0.01F, 1e-5F);
    const Topology object = topologyOf(meshNamed(scene, "object"));
    EXPECT_TRUE(object.isClosed() && object.isManifold() && object.isOriented());
    EXPECT_GT(signedVolume(meshNamed(scene, "object")), 0.0);
    EXPECT_EQ(topologyOf(meshNamed(scene, "plates")).components, 3U);
}

TEST(FractalTerrain, IsTheSameForASeedAndHasItsRelief) {
    FractalTerrain shape{.sizeSamples = 129};
    const HeightMap a = fractalTerrain(shape, 1);
    EXPECT_EQ(a.heightsM, fractalTerrain(shape, 1).heightsM);
    EXPECT_NE(a.heightsM, fractalTerrain(shape, 2).heightsM);
    EXPECT_EQ(a.bounds().min.y, 0.0F);
    EXPECT_NEAR(a.bounds().max.y, shape.reliefM, 0.01F);
    shape.sizeSamples = 1;
    EXPECT_EQ(fractalTerrain(shape, 1).heightsM, std::vector<float>{0.0F});
}

TEST(FractalTerrain, IsTheSameInAFile) {
    const TemporaryFolder folder;
    const FractalTerrain shape{.sizeSamples = 129};
    const HeightMap expected = fractalTerrain(shape, 5);
    for (int i = 0; i < 2; ++i) {  // made, then found
        const HeightMap found = fractalTerrainInFile(shape, 5, folder.path(), "key");
        ASSERT_NE(found.file, nullptr);
        EXPECT_EQ(found.spacingM, expected.spacingM);
        for (int at = 0; at < 129 * 129; ++at) {
            ASSERT_EQ(found.heightM(at % 129, at / 129), expected.heightM(at % 129, at / 129));
        }
    }
    writeFileAtomic(folder.path() / "file", "no folder");
    testing::internal::CaptureStderr();
    const HeightMap kept = fractalTerrainInFile(shape, 5, folder.path() / "file", "key");
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "warning: a generated terrain is held in memory, all of it: cannot create " +
                  (folder.path() / "file").string() + ": Not a directory\n");
    EXPECT_EQ(kept.heightsM, expected.heightsM);
}

}  // namespace
}  // namespace gfxrepro::scene
