// Depth images: what is stored, what is culled and discarded, what is refused.
#include <utility>
#include <vector>

#include "techniques/kit/depth_image.h"
#include "techniques/kit/draws.h"
#include "tests/gl/gl_fixture.h"
#include "tests/techniques/kit/depth_image_fixture.h"
#include "tests/techniques/kit/write_depth_image.h"

namespace gfxrepro::kit {
namespace {

constexpr int kSizePx = 16;

/// A square of side 4 across the view from +z at height z, facing +z; it fills the view.
scene::Mesh squareAt(float z, bool isTurned = false) {
    scene::Mesh mesh = test::rectangle({0, 0, z}, {2, 0, 0}, {0, 2, 0});
    if (isTurned) mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    return mesh;
}

std::vector<View> frontView() {
    return {viewOf(cameraAt({0, 0, 5}, {0, 0, 0}), glm::ivec2(kSizePx))};
}

/// One instance a mesh.
scene::Scene sceneOf(std::vector<scene::Mesh> meshes) {
    scene::Scene scene{.name = "test"};
    for (scene::Mesh& mesh : meshes) {
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::mat4(1.0F)});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

/// The light on a surface of normal +z, and with `color`, in 8 bits.
glm::u8vec4 litFromFront(const glm::vec3& color) {
    const float light = 0.3F + 0.7F * glm::normalize(kLightDirectionWorld).z;
    return {glm::u8vec3(color * light * 255.0F + 0.5F), 255};
}

void expectShading(const HostDepthImage& image, glm::ivec2 pixel, const glm::u8vec4& expected) {
    const glm::u8vec4 value = image.shading[image.indexOf(pixel)];
    for (int channel = 0; channel < 4; ++channel) {
        EXPECT_NEAR(value[channel], expected[channel], 1) << channel;
    }
}

TEST_F(DepthImageTest, HoldsShadingDepthAndIds) {
    scene::Mesh near = squareAt(1.0F);
    for (glm::vec3& position : near.positions) position.x = 0.5F * position.x - 1.0F;  // left half
    scene::Mesh far = squareAt(-1.0F);
    far.normals.assign(4, {0, 0, 1});
    far.colors.assign(4, {1.0F, 0.5F, 0.0F});
    const scene::Scene scene = sceneOf({near, far});
    const HostDepthImage image = drawn(scene, frontView(), false)[0];
    const glm::ivec2 left(1, 4);
    const glm::ivec2 right(14, 4);
    EXPECT_EQ(image.depthM[image.indexOf(left)], 4.0F);
    EXPECT_EQ(image.depthM[image.indexOf(right)], 6.0F);
    EXPECT_LE(image.triangleId[image.indexOf(left)], 2U);
    EXPECT_EQ(image.triangleId[image.indexOf(right)], 3U);     // below the diagonal
    EXPECT_EQ(image.triangleId[image.indexOf({13, 14})], 4U);  // above
    expectShading(image, left, litFromFront(glm::vec3(0.8F)));
    expectShading(image, right, litFromFront({0.8F, 0.4F, 0.0F}));
    const glm::vec3 point = image.pointWorld(right);
    EXPECT_NEAR(point.z, -1.0F, 1e-5F);
}

TEST_F(DepthImageTest, IsEmptyWhereNothingIsSeen) {
    scene::Mesh behind = squareAt(9.0F, true);
    const HostDepthImage image = drawn(sceneOf({behind}), frontView(), false)[0];
    EXPECT_EQ(image.triangleId, std::vector<std::uint32_t>(kSizePx * kSizePx, 0));
    EXPECT_EQ(image.depthM, std::vector<float>(kSizePx * kSizePx, 0.0F));
    EXPECT_EQ(image.shading, std::vector<glm::u8vec4>(kSizePx * kSizePx, glm::u8vec4(0)));
}

TEST_F(DepthImageTest, ClearsWhatWasDrawnBefore) {
    const DrawableScene full(sceneOf({squareAt(0.0F)}));
    const DrawableScene none(sceneOf({squareAt(0.0F, true)}));
    DepthImageRenderer renderer = makeRenderer(DepthFormat::ReversedFloat32);
    DepthImage image = renderer.makeImage(frontView()[0]);
    renderer.render(full, image);
    EXPECT_NE(readDepthImage(image).triangleId[0], 0U);
    renderer.render(none, image);
    EXPECT_EQ(readDepthImage(image).triangleId[0], 0U);
    renderer.render(full, image);
    EXPECT_EQ(readDepthImage(image).depthM[0], 5.0F);
}

TEST_F(DepthImageTest, CullsBackFacesUnlessDoubleSided) {
    scene::Scene scene = sceneOf({squareAt(1.0F, true), squareAt(0.0F)});
    const auto idOf = [](const HostDepthImage& image) {
        return (image.triangleId[image.indexOf({12, 4})] + 1) / 2;  // 1: first square, 2: second
    };
    EXPECT_EQ(idOf(drawn(scene, frontView(), false)[0]), 2U);
    scene.materials.resize(1);
    scene.materials[0].isDoubleSided = true;
    scene.meshes[0].material = 0;
    scene.meshes[0].normals.assign(4, {0, 0, -1});
    const HostDepthImage image = drawn(scene, frontView(), false)[0];
    EXPECT_EQ(idOf(image), 1U);
    // Lit from the side that is seen.
    expectShading(image, {12, 4}, litFromFront(glm::vec3(0.8F)));
}

TEST_F(DepthImageTest, DecodesTexturesAndDiscardsTexelsBelowTheCutoff) {
    scene::Scene scene = sceneOf({squareAt(1.0F), squareAt(0.0F)});
    scene.materials.resize(1);
    scene.materials[0].baseColor = glm::vec4(1.0F);
    scene.materials[0].baseColorTexture = 0;
    scene.materials[0].alphaCutoff = 0.5F;
    scene.meshes[0].material = 0;
    image::Image8 texture(2, 1, 4);  // left: half grey, right: see-through
    const std::uint8_t values[] = {188, 188, 188, 255, 188, 188, 188, 0};
    std::copy(std::begin(values), std::end(values), texture.values().begin());
    scene.textures.push_back(texture);
    const HostDepthImage image = drawn(scene, frontView(), false)[0];
    EXPECT_LE(image.triangleId[image.indexOf({2, 8})], 2U);
    EXPECT_GE(image.triangleId[image.indexOf({13, 8})], 3U);
    expectShading(image, {2, 8}, litFromFront(glm::vec3(0.5029F)));  // sRGB 188 is linear 0.5029
    expectShading(image, {13, 8}, litFromFront(glm::vec3(0.8F)));
}

TEST_F(DepthImageTest, HoldsTheSameSamplesWithoutShading) {
    scene::Scene scene = sceneOf({squareAt(1.0F), squareAt(0.5F), randomTriangles(60, 0.4F, 1)});
    scene.materials.resize(1);
    scene.materials[0].baseColorTexture = 0;
    scene.materials[0].alphaCutoff = 0.5F;
    scene.meshes[0].material = 0;
    scene.textures.emplace_back(2, 2, 4, std::uint8_t{0});  // see-through
    scene.textures[0].at(0, 0, 3) = 255;
    for (const TriangleIds ids : {TriangleIds::PrimitiveId, TriangleIds::GeometryShader}) {
        DepthImageRenderer renderer = makeRenderer(DepthFormat::Float32, ids);
        for (const bool isTested : {true, false}) {
            scene.materials[0].alphaCutoff = isTested ? 0.5F : 0.0F;
            const DrawableScene drawable(scene);
            DepthImage whole = renderer.makeImage(frontView()[0]);
            DepthImage samples = renderer.makeImage(frontView()[0]);
            renderer.render(drawable, whole);
            renderer.render(drawable, samples, {}, Redundancy::Pixel,
                            DepthImageRenderer::Content::Samples);
            const HostDepthImage a = readDepthImage(whole), b = readDepthImage(samples);
            EXPECT_EQ(a.triangleId, b.triangleId);
            EXPECT_EQ(a.depthM, b.depthM);
            EXPECT_NE(a.triangleId.front(), 0U);
        }
    }
}

// A part's triangles are counted on through parts that are drawn apart, instances and mirrors.
TEST_F(DepthImageTest, NumbersTrianglesAsTheFlattenedScene) {
    scene::Scene scene = sceneOf({squareAt(0.0F), squareAt(0.0F, true)});
    scene.materials.resize(1);
    scene.materials[0].isDoubleSided = true;
    scene.meshes[1].material = 0;
    const auto placed = [](float x, float mirror) {
        glm::mat4 matrix(0.25F);
        matrix[0].x *= mirror;
        matrix[3] = {x, 0.0F, 0.0F, 1.0F};
        return matrix;
    };
    scene.instances = {{0, placed(-1.2F, 1.0F)}, {1, placed(0.0F, 1.0F)}, {0, placed(1.2F, -1.0F)}};
    const HostDepthImage image = drawn(scene, frontView(), false)[0];
    const auto squareAtX = [&](float x) {
        const std::optional<glm::ivec2> pixel = pixelOf(image.view, {x, 0.1F, 0.0F});
        return (image.triangleId[image.indexOf(pixel.value_or(glm::ivec2(0)))] + 1) / 2;
    };
    EXPECT_EQ(squareAtX(-1.2F), 1U);
    EXPECT_EQ(squareAtX(0.0F), 2U);
    EXPECT_EQ(squareAtX(1.2F), 3U);
}

TEST_F(DepthImageTest, ComesBackAsItWasWritten) {
    const std::vector<View> views = frontView();
    DepthImage image(views[0], DepthFormat::Float32);
    HostDepthImage host{.view = views[0]};
    for (unsigned i = 0; i < kSizePx * kSizePx; ++i) {
        host.shading.emplace_back(i % 256, i / 3 % 256, i / 5 % 256, 255);
        host.depthM.push_back(static_cast<float>(i) * 0.37F);
        host.triangleId.push_back(4294967295U - i);
    }
    writeDepthImage(host, image);
    const HostDepthImage read = readDepthImage(image);
    EXPECT_EQ(read.shading, host.shading);
    EXPECT_EQ(read.depthM, host.depthM);
    EXPECT_EQ(read.triangleId, host.triangleId);
    // Four bytes a pixel each: shading, depth, id and depth buffer.
    EXPECT_EQ(image.sizeBytes(), 16U * kSizePx * kSizePx);
}

TEST(ShadingPictureTest, HasItsRowsFromTheTopAndABackground) {
    HostDepthImage image;
    image.view.sizePx = {1, 2};
    image.shading = {{255, 0, 51, 255}, {9, 9, 9, 255}};
    image.depthM = {1.0F, 0.0F};
    image.triangleId = {7, 0};
    const image::ImageF picture = shadingPicture(image, {0.1F, 0.2F, 0.3F});
    EXPECT_EQ(std::vector<float>(picture.values().begin(), picture.values().end()),
              (std::vector<float>{0.1F, 0.2F, 0.3F, 1.0F, 0.0F, 0.2F}));
}

TEST_F(DepthImageTest, RefusesScenesWithoutTriangles) {
    EXPECT_EQ(errorText([] { DrawableScene drawable(sceneOf({})); }),
              "scene test: a depth image needs triangles, it has none");
}

TEST(TriangleIdsTest, AreThirtyTwoBitsWide) {
    EXPECT_EQ(errorText([] { requireIdsFor((1ULL << 32) - 1); }), "no error");
    EXPECT_EQ(errorText([] { requireIdsFor(1ULL << 32); }),
              "a scene of 4294967296 triangles: triangle ids are 32 bits wide and number "
              "4294967295 at most");
    EXPECT_THROW(requireIdsFor(1ULL << 32), UnsupportedError);
}

struct FlushedDrawsTest : test::GlTest {
    using Pieces = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    static Pieces piecesOf(FlushedDraws draws) {
        Pieces pieces;
        draws.draw(7, 100'000, [&](std::uint32_t first, std::uint32_t count) {
            pieces.emplace_back(first, count);
        });
        return pieces;
    }
};

TEST_F(FlushedDrawsTest, AreSplitOnSoftwareDevicesAlone) {
    const Pieces whole{{7, 100'000}}, split{{7, 65'536}, {7 + 65'536, 100'000 - 65'536}};
    EXPECT_EQ(piecesOf(FlushedDraws(false)), whole);
    EXPECT_EQ(piecesOf(FlushedDraws(true)), split);
    EXPECT_EQ(piecesOf(FlushedDraws()), device.info().isSoftware ? split : whole);
}

}  // namespace
}  // namespace gfxrepro::kit
