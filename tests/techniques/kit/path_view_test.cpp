#include "techniques/kit/path_view.h"

#include <cmath>

#include "scenes/shared/mesh_builder.h"
#include "tests/support/support.h"

namespace gfxrepro::kit {
namespace {

scene::Camera cameraAtX(const std::string& name, float x) {
    scene::Camera camera;
    camera.name = name;
    camera.position = {x, 0, 0};
    return camera;
}

scene::Scene box() {
    scene::MeshBuilder builder;
    builder.addBox({0, 0, 0}, {1, 1, 1});
    return scene::sceneOf(builder.take("box", -1));
}

scene::Scene boxWithViews() {
    scene::Scene scene = box();
    scene.cameras = {cameraAtX("front", 10), cameraAtX("side", 11), cameraAtX("round", 12)};
    scene.paths.push_back({"round", {cameraAtX("", 0), cameraAtX("", 1)}});
    scene.paths.push_back({"through", {cameraAtX("", 4), cameraAtX("", 8)}});
    return scene;
}

TEST(PathView, TakesTheMiddleOfAFramesTime) {
    EXPECT_EQ(frameTime(0, 1), 0.5);
    EXPECT_EQ(frameTime(0, 4), 0.125);
    EXPECT_EQ(frameTime(3, 4), 0.875);
}

TEST(PathView, FindsPathsBeforeCamerasByName) {
    const scene::Scene scene = boxWithViews();
    EXPECT_EQ(cameraFor(scene, "side", 0, 1, 1.0F).position.x, 11.0F);
    EXPECT_FLOAT_EQ(cameraFor(scene, "through", 0, 1, 1.0F).position.x, 6.0F);
    EXPECT_FLOAT_EQ(cameraFor(scene, "round", 0, 1, 1.0F).position.x, 0.5F);
    EXPECT_GT(cameraFor(scene, "through", 3, 4, 1.0F).position.x,
              cameraFor(scene, "through", 2, 4, 1.0F).position.x);
}

TEST(PathView, WithoutANameTakesTheFirstThatThereIs) {
    scene::Scene scene = boxWithViews();
    EXPECT_FLOAT_EQ(cameraFor(scene, "", 0, 1, 1.0F).position.x, 0.5F);
    scene.paths.clear();
    EXPECT_EQ(cameraFor(scene, "", 0, 1, 1.0F).position.x, 10.0F);
    scene.cameras.clear();
    EXPECT_EQ(cameraFor(scene, "", 0, 1, 1.5F).position,
              scene::framingCamera(scene.bounds(), 1.5F).position);
}

TEST(PathView, AStillTakesTheFirstCameraOrTheOneThatIsNamed) {
    scene::Scene scene = boxWithViews();
    EXPECT_EQ(stillCamera(scene, "", 1.0F).position.x, 10.0F);
    EXPECT_EQ(stillCamera(scene, "side", 1.0F).position.x, 11.0F);
    EXPECT_FLOAT_EQ(stillCamera(scene, "through", 1.0F).position.x, 6.0F);
    scene.cameras.clear();
    EXPECT_EQ(stillCamera(scene, "", 1.5F).position,
              scene::framingCamera(scene.bounds(), 1.5F).position);
}

TEST(PathView, FramesTheSceneFromAnyDirection) {
    const auto seenFrom = [](const char* view) {
        const scene::Camera camera = stillCamera(boxWithViews(), view, 1.5F);
        EXPECT_EQ(camera.target, glm::vec3(0.0F)) << view;
        return glm::normalize(camera.position - camera.target);
    };
    const auto isAlong = [&](const char* view, glm::vec3 direction) {
        return glm::distance(seenFrom(view), direction) < 1e-5F;
    };
    EXPECT_TRUE(isAlong("0 0", {0, 0, 1}));
    EXPECT_TRUE(isAlong("90 0", {1, 0, 0}));
    EXPECT_TRUE(isAlong("180 45", {0, std::sqrt(0.5F), -std::sqrt(0.5F)}));
    EXPECT_TRUE(isAlong("-90 -30", {-std::sqrt(0.75F), -0.5F, 0}));
    EXPECT_TRUE(isAlong("10 90", {0, 1, 0}));
    EXPECT_EQ(stillCamera(box(), "0 -90", 1.0F).up, glm::vec3(0, 0, -1));
    EXPECT_THAT(errorText([] { stillCamera(box(), "0 91", 1.0F); }),
                StartsWith("the scene has no path or camera '0 91'"));
}

TEST(PathView, LooksFromAPointToAnotherAndAlongAPathOfThem) {
    const scene::Camera still = stillCamera(boxWithViews(), "4 2 0.5 > 0 -1 0", 1.0F);
    EXPECT_EQ(still.position, glm::vec3(4, 2, 0.5F));
    EXPECT_EQ(still.target, glm::vec3(0, -1, 0));
    EXPECT_LT(still.nearM, 3.0F);
    EXPECT_GT(still.farM, glm::distance(still.position, {-1, -1, -1}));
    EXPECT_EQ(stillCamera(box(), "0 9 0 > 0 1 0", 1.0F).up, glm::vec3(0, 0, -1));
    const std::string path = "0 0 8>0 0 0; 2 0 8>0 0 0;4 0 8 > 0 0 2";
    EXPECT_EQ(cameraAtTime(box(), path, 0.0, 1.0F).position, glm::vec3(0, 0, 8));
    EXPECT_EQ(cameraAtTime(box(), path, 0.5, 1.0F).position, glm::vec3(2, 0, 8));
    EXPECT_EQ(cameraAtTime(box(), path, 1.0, 1.0F).target, glm::vec3(0, 0, 2));
    for (const char* wrong :
         {"1 2 > 0 0 0", "1 2 3 > 0 0 0 0", "1 2 3 >", "1 2 3 > 0 0 0;", "1 2 3 > 0 0 0 > 1 1 1"}) {
        EXPECT_THAT(errorText([&] { stillCamera(box(), wrong, 1.0F); }),
                    StartsWith("the scene has no path or camera '"))
            << wrong;
    }
    EXPECT_EQ(errorText([] { stillCamera(box(), "0 0 8 > 0 0 0; 1 2 3 > 1 2 3", 1.0F); }),
              "view '0 0 8 > 0 0 0; 1 2 3 > 1 2 3': from 1 2 3 to the same point; allowed: to "
              "another one");
}

TEST(PathView, NamesWhatThereIsWhenANameIsUnknown) {
    EXPECT_EQ(errorText([] { cameraFor(boxWithViews(), "back", 0, 1, 1.0F); }),
              "the scene has no path or camera 'back'; paths: 'round', 'through'; cameras: "
              "'front', 'side', 'round'; or 'AZIMUTH ELEVATION' in degrees, or 'X Y Z > X Y Z' "
              "from and to, with more such behind ';' a path");
    EXPECT_EQ(
        errorText([] { cameraFor(box(), "back", 0, 1, 1.0F); }),
        "the scene has no path or camera 'back'; paths: none; cameras: none; or 'AZIMUTH "
        "ELEVATION' in degrees, or 'X Y Z > X Y Z' from and to, with more such behind ';' a path");
}

}  // namespace
}  // namespace gfxrepro::kit
