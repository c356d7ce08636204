// What the casters draw into a shadow map.
#include <algorithm>
#include <cmath>

#include "techniques/soft_shadows/shadow_casters.h"
#include "tests/techniques/soft_shadows/reconstruction_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::soft_shadows {
namespace {

using kit::View;
namespace shapes = voxelization::shapes;

class ShadowCastersTest : public ReconstructionTest {
  protected:
    /// Depth along the view axis a pixel, rows from the bottom; 0 where nothing was drawn.
    static std::vector<float> depthsOf(const ShadowCaster& caster, const View& view) {
        const gl::Texture depth = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, view.sizePx);
        const gl::Framebuffer framebuffer({}, &depth);
        framebuffer.clearDepth(1.0F);
        framebuffer.bind();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDepthMask(GL_TRUE);
        caster.draw(view);
        std::vector<float> depths = depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1);
        for (float& d : depths) {
            const float ndc = 2.0F * d - 1.0F;  // clip z = p₂₂ · z + p₃₂, w = −z = depth
            d = d == 1.0F ? 0.0F : view.clipFromView[3].z / (-view.clipFromView[2].z - ndc) * -1.0F;
        }
        return depths;
    }
};

std::size_t countDrawn(const std::vector<float>& depths) {
    return static_cast<std::size_t>(
        std::count_if(depths.begin(), depths.end(), [](float d) { return d != 0.0F; }));
}

TEST_F(ShadowCastersTest, TheSceneCasterDrawsTheScene) {
    const scene::Mesh mesh = shapes::torus(glm::vec3(0.0F), 0.7F, 0.3F, 60, 30);
    const kit::DrawableScene scene(scene::sceneOf(mesh));
    const SceneCaster caster(shaders(), scene);
    EXPECT_EQ(caster.triangleCount(), mesh.triangles.size());
    const scene::Camera camera = scene::framingCamera(mesh.bounds(), 1.0F);
    const ImagePair traced = traceImages(mesh, camera, {64, 64});
    const std::vector<float> drawn = depthsOf(caster, traced.image.view);
    std::size_t different = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const float depth = traced.image.depthM[i];
        different += !(std::abs(drawn[i] - depth) <= 1e-3F * depth);
    }
    EXPECT_GT(countDrawn(drawn), 500U);
    EXPECT_LE(different, 4U);  // rays that pass an outline at the middle of a pixel
}

TEST_F(ShadowCastersTest, AMeshCasterDrawsLikeTheScene) {
    const scene::Mesh mesh = shapes::randomTriangles(300, 4);
    const kit::DrawableScene scene(scene::sceneOf(mesh));
    const MeshCaster caster(shaders(), mesh);
    EXPECT_EQ(caster.triangleCount(), mesh.triangles.size());
    const View view = viewOf(scene::framingCamera(mesh.bounds(), 1.0F), {64, 64});
    const std::vector<float> drawn = depthsOf(caster, view);
    EXPECT_GT(countDrawn(drawn), 500U);
    EXPECT_EQ(drawn, depthsOf(SceneCaster(shaders(), scene), view));
}

TEST_F(ShadowCastersTest, AReconstructionSeenFromItsOwnViewIsTheImage) {
    const scene::Mesh mesh = shapes::cube(glm::vec3(0.0F), glm::vec3(1.0F, 0.7F, 0.4F));
    const ImagePair images = traceImages(mesh, scene::framingCamera(mesh.bounds(), 1.2F), {90, 75});
    HostMesh host = reconstruct(images, reference::normalsOf(mesh), {});
    std::vector<ReconstructedMesh> meshes;
    meshes.push_back(std::move(host.mesh));
    const ReconstructedCaster caster(shaders(), std::move(meshes));
    EXPECT_EQ(caster.triangleCount(), host.triangles.size());
    const std::vector<float> drawn = depthsOf(caster, images.image.view);
    std::size_t exact = 0, samples = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const double depth = images.image.depthM[i];
        ASSERT_EQ(drawn[i] == 0.0F, depth == 0.0) << i;
        if (depth == 0.0) continue;
        const double footprint = reference::footprintM(images.image.view, depth);
        const double error = std::abs(drawn[i] - depth);
        // A quad across an edge of the cube bends, by no more than a valid corner may differ.
        EXPECT_LT(error, 4.0 * footprint) << i;
        exact += error < 0.01 * footprint;
        ++samples;
    }
    EXPECT_GT(exact, samples - samples / 10);
}

TEST_F(ShadowCastersTest, SeveralReconstructionsAreDrawnLikeTheirWorldMeshes) {
    const scene::Mesh mesh = shapes::torus(glm::vec3(0.0F), 0.7F, 0.3F, 200, 100);
    const std::vector<glm::vec3> normals = reference::normalsOf(mesh);
    scene::Camera camera = scene::framingCamera(mesh.bounds(), 1.0F);
    const View lightView = viewOf(camera, {64, 64});
    std::vector<ReconstructedMesh> meshes;
    scene::Mesh joined;
    for (const float side : {-0.6F, 0.9F}) {
        camera.position.x += side;
        meshes.push_back(reconstruct(traceImages(mesh, camera, {80, 80}), normals, {}).mesh);
        joined = shapes::joined(joined, toWorldMesh(meshes.back()));
    }
    const ReconstructedCaster caster(shaders(), std::move(meshes));
    EXPECT_EQ(caster.triangleCount(), joined.triangles.size());
    const std::vector<float> drawn = depthsOf(caster, lightView);
    const std::vector<float> expected = depthsOf(MeshCaster(shaders(), joined), lightView);
    EXPECT_GT(countDrawn(drawn), 500U);
    std::size_t different = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        different += !(std::abs(drawn[i] - expected[i]) <= 1e-4F * expected[i]);
    }
    EXPECT_LE(different, 4U);  // other rounding: an outline may cross the middle of a pixel
}

TEST_F(ShadowCastersTest, AnEmptyReconstructionDrawsNothing) {
    const ImagePair images = emptyPair({8, 8});
    std::vector<ReconstructedMesh> meshes;
    meshes.push_back(reconstruct(images, std::vector<glm::vec3>(1), {}).mesh);
    const ReconstructedCaster caster(shaders(), std::move(meshes));
    EXPECT_EQ(caster.triangleCount(), 0U);
    EXPECT_EQ(countDrawn(depthsOf(caster, viewOf(originCamera(), {8, 8}))), 0U);
}

}  // namespace
}  // namespace gfxrepro::soft_shadows
