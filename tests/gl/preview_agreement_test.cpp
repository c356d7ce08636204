// The rasterized look at a scene against the ray traced one: the same formula on other ground.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/files.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "engine/raycast/ray_tracer.h"
#include "engine/scene/load.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

using image::ImageF;

constexpr float kThreshold = 0.02F;
constexpr int kSizePx = 256;

float difference(const ImageF& a, int ax, int ay, const ImageF& b, int bx, int by) {
    float largest = 0.0F;
    for (int channel = 0; channel < 3; ++channel) {
        largest = std::max(largest, std::abs(a.at(ax, ay, channel) - b.at(bx, by, channel)));
    }
    return largest;
}

/// Whether a neighbour of the pixel looks different: a silhouette, or an edge between facets.
bool isOnEdge(const ImageF& image, int x, int y) {
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, image.height() - 1); ++ny) {
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, image.width() - 1); ++nx) {
            if (difference(image, x, y, image, nx, ny) > kThreshold) return true;
        }
    }
    return false;
}

class PreviewAgreementTest : public GlTest {
  protected:
    /// At most 0.5 % of the pixels may differ visibly: at edges the two round a pixel's centre to
    /// one side or the other. A difference elsewhere is another formula.
    void expectAgreement(const scene::Scene& scene) const {
        const scene::Camera camera = scene::framingCamera(scene.bounds(), 1.0F);
        const ImageF raster = gpu_scene::renderPreview(scene, camera, kSizePx, kSizePx,
                                                       gl::ShaderLibrary(dataFolder("shaders")));
        const ImageF rays = raycast::renderPreview(scene, camera, kSizePx, kSizePx);
        int differing = 0;
        int offEdges = 0;
        int covered = 0;
        for (int y = 0; y < kSizePx; ++y) {
            for (int x = 0; x < kSizePx; ++x) {
                covered += difference(rays, x, y, rays, 0, 0) > kThreshold;
                // The negation counts not-a-number as a difference.
                if (difference(raster, x, y, rays, x, y) <= kThreshold) continue;
                ++differing;
                offEdges += !isOnEdge(rays, x, y);
            }
        }
        EXPECT_LE(differing, kSizePx * kSizePx / 200);
        EXPECT_EQ(offEdges, 0);
        EXPECT_GT(covered, kSizePx * kSizePx / 20);  // else both are background
    }
};

/// A unit sphere of latitudes and longitudes, without normals.
scene::Mesh sphere(unsigned segments) {
    scene::Mesh mesh;
    for (unsigned i = 0; i <= segments; ++i) {
        for (unsigned j = 0; j <= segments; ++j) {
            const float u = static_cast<float>(j) / static_cast<float>(segments);
            const float v = static_cast<float>(i) / static_cast<float>(segments);
            const float polar = v * std::numbers::pi_v<float>;
            const float azimuth = u * 2.0F * std::numbers::pi_v<float>;
            mesh.positions.push_back({std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                      std::sin(polar) * std::sin(azimuth)});
            mesh.texcoords.push_back({3.0F * u, v});
        }
    }
    for (unsigned i = 0; i < segments; ++i) {
        for (unsigned j = 0; j < segments; ++j) {
            const unsigned corner = i * (segments + 1) + j;
            mesh.triangles.push_back({corner, corner + 1, corner + segments + 1});
            mesh.triangles.push_back({corner + 1, corner + segments + 2, corner + segments + 1});
        }
    }
    return mesh;
}

TEST_F(PreviewAgreementTest, FacetsWithoutNormals) {
    expectAgreement(scene::sceneOf(sphere(12)));
}

TEST_F(PreviewAgreementTest, FacetsFarFromTheOrigin) {
    // As in geographic coordinates: positions carry 1/512 of the sphere's radius.
    scene::Scene scene = scene::sceneOf(sphere(12));
    scene.instances[0].worldFromMesh[3] = glm::vec4(20000, 1000, -15000, 1);
    expectAgreement(scene);
}

TEST_F(PreviewAgreementTest, InstancesWithNormalsTexturesAndCutOuts) {
    scene::Scene scene = scene::sceneOf(sphere(24));
    scene.meshes[0].normals = scene.meshes[0].positions;
    scene.meshes[0].material = 0;
    scene.meshes.push_back(sphere(16));
    scene.meshes[1].material = 1;
    image::Image8 texture(8, 4, 4, 255);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            texture.at(x, y, 0) = static_cast<std::uint8_t>(40 * y + 90);
            texture.at(x, y, 1) = static_cast<std::uint8_t>(30 * x + 10);
            texture.at(x, y, 3) = x % 4 == 1 ? 0 : 255;
        }
    }
    scene.textures = {texture};
    scene.materials.resize(2);
    scene.materials[0].baseColorTexture = 0;
    scene.materials[0].alphaCutoff = 0.5F;
    scene.materials[1].baseColor = {0.2F, 0.6F, 0.3F, 1.0F};
    scene.materials[1].emissive = {0.1F, 0.0F, 0.0F};
    glm::mat4 stretched(1.0F);
    stretched[0][0] = 0.4F;
    stretched[1][1] = 1.6F;
    stretched[2][0] = 0.3F;
    stretched[3] = {1.2F, 0.1F, -0.4F, 1};
    glm::mat4 inside(0.5F);
    inside[3][3] = 1.0F;
    scene.instances.push_back({0, stretched});
    scene.instances.push_back({1, inside});  // seen through the first one's holes
    expectAgreement(scene);
}

TEST_F(PreviewAgreementTest, VertexColoursTimesBaseColourBesideMeshesWithoutThem) {
    scene::Scene scene = scene::sceneOf(sphere(24));
    scene.meshes[0].material = 0;
    scene.materials.resize(1);
    scene.materials[0].baseColor = {0.9F, 0.5F, 0.7F, 1.0F};
    for (const glm::vec3& position : scene.meshes[0].positions) {
        scene.meshes[0].colors.push_back(0.5F + 0.5F * position);
    }
    // After the coloured one: its colours must not stay behind.
    scene.meshes.push_back(sphere(16));
    glm::mat4 aside(1.0F);
    aside[3] = {2.0F, 0.5F, -1.0F, 1};
    scene.instances.push_back({1, aside});
    expectAgreement(scene);

    const scene::Camera camera = scene::framingCamera(scene.bounds(), 1.0F);
    const ImageF coloured = raycast::renderPreview(scene, camera, kSizePx, kSizePx);
    scene.meshes[0].colors.clear();
    const ImageF plain = raycast::renderPreview(scene, camera, kSizePx, kSizePx);
    int changed = 0;
    for (int y = 0; y < kSizePx; ++y) {
        for (int x = 0; x < kSizePx; ++x) {
            changed += difference(coloured, x, y, plain, x, y) > kThreshold;
        }
    }
    EXPECT_GT(changed, kSizePx * kSizePx / 20);  // else neither multiplies
}

TEST_F(PreviewAgreementTest, ZeroNormalsFallBackToTheTriangles) {
    scene::Scene scene = scene::sceneOf(sphere(12));
    scene.meshes[0].normals.assign(scene.meshes[0].positions.size(), glm::vec3(0));
    expectAgreement(scene);
}

TEST_F(PreviewAgreementTest, RealModels) {
    for (const char* name : {"bunny/bun_zipper.ply", "gltf/Duck/glTF_Binary/Duck.glb"}) {
        const auto path = asset(name);
        if (!path) GTEST_SKIP() << "GFXREPRO_ASSETS has no " << name;
        SCOPED_TRACE(name);
        expectAgreement(scene::loadScene(*path));
    }
}

}  // namespace
}  // namespace gfxrepro::test
