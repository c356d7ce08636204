// The generators object_on_plane and town_square.

#include "tests/scenes/generated_scene.h"
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

TEST(ShadowScenes, SameSeedSameBytes) {
    for (const char* name : {"object_on_plane", "town_square"}) {
        EXPECT_EQ(digestOf(generated(name, "{}")), digestOf(generated(name, "{}"))) << name;
    }
    EXPECT_NE(digestOf(generated("town_square", "{}", 1)),
              digestOf(generated("town_square", "{}", 2)));
}

TEST(ShadowScenes, SameBytesOnEveryMachine) {
    EXPECT_EQ(digestOf(generated("object_on_plane", "{}")),
              "d1f5559e429724dbcb54bc36aed6b0d5186ff9e334afecfe591bca3255203e57");
    EXPECT_EQ(digestOf(generated("town_square", "{}")),
              "cd3cfd1d40cd8b70f727dcbe3d7d3b1f0bdc4777e4c15bb06df23445fd8e43e7");
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

}  // namespace
}  // namespace gfxrepro::scene
