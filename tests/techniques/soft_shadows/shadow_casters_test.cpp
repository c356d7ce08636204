// What the casters draw into a shadow map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "engine/scene/topology.h"
#include "techniques/soft_shadows/shadow_casters.h"
#include "tests/support/grid.h"
#include "tests/support/topology.h"
#include "tests/techniques/soft_shadows/reconstruction_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::soft_shadows {
namespace {

using kit::View;
namespace shapes = voxelization::shapes;

struct ShadowCastersTest : ReconstructionTest {
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

// Fewer triangles, the surface within the error, borders untouched.

namespace {

namespace shapes = voxelization::shapes;

/// n × n quads over the unit square of the xy plane, z by `height`.
template <class Height>
scene::Mesh grid(unsigned n, Height&& height) {
    scene::Mesh mesh;
    for (unsigned y = 0; y <= n; ++y) {
        for (unsigned x = 0; x <= n; ++x) {
            const glm::vec2 p = glm::vec2(x, y) / static_cast<float>(n);
            mesh.positions.emplace_back(p, height(p));
        }
    }
    for (const auto [y, x] : test::grid<unsigned>(n, n)) {
        const unsigned a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(c, d, a);
    }
    return mesh;
}

using Point = std::tuple<float, float, float>;

std::set<Point> borderPoints(const scene::Mesh& mesh) {
    const auto table = scene::edgesOf(mesh.triangles, scene::weldedByPosition(mesh.positions));
    std::set<Point> points;
    for (const std::uint32_t corner : table.firstCorner) {
        if (table.nextCorner[corner] != scene::kNone) continue;
        for (const std::uint32_t i : {corner % 3, (corner + 1) % 3}) {
            const glm::vec3 p = mesh.positions[mesh.triangles[corner / 3][static_cast<int>(i)]];
            points.emplace(p.x, p.y, p.z);
        }
    }
    return points;
}

double areaOf(const scene::Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a,
                                             glm::dvec3(mesh.positions[t.z]) - a));
    }
    return area;
}

TEST(SimplifiedTest, APlaneLosesAllButItsBorder) {
    const scene::Mesh mesh = grid(32, [](const glm::vec2&) { return 0.0F; });
    const SimplifiedMesh result = simplified(mesh, {.triangleRatio = 0.01F, .maxErrorM = 1e-3F});
    // 128 points on the border allow no fewer than 126 triangles.
    EXPECT_GE(result.mesh.triangles.size(), 126U);
    EXPECT_LT(result.mesh.triangles.size(), 300U);
    EXPECT_EQ(borderPoints(mesh).size(), 128U);
    EXPECT_EQ(borderPoints(result.mesh), borderPoints(mesh));
    EXPECT_NEAR(areaOf(result.mesh), 1.0, 1e-6);
    EXPECT_LE(result.errorM, 1e-3F);
    EXPECT_EQ(scene::topologyOf(result.mesh).components, 1U);
}

TEST(SimplifiedTest, ASphereStaysWithinTheError) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(1.0F, 2.0F, 3.0F), 2.0F, 5);
    for (const float ratio : {0.5F, 0.1F}) {
        const SimplifiedMesh result = simplified(mesh, {.triangleRatio = ratio, .maxErrorM = 0.1F});
        const double kept = static_cast<double>(result.mesh.triangles.size()) /
                            static_cast<double>(mesh.triangles.size());
        EXPECT_NEAR(kept, ratio, 0.01);
        EXPECT_GT(result.errorM, 0.0F);
        EXPECT_LE(result.errorM, 0.1F);
        EXPECT_TRUE(scene::topologyOf(result.mesh).isClosed());
        EXPECT_TRUE(scene::topologyOf(result.mesh).isOriented());
        for (const glm::uvec3& t : result.mesh.triangles) {
            const glm::vec3 middle = (result.mesh.positions[t.x] + result.mesh.positions[t.y] +
                                      result.mesh.positions[t.z]) /
                                     3.0F;
            EXPECT_NEAR(glm::distance(middle, glm::vec3(1.0F, 2.0F, 3.0F)), 2.0F, 0.1F);
        }
    }
}

TEST(SimplifiedTest, TheErrorEndsItBeforeTheRatio) {
    const scene::Mesh mesh =
        grid(32, [](const glm::vec2& p) { return 0.1F * std::sin(20.0F * p.x * p.y); });
    const SimplifiedMesh coarse = simplified(mesh, {.triangleRatio = 0.0F, .maxErrorM = 0.05F});
    const SimplifiedMesh fine = simplified(mesh, {.triangleRatio = 0.0F, .maxErrorM = 0.001F});
    EXPECT_LE(fine.errorM, 0.001F);
    EXPECT_LE(coarse.errorM, 0.05F);
    EXPECT_LT(coarse.mesh.triangles.size(), fine.mesh.triangles.size());
    EXPECT_LT(fine.mesh.triangles.size(), mesh.triangles.size());
}

TEST(SimplifiedTest, TheRatioOneKeepsAll) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0.0F), 1.0F, 2);
    const SimplifiedMesh result = simplified(mesh, {.triangleRatio = 1.0F, .maxErrorM = 1.0F});
    EXPECT_EQ(result.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(result.mesh.positions.size(), mesh.positions.size());
    EXPECT_EQ(result.errorM, 0.0F);
}

TEST(SimplifiedTest, NothingStaysNothing) {
    const SimplifiedMesh result = simplified(scene::Mesh{}, {});
    EXPECT_TRUE(result.mesh.triangles.empty());
    EXPECT_TRUE(result.mesh.positions.empty());
    EXPECT_EQ(result.errorM, 0.0F);
}

}  // namespace

}  // namespace gfxrepro::soft_shadows
