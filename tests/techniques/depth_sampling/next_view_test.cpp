#include "techniques/depth_sampling/pixel_measures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/files.h"
#include "scenes/shared/mesh_builder.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::depth_sampling {
namespace {

scene::Camera cameraFrom(const glm::vec3& position, const glm::vec3& target = glm::vec3(0.0F)) {
    scene::Camera camera;
    camera.position = position;
    camera.target = target;
    camera.nearM = 0.5F;
    camera.farM = 30.0F;
    return camera;
}

/// A wall across the view along −z, and a block behind it that shows from the right only.
scene::Scene wallAndHiddenBlock() {
    scene::MeshBuilder builder;
    builder.addBox({0.0F, 0.0F, 0.0F}, {1.5F, 1.5F, 0.05F});
    builder.addBox({0.5F, 0.0F, -2.0F}, {0.4F, 0.4F, 0.4F});
    return scene::sceneOf(builder.take("wall and block", -1));
}

class NextViewTest : public test::GlTest {
  protected:
    kit::DepthImage conventional(const scene::Camera& camera) {
        auto image = renderer.makeImage(kit::viewOf(camera, {48, 48}));
        renderer.render(scene, image);
        return image;
    }

    gl::ShaderLibrary programShaders{dataFolder("shaders")};
    kit::DepthImageRenderer renderer{programShaders, kit::TriangleIds::PrimitiveId,
                                     kit::DepthFormat::Float32};
    kit::DrawableScene scene{wallAndHiddenBlock()};

    const scene::Camera front = cameraFrom({0, 0, 8});
    const scene::Camera frontAbove = cameraFrom({0, 0.5F, 8});
    const scene::Camera right = cameraFrom({8, 0, -1}, {0, 0, -1});
    const scene::Camera away = cameraFrom({0, 0, 8}, {0, 0, 20});
    // Most of what they show is the block.
    const std::vector<scene::Camera> outputs = {cameraFrom({7, 0.5F, -1.5F}, {0, 0, -1}),
                                                cameraFrom({7, -0.5F, -2.0F}, {0, 0, -1})};
};

TEST_F(NextViewTest, IsTheOnlyOneThatSeesTheHiddenBlock) {
    NextView nextView(programShaders, renderer, scene, {away, front, frontAbove, right}, outputs,
                      {48, 48});
    const kit::DepthImage first = conventional(front);
    const kit::DepthImage* const soFar[] = {&first};
    const NextView::Choice choice = nextView.next(soFar);
    EXPECT_EQ(choice.candidate, 3U);
    EXPECT_EQ(choice.camera.position, right.position);
    EXPECT_GT(choice.gainedSamples, 100U);
    // With that image at hand, no candidate gains more than rims that its resolution missed.
    const kit::DepthImage second = conventional(right);
    const kit::DepthImage* const both[] = {&first, &second};
    EXPECT_LT(nextView.next(both).gainedSamples, choice.gainedSamples / 10);
}

TEST_F(NextViewTest, CountsWhatOutputFramesNeedAndNoImageHas) {
    // The front shows the wall, which the output frame needs, but the image so far has it already.
    NextView nextView(programShaders, renderer, scene, {front}, {front}, {48, 48});
    const NextView::Choice before = nextView.next({});
    const kit::HostDepthImage frame = readDepthImage(conventional(front));
    const auto samples = static_cast<std::uint64_t>(
        std::count_if(frame.triangleId.begin(), frame.triangleId.end(),
                      [](std::uint32_t triangleId) { return triangleId != 0; }));
    EXPECT_GT(samples, 100U);
    EXPECT_EQ(before.gainedSamples, samples);
    const kit::DepthImage first = conventional(front);
    const kit::DepthImage* const soFar[] = {&first};
    EXPECT_EQ(nextView.next(soFar).gainedSamples, 0U);
}

TEST_F(NextViewTest, TiesGoToTheFirstCandidate) {
    NextView equal(programShaders, renderer, scene, {away, right, right}, outputs, {48, 48});
    EXPECT_EQ(equal.next({}).candidate, 1U);
    NextView useless(programShaders, renderer, scene, {away, away}, outputs, {48, 48});
    EXPECT_EQ(useless.next({}).candidate, 0U);
    EXPECT_EQ(useless.next({}).gainedSamples, 0U);
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
