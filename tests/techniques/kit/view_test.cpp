// Projection: analytic cases, and the shaders' functions against those of the host.
#include "techniques/kit/view.h"

#include <cmath>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/kit/path_view.h"
#include "tests/support/support.h"
#include "tests/techniques/kit/depth_image_fixture.h"

namespace gfxrepro::kit {
namespace {

/// Looks along −z from z = 1 with a right angle of view: at z = 0 it sees [−1, 1]².
View plainView(glm::ivec2 sizePx, glm::vec2 offsetPx = glm::vec2(0.0F)) {
    scene::Camera camera = cameraAt({0, 0, 1}, {0, 0, 0});
    camera.verticalFovRad = std::atan(1.0F) * 2.0F;
    return viewOf(camera, sizePx, offsetPx);
}

void expectNear(const glm::vec3& value, const glm::vec3& expected, float tolerance) {
    EXPECT_LE(glm::distance(value, expected), tolerance)
        << value.x << ' ' << value.y << ' ' << value.z;
}

TEST(ViewTest, ProjectsToPixelsFromTheLowerLeft) {
    const View view = plainView({64, 64});
    const std::optional<glm::vec2> centre = project(view, {0, 0, 0});
    ASSERT_TRUE(centre);
    EXPECT_NEAR(centre->x, 32.0F, 1e-4F);
    EXPECT_NEAR(centre->y, 32.0F, 1e-4F);
    const std::optional<glm::vec2> upperRight = project(view, {0.5F, 0.75F, 0});
    ASSERT_TRUE(upperRight);
    EXPECT_NEAR(upperRight->x, 48.0F, 1e-4F);
    EXPECT_NEAR(upperRight->y, 56.0F, 1e-4F);
}

TEST(ViewTest, SeesNothingOnOrBehindTheEyesPlane) {
    const View view = plainView({64, 64});
    EXPECT_FALSE(project(view, {0, 0, 1}));
    EXPECT_FALSE(project(view, {0.1F, 0, 2}));
    EXPECT_FALSE(pixelOf(view, {0, 0, 2}));
    EXPECT_TRUE(project(view, {0, 0, 0.999F}));
}

TEST(ViewTest, CountsTheLowerBorderToTheImageAndTheUpperNot) {
    // With these matrices everything is exact: x = (px − 32) · d / 32 at the distance d.
    View view;
    view.sizePx = {64, 64};
    view.clipFromView = glm::mat4(0.0F);
    view.clipFromView[0].x = view.clipFromView[1].y = 1.0F;
    view.clipFromView[2].z = view.clipFromView[2].w = -1.0F;
    EXPECT_EQ(pixelOf(view, {-1, -1, -1}), glm::ivec2(0, 0));
    EXPECT_FALSE(pixelOf(view, {1, 0, -1}));  // x = 64 = width
    EXPECT_FALSE(pixelOf(view, {0, 1, -1}));
    EXPECT_FALSE(pixelOf(view, {std::nextafter(-1.0F, -2.0F) - 1e-6F, 0, -1}));
    EXPECT_EQ(pixelOf(view, {0.99F, 0.99F, -1}), glm::ivec2(63, 63));
}

TEST(ViewTest, MovesTheSamplesByTheOffset) {
    const View plain = plainView({64, 32});
    const View moved = plainView({64, 32}, {0.5F, 0.5F});
    // The sample of pixel p lies at p + 0.5 of its own view and at p + 1 of the plain one.
    for (const glm::ivec2 pixel : {glm::ivec2(0, 0), {63, 0}, {17, 29}}) {
        const glm::vec3 point = unproject(moved, glm::vec2(pixel) + 0.5F, 3.0F);
        const std::optional<glm::vec2> there = project(plain, point);
        ASSERT_TRUE(there);
        EXPECT_NEAR(there->x, static_cast<float>(pixel.x) + 1.0F, 1e-4F);
        EXPECT_NEAR(there->y, static_cast<float>(pixel.y) + 1.0F, 1e-4F);
    }
}

TEST(ViewTest, UnprojectsToThePointThatProjectsThere) {
    for (const View& view : threeViews(128)) {
        for (const glm::vec2 position : {glm::vec2(0.5F, 0.5F), {127.5F, 3.25F}, {64.0F, 90.0F}}) {
            const glm::vec3 point = unproject(view, position, 4.0F);
            expectNear(glm::vec3(project(view, point).value_or(glm::vec2(-1.0F)), 0.0F),
                       glm::vec3(position, 0.0F), 1e-3F);
            EXPECT_NEAR(-(view.viewFromWorld * glm::vec4(point, 1.0F)).z, 4.0F, 1e-5F);
            expectNear(glm::normalize(point - view.eyeWorld), rayThrough(view, position), 1e-6F);
            const glm::vec4 pixels(position * 4.0F, 4.0F, 1.0F);
            expectNear(glm::vec3(worldFromPixels(view) * pixels), point, 1e-5F);
        }
    }
}

TEST(ViewTest, ReprojectsAsUnprojectingAndProjecting) {
    const std::vector<View> views = threeViews(128);
    for (int column = 0; column < 4; ++column) {
        const glm::vec4 difference =
            reprojection(views[0], views[0])[column] - glm::mat4(1.0F)[column];
        EXPECT_LE(glm::length(difference), 1e-9F);  // identity: doubles, rounded
    }
    for (const glm::vec2 position : {glm::vec2(0.5F, 0.5F), {100.5F, 3.5F}, {64.5F, 90.5F}}) {
        const glm::vec4 there =
            reprojection(views[0], views[2]) * glm::vec4(position * 5.0F, 5.0F, 1.0F);
        const glm::vec3 point = unproject(views[0], position, 5.0F);
        const std::optional<glm::vec2> expected = project(views[2], point);
        ASSERT_TRUE(expected);
        expectNear({there.x / there.z, there.y / there.z, there.z},
                   {*expected, -(views[2].viewFromWorld * glm::vec4(point, 1.0F)).z}, 1e-3F);
    }
}

constexpr const char* kReprojectShader = R"(#version 450 core
#include "kit/redundancy_tests.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer Samples { vec4 samples[]; };
layout(std430, binding = 1) writeonly buffer Results { vec4 results[]; };
uniform mat4 thereFromHere;
void main() {
    uint i = gl_GlobalInvocationID.x;
    results[i] = vec4(reproject(thereFromHere, samples[i].xyz), 0.0);
}
)";

class ViewShaderTest : public DepthImageTest {};

TEST_F(ViewShaderTest, ReprojectsAsTheHostDoes) {
    const std::vector<View> views = threeViews(1024);
    const View& here = views[0];
    const View& there = views[1];
    Random random(5);
    std::vector<glm::vec4> samples;
    for (int i = 0; i < 4096; ++i) {
        const glm::ivec2 pixel{random.index(1024), random.index(1024)};
        samples.emplace_back(glm::vec2(pixel) + 0.5F, random.uniform(3.0F, 7.0F), 0.0F);
    }

    // The library takes one folder: the shader under test goes next to a copy of the included one.
    folder.write("kit/redundancy_tests.glsl",
                 readFile(shaders.folder() / "kit/redundancy_tests.glsl"));
    const gl::Program compute = program({{"reproject.comp.glsl", kReprojectShader}});
    const gl::Buffer sampleBuffer = gl::Buffer::of(samples);
    gl::Buffer resultBuffer(samples.size() * sizeof(glm::vec4));
    sampleBuffer.bindStorage(0);
    resultBuffer.bindStorage(1);
    compute.use();
    compute.set("thereFromHere", reprojection(here, there));
    glDispatchCompute(static_cast<GLuint>(samples.size()), 1, 1);
    const auto results = resultBuffer.read<glm::vec4>(samples.size());

    for (std::size_t i = 0; i < samples.size(); ++i) {
        const glm::vec3 point = unproject(here, glm::vec2(samples[i]), samples[i].z);
        const std::optional<glm::vec2> expected = project(there, point);
        ASSERT_TRUE(expected);
        EXPECT_LE(glm::distance(glm::vec2(results[i]), *expected), 1e-3F) << i;
    }
}

scene::Camera cameraAtX(const std::string& name, float x) {
    return scene::Camera{.name = name, .position = {x, 0, 0}};
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

TEST(PathView, HoldsTheWholeSceneWhereAPathSwingsOut) {
    const std::string path = "0 0 2>0 0 0; 0 0 30>0 0 0; 0 0 30>0 0 0; 0 0 2>0 0 0";
    const scene::Camera out = cameraAtTime(box(), path, 0.5, 1.0F);
    EXPECT_GT(out.position.z, 33.0F);
    EXPECT_GT(out.farM, glm::distance(out.position, {-1, -1, -1}));
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
