#include <cmath>
#include <utility>

#include "engine/core/files.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/meshes.h"

namespace gfxrepro::test {
namespace {

using scene::Scene;

struct PreviewTest : GlTest {
    gl::ShaderLibrary shaders{dataFolder("shaders")};
};

/// Looks at the origin from +z so that the square fills the middle half of the image's height.
scene::Camera frontCamera() {
    return scene::Camera{
        .position = {0, 0, 2}, .target = {0, 0, 0}, .verticalFovRad = 2.0F * std::atan(1.0F)};
}

void expectPixel(const image::ImageF& image, int x, int y, const glm::vec3& expected) {
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(image.at(x, y, channel), expected[channel], 1e-5F)
            << "pixel " << x << ", " << y << " channel " << channel;
    }
}

/// The headlight's shade of a point of the plane z = 0 at pixel (x, y) of 32 × 32.
float facingAt(int x, int y) {
    const float planeX = (static_cast<float>(x) + 0.5F) / 8.0F - 2.0F;
    const float planeY = 2.0F - (static_cast<float>(y) + 0.5F) / 8.0F;
    return 0.15F + 0.85F * glm::normalize(glm::vec3(-planeX, -planeY, 2)).z;
}

constexpr glm::vec3 kBackground{0.18F, 0.20F, 0.24F};

TEST_F(PreviewTest, ShadesBaseColourUnderAHeadlight) {
    Scene scene = scene::sceneOf(rectangle());
    scene.materials.emplace_back();
    scene.materials[0].baseColor = {0.5F, 0.25F, 1.0F, 1.0F};
    scene.materials[0].emissive = {0.0F, 0.125F, 0.0F};
    scene.meshes[0].material = 0;
    const image::ImageF image = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    ASSERT_EQ(image.channels(), 3);
    for (const auto& [x, y] : {std::pair{8, 8}, {23, 23}, {15, 16}, {20, 9}}) {
        const float shade = facingAt(x, y);
        expectPixel(image, x, y, {0.5F * shade, 0.25F * shade + 0.125F, shade});
    }
    expectPixel(image, 7, 15, kBackground);
    expectPixel(image, 15, 24, kBackground);
}

TEST_F(PreviewTest, InterpolatedNormalsAreNormalizedAndEitherSideIsLit) {
    scene::Mesh mesh = rectangle();
    mesh.normals.assign(4, glm::vec3(0, 0, -1));  // away from the camera: |N·V| is the same
    const image::ImageF image =
        gpu_scene::renderPreview(scene::sceneOf(mesh), frontCamera(), 32, 32, shaders);
    expectPixel(image, 12, 20, glm::vec3(0.8F * facingAt(12, 20)));
}

TEST_F(PreviewTest, TransformsInstancesAndTheirNormals) {
    Scene scene = scene::sceneOf(rectangle());
    // Half as wide, twice as high and deep: the normal must not follow the scaling.
    scene.instances[0].worldFromMesh = glm::mat4(0.5F);
    scene.instances[0].worldFromMesh[1][1] = 2.0F;
    scene.instances[0].worldFromMesh[2][2] = 4.0F;
    scene.instances[0].worldFromMesh[3][3] = 1.0F;
    scene.instances.push_back({0, glm::mat4(1.0F)});
    scene.instances[1].worldFromMesh[3] = {0, 0, -1, 1};  // behind the first
    const image::ImageF image = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    expectPixel(image, 12, 1, glm::vec3(0.8F * facingAt(12, 1)));
    expectPixel(image, 11, 1, kBackground);
    EXPECT_GT(image.at(11, 15), 0.6F);  // the second instance beside the first
}

TEST_F(PreviewTest, SamplesTexturesWithTheirFirstRowOnTopAndCutsOut) {
    Scene scene = scene::sceneOf(rectangle());
    scene.meshes[0].texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // v grows downwards
    scene.meshes[0].material = 0;
    image::Image8 texture(2, 2, 4, 255);
    texture.at(0, 0, 3) = 0;                        // top left: cut out
    texture.at(1, 0, 1) = texture.at(1, 0, 2) = 0;  // top right: red
    scene.textures = {texture};
    scene.materials.emplace_back();
    scene.materials[0].baseColor = {0.5F, 0.5F, 0.5F, 1.0F};
    scene.materials[0].baseColorTexture = 0;
    scene.materials[0].alphaCutoff = 0.25F;
    const image::ImageF image = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    // At the texels' centres (pixels 11.5 and 19.5 of the 16 that the square covers).
    EXPECT_NEAR(image.at(12, 12, 0), 0.18F, 1e-5F);
    EXPECT_GT(image.at(20, 12, 0), 0.4F);
    EXPECT_LT(image.at(20, 12, 1), 0.1F);
    EXPECT_GT(image.at(12, 20, 1), 0.4F);
    EXPECT_GT(image.at(20, 20, 1), 0.4F);
}

TEST_F(PreviewTest, TexturesAreDecodedFromSrgb) {
    Scene scene = scene::sceneOf(rectangle());
    scene.meshes[0].texcoords.assign(4, glm::vec2(0.5F));
    scene.meshes[0].material = 0;
    scene.textures = {image::Image8(1, 1, 3, 188)};
    scene.materials.push_back({.baseColor = glm::vec4(1.0F), .baseColorTexture = 0});
    const image::ImageF image = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    EXPECT_NEAR(image.at(12, 20), 0.502886F * facingAt(12, 20), 1e-3F);
}

TEST_F(PreviewTest, TexturesAreReadAsTheirSamplingSays) {
    using Wrap = scene::Sampling::Wrap;
    Scene scene = scene::sceneOf(rectangle());
    scene.meshes[0].texcoords = {{0, 0}, {4, 0}, {4, 0.4F}, {0, 0.4F}};
    scene.meshes[0].material = 0;
    scene.materials.emplace_back().baseColor = glm::vec4(1.0F);
    scene.materials[0].baseColorTexture = 0;
    scene.textures.emplace_back(2, 1, 3, std::uint8_t{0});
    scene.textures[0].at(0, 0, 0) = 255;  // red beside black, two pixels each
    for (const auto& [wrap, expected] : {std::pair{Wrap::Repeat, "r.r.r.r."},
                                         {Wrap::Mirror, "r..rr..r"},
                                         {Wrap::Clamp, "r......."}}) {
        scene.samplings = {{wrap, Wrap::Clamp, true}};
        const image::ImageF image = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
        for (int x = 8; x < 24; ++x) {
            const float red = expected[(x - 8) / 2] == 'r' ? facingAt(x, 16) : 0.0F;
            expectPixel(image, x, 16, {red, 0, 0});
        }
    }
}

TEST_F(PreviewTest, CutOutsShowWhatIsBehind) {
    Scene scene = scene::sceneOf(rectangle());
    scene.meshes[0].material = 0;
    scene.meshes.push_back(rectangle());
    scene.meshes[1].material = 1;
    scene.instances.push_back({1, glm::mat4(1.0F)});
    scene.instances[1].worldFromMesh[3] = {0, 0, -0.5F, 1};
    scene.materials.push_back({.baseColor = {1, 0, 0, 0.25F}, .alphaCutoff = 0.5F});
    scene.materials.push_back({.baseColor = {0, 1, 0, 1}});
    const image::ImageF through = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    EXPECT_EQ(through.at(15, 15, 0), 0.0F);
    EXPECT_GT(through.at(15, 15, 1), 0.9F);
    scene.materials[0].alphaCutoff = 0.25F;  // not below: it stays
    const image::ImageF stays = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    expectPixel(stays, 15, 15, {facingAt(15, 15), 0.0F, 0.0F});
}

TEST_F(PreviewTest, VertexNormalsShadeAndZeroOnesAreTheTriangles) {
    scene::Mesh mesh = rectangle();
    mesh.normals.assign(4, glm::vec3(0.6F, 0, 0.8F));
    const image::ImageF turned =
        gpu_scene::renderPreview(scene::sceneOf(mesh), frontCamera(), 31, 31, shaders);
    expectPixel(turned, 15, 15, glm::vec3(0.8F * (0.15F + 0.85F * 0.8F)));
    mesh.normals.assign(4, glm::vec3(0));
    const image::ImageF flat =
        gpu_scene::renderPreview(scene::sceneOf(mesh), frontCamera(), 32, 32, shaders);
    expectPixel(flat, 12, 20, glm::vec3(0.8F * facingAt(12, 20)));
}

TEST_F(PreviewTest, VertexColoursAreAFactorOfTheirMeshAlone) {
    Scene scene = scene::sceneOf(rectangle());
    scene.meshes[0].colors.assign(4, {0.5F, 0.25F, 1.0F});
    scene.meshes.push_back(rectangle());  // without colours, behind the first and wider
    scene.instances.push_back({1, glm::mat4(1.0F)});
    scene.instances[1].worldFromMesh[0][0] = 1.5F;
    scene.instances[1].worldFromMesh[3] = {0, 0, -1e-3F, 1};
    const image::ImageF image = gpu_scene::renderPreview(scene, frontCamera(), 32, 32, shaders);
    const float shade = 0.8F * facingAt(12, 20);
    expectPixel(image, 12, 20, {0.5F * shade, 0.25F * shade, shade});
    EXPECT_NEAR(image.at(5, 16, 0), 0.8F * facingAt(5, 16), 1e-3F);
}

TEST_F(PreviewTest, FacetsFarFromTheOriginKeepTheirShade) {
    Scene scene = scene::sceneOf(rectangle());
    const glm::vec3 far(1000.0F, 2000.0F, -1500.0F);
    scene.instances[0].worldFromMesh[3] = {far, 1};
    scene::Camera camera = frontCamera();
    camera.position += far;
    camera.target += far;
    const image::ImageF image = gpu_scene::renderPreview(scene, camera, 32, 32, shaders);
    EXPECT_NEAR(image.at(12, 20), 0.8F * facingAt(12, 20), 1e-3F);
}

TEST_F(PreviewTest, AnEmptySceneIsBackground) {
    const image::ImageF image = gpu_scene::renderPreview(Scene{}, scene::Camera{}, 3, 2, shaders);
    expectPixel(image, 2, 1, kBackground);
}

TEST_F(GlTest, GpuMeshHoldsWhatTheMeshHolds) {
    scene::Mesh mesh = rectangle();
    mesh.texcoords.assign(4, glm::vec2(0.5F));
    const gpu_scene::GpuMesh gpuMesh(mesh);
    EXPECT_EQ(gpuMesh.triangleCount, 2);
    EXPECT_EQ(gpuMesh.positions.read<glm::vec3>(4), mesh.positions);
    EXPECT_EQ(gpuMesh.indices.read<glm::uvec3>(2), mesh.triangles);
    EXPECT_EQ(gpuMesh.normals.id(), 0U);
    EXPECT_EQ(gpuMesh.texcoords.read<glm::vec2>(4), mesh.texcoords);
}

TEST_F(GlTest, GpuMeshDrawsARangeOfTriangles) {
    const gl::Program count = program({{"m.vert.glsl", R"(#version 450 core
layout(location = kPosition) in vec3 position;
void main() { gl_Position = vec4(position, 1.0); }
)"},
                                       {"m.frag.glsl", R"(#version 450 core
layout(std430, binding = 0) buffer Counts { uint counts[2]; };
void main() { atomicAdd(counts[gl_PrimitiveID], 1u); }
)"}},
                                      gpu_scene::attributeDefines());
    const gpu_scene::GpuMesh mesh(rectangle());
    gl::Buffer counts(8);
    const gl::Framebuffer framebuffer = gl::Framebuffer::withoutAttachments({8, 8});
    framebuffer.bind();
    counts.bindStorage(0);
    count.use();
    const auto drawn = [&](int first, int triangles) {
        counts.clear();
        mesh.draw(first, triangles);
        return counts.read<unsigned>(2);
    };
    const std::vector<unsigned> both = drawn(0, 2);
    EXPECT_EQ(both[0] + both[1], 64U);
    EXPECT_EQ(drawn(0, 1), (std::vector<unsigned>{both[0], 0}));
    EXPECT_EQ(drawn(1, 1), (std::vector<unsigned>{both[1], 0}));
    EXPECT_EQ(drawn(2, 0), (std::vector<unsigned>{0, 0}));
}

}  // namespace
}  // namespace gfxrepro::test
