// Scenes prepared for reflections: what reflects, what is repaired and left out, how it is shaded.
#include "techniques/reflections/surfaces.h"

#include <gtest/gtest.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "engine/image/srgb.h"
#include "techniques/reflections/frame.h"
#include "tests/support/grid.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

scene::Scene sceneOf(const scene::Mesh& mesh, const scene::Material& material) {
    scene::Scene scene{.name = "test"};
    addPart(scene, mesh, material);
    return scene;
}

TEST(ReflectorRuleTest, TakesSmoothMaterials) {
    struct Case {
        float roughness, metallic, indexOfRefraction;
        bool isReflector;
        float s, g;  // in 255ths
    };
    // (1.5 − 1)² / (1.5 + 1)² = 0.04 is 10.2 of 255; (3 − 1)² / (3 + 1)² = ¼ is 63.75.
    for (const Case& c :
         {Case{0.0F, 1.0F, 1.5F, true, 255, 0}, Case{0.4F, 0.5F, 1.5F, true, 128, 102},
          Case{0.41F, 1.0F, 1.5F, false, 0, 0}, Case{0.2F, 0.0F, 1.5F, true, 10, 51},
          Case{0.2F, 0.0F, 3.0F, true, 64, 51}, Case{0.0F, 0.0F, 1.0F, false, 0, 0}}) {
        const scene::Material material{.metallic = c.metallic,
                                       .roughness = c.roughness,
                                       .indexOfRefraction = c.indexOfRefraction};
        const ReflectiveScene scene(sceneOf(squareMesh(), material));
        EXPECT_EQ(scene.reflectorCount(), c.isReflector ? 1 : 0) << c.roughness;
        const Object& object = scene.objects()[0];
        EXPECT_EQ(object.reflector, c.isReflector ? 1 : 0) << c.roughness;
        if (!c.isReflector) continue;
        EXPECT_FLOAT_EQ(object.reflectivity, c.s / 255.0F);
        EXPECT_FLOAT_EQ(object.glossiness, c.g / 255.0F);
    }
    const scene::Material rough{.roughness = 0.7F};
    EXPECT_EQ(
        ReflectiveScene(sceneOf(squareMesh(), rough), {.maxRoughness = 0.7F}).reflectorCount(), 1);
}

TEST(ReflectiveSceneTest, NumbersReflectorsInOrderOfInstances) {
    scene::Scene scene;
    const scene::Material mirror{.roughness = 0.0F};
    for (int i = 0; i < 4; ++i) addPart(scene, squareMesh(), i == 1 ? scene::Material{} : mirror);
    scene.instances.push_back({0, glm::mat4(1.0F)});  // the first mesh again: another reflector
    const ReflectiveScene prepared(scene);
    std::vector<int> numbers;
    for (const Object& object : prepared.objects()) numbers.push_back(object.reflector);
    EXPECT_EQ(numbers, (std::vector<int>{1, 0, 2, 3, 4}));
    EXPECT_EQ(prepared.reflectorCount(), 4);
}

TEST(ReflectiveSceneTest, OverridesGlossinessOfReflectors) {
    scene::Scene scene = sceneOf(squareMesh(), {.roughness = 0.0F});
    addPart(scene, squareMesh(), {});
    ReflectiveScene prepared(scene);
    EXPECT_TRUE(prepared.objects()[0].hasOneGlossiness);
    prepared.setGlossiness(0.2F);
    EXPECT_EQ(prepared.objects()[0].glossiness, 51.0F / 255.0F);
    EXPECT_EQ(prepared.objects()[1].glossiness, 0.0F);
}

bool isPlanarReflector(const scene::Mesh& mesh) {
    return ReflectiveScene(sceneOf(mesh, {.roughness = 0.0F})).objects()[0].isPlanar;
}

TEST(PlanarTest, IsOnePlaneWithOneNormal) {
    EXPECT_TRUE(isPlanarReflector(squareMesh()));
    scene::Mesh withoutNormals = squareMesh();
    withoutNormals.normals.clear();
    EXPECT_TRUE(isPlanarReflector(withoutNormals));

    scene::Mesh bent = squareMesh();
    bent.normals[2] = glm::normalize(glm::vec3(0.002F, 0, 1));
    EXPECT_FALSE(isPlanarReflector(bent));
    bent.normals[2] = glm::normalize(glm::vec3(0.0005F, 0, 1));  // within the tolerance
    EXPECT_TRUE(isPlanarReflector(bent));

    // Two shelves: the same normals in two planes.
    scene::MeshBuilder shelves;
    for (const float y : {0.0F, 0.3F}) shelves.addQuad({0, y, 1}, {1, y, 1}, {1, y, 0}, {0, y, 0});
    EXPECT_FALSE(isPlanarReflector(shelves.take("shelves", 0)));
    scene::MeshBuilder box;
    box.addBox(glm::vec3(0), glm::vec3(1));
    EXPECT_FALSE(isPlanarReflector(box.take("box", 0)));
}

TEST(ReflectiveSceneTest, DrawsFlatWhatItsFormatSaysIsFlat) {
    scene::Mesh slab;  // eight corners, as a file without normals has them
    for (int i = 0; i < 8; ++i) slab.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
    slab.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const auto planarCount = [&] {
        const ReflectiveScene scene(sceneOf(slab, {.roughness = 0.0F}), {.splitsParts = true});
        return std::ranges::count_if(scene.objects(), &Object::isPlanar);
    };
    EXPECT_EQ(planarCount(), 0);
    slab.isFlat = true;
    EXPECT_EQ(planarCount(), 6);
}

TEST(ReflectiveSceneTest, LeavesOutWhatLetsLightThrough) {
    scene::Scene scene{.lights = {{}}};
    addPart(scene, squareMesh(), {.roughness = 0.0F});
    addPart(scene, squareMesh(), {.transmission = 0.6F});
    addPart(scene, squareMesh(), {.roughness = 0.0F, .transmission = 0.5F},
            glm::translate(glm::mat4(1.0F), {0, 0, 2}));
    scene.motions = {{.instance = 0, .turnRad = 1.0F},
                     {.instance = 1, .turnRad = 2.0F},
                     {.instance = 2, .turnRad = 3.0F}};
    const ReflectiveScene prepared(scene);
    EXPECT_EQ(
        prepared.warnings(),
        std::vector<std::string>{"scene '': 1 of 3 objects let light through and are left out"});
    EXPECT_EQ(prepared.reflectorCount(), 2);
    ASSERT_EQ(prepared.objects().size(), 2U);
    ASSERT_EQ(prepared.scene().instances.size(), 2U);
    EXPECT_EQ(prepared.scene().instances[1].mesh, 2);
    ASSERT_EQ(prepared.scene().motions.size(), 2U);
    EXPECT_EQ(prepared.scene().motions[1].instance, 1);
    EXPECT_EQ(prepared.scene().motions[1].turnRad, 3.0F);
    EXPECT_EQ(prepared.objects()[1].firstTriangle, 2U);
    EXPECT_EQ(prepared.boundsWorld().max.z, 2.0F);
    EXPECT_EQ(prepared.diagonalM(), std::sqrt(12.0F));
}

TEST(ReflectiveSceneTest, NeedsTrianglesAndReflectors) {
    const auto message = [](const scene::Scene& scene, const ReflectorRule& rule = {}) {
        return errorText([&] { requireReflectors(scene, rule); });
    };
    const scene::Scene empty{.name = "void"};
    EXPECT_EQ(message(empty), "scene 'void': reflections need triangles, it has none");
    EXPECT_EQ(
        message(sceneOf(squareMesh(), {.transmission = 1.0F})),
        "scene 'test': reflections need triangles, it has none (transmissive objects left out: 1)");
    const scene::Scene rough = sceneOf(squareMesh(), {.roughness = 0.5F});
    EXPECT_EQ(message(rough),
              "scene 'test' has no reflectors: no material's roughness is at most 0.4; "
              "'reflector_roughness: 1' takes them all");
    EXPECT_EQ(message(rough, {.maxRoughness = 1.0F}), "no error");
}

TEST(ReflectiveSceneTest, RepairsNormals) {
    scene::Mesh mesh = squareMesh();
    mesh.normals = {
        {kNan, 0, 0}, {0, 0, 0}, {0, 3, 4}, {0, std::numeric_limits<float>::infinity(), 0}};
    const ReflectiveScene prepared(sceneOf(mesh, {.roughness = 0.0F}));
    const std::vector<glm::vec3>& normals = prepared.geometry().normals;
    ASSERT_EQ(normals.size(), 4U);
    for (const std::size_t i : {0U, 1U, 3U}) EXPECT_EQ(normals[i], glm::vec3(0, 0, 1)) << i;
    EXPECT_NEAR(glm::distance(normals[2], glm::vec3(0, 0.6F, 0.8F)), 0.0F, 1e-6F);
}

TEST(ReflectiveSceneTest, RepairsNormalsThatCancelOut) {
    // The same triangle from both sides: the area-weighted sum is zero.
    scene::Mesh mesh = squareMesh();
    mesh.normals.clear();
    mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
    const ReflectiveScene prepared(sceneOf(mesh, {}));
    for (const glm::vec3& normal : prepared.geometry().normals) {
        EXPECT_NEAR(glm::length(normal), 1.0F, 1e-6F);
    }
    EXPECT_EQ(std::abs(prepared.geometry().normals[0].z), 1.0F);
}

TEST(ReflectiveSceneTest, KeepsTheOrderOfTheFlattenedScene) {
    scene::Scene scene;
    addPart(scene, squareMesh(), {}, glm::translate(glm::mat4(1.0F), {5, 0, 0}));
    scene::MeshBuilder builder;
    builder.addBox(glm::vec3(1, 2, 3), glm::vec3(1));
    addPart(scene, builder.take("box", 0), {},
            glm::scale(glm::mat4(1.0F), {-1, 2, 1}));  // mirrored
    scene.instances.push_back({0, glm::rotate(glm::mat4(1.0F), 1.0F, {0, 1, 0})});
    const ReflectiveScene prepared(scene);
    const scene::Mesh flat = scene::flattened(scene);
    const ObjectGeometry& geometry = prepared.geometry();
    ASSERT_EQ(geometry.triangles.size(), flat.triangles.size());
    for (std::size_t t = 0; t < flat.triangles.size(); ++t) {
        const std::uint32_t object = geometry.objectOfTriangle[t];
        ASSERT_GE(t, prepared.objects()[object].firstTriangle);
        ASSERT_LT(
            t, prepared.objects()[object].firstTriangle + prepared.objects()[object].triangleCount);
        const glm::vec3 corner =
            glm::vec3(scene.instances[object].worldFromMesh *
                      glm::vec4(geometry.positions[geometry.triangles[t].x], 1.0F));
        EXPECT_EQ(corner, flat.positions[flat.triangles[t].x]) << t;
    }
    // Arrays are full, also where meshes have nothing.
    EXPECT_EQ(geometry.texcoords.size(), geometry.positions.size());
    EXPECT_EQ(geometry.texcoords[4], glm::vec2(0.0F));
    EXPECT_EQ(geometry.colors[0], glm::vec3(1.0F));
}

TEST(ReflectiveSceneTest, HangsALightWhereThereIsNone) {
    scene::Scene scene = sceneOf(squareMesh(), {});
    const ReflectiveScene without(scene);
    ASSERT_EQ(without.lights().size(), 1U);
    EXPECT_EQ(without.lights()[0].position, glm::vec3(0.0F, 0.9F, 0.0F));
    EXPECT_FLOAT_EQ(without.lights()[0].radiusM, std::sqrt(2.0F));
    EXPECT_EQ(without.warnings(),
              std::vector<std::string>{"scene 'test': it has no light; one is hung below the top "
                                       "of its box (what shines lights nothing)"});
    for (int i = 0; i < kMaxLights; ++i) {
        scene.lights.push_back({.radiusM = 1.0F + static_cast<float>(i)});
    }
    const ReflectiveScene with(scene);
    ASSERT_EQ(with.lights().size(), 64U);
    EXPECT_EQ(with.lights()[5].radiusM, 6.0F);
    EXPECT_TRUE(with.warnings().empty());
    scene.lights.push_back({});
    const ReflectiveScene tooMany(scene);
    EXPECT_EQ(tooMany.lights().size(), 64U);
    EXPECT_EQ(tooMany.warnings(),
              std::vector<std::string>{"scene 'test': 65 lights; the first 64 are taken"});
}

scene::Scene texturedScene(const image::Image8& texture) {
    scene::Scene scene = sceneOf(squareMesh(), {.baseColorTexture = 0});
    scene.textures = {texture};
    scene.lights = {{}};
    return scene;
}

TEST(ReflectiveSceneTest, KeepsTheSizeOfTexturesUpToALimit) {
    const auto sizeOf = [](int width, int height) {
        return ReflectiveScene(texturedScene({width, height, 3}))
            .textureLevels()
            .front()
            .at(0)
            .width();
    };
    EXPECT_EQ(sizeOf(8, 8), 512);
    EXPECT_EQ(sizeOf(512, 512), 512);
    EXPECT_EQ(sizeOf(513, 4), 1024);
    EXPECT_EQ(sizeOf(4, 1024), 1024);
    EXPECT_EQ(sizeOf(2048, 4), 2048);
    const image::Image8 image = randomImage(1024, 1024, 3);
    const ReflectiveScene kept(texturedScene(image));
    EXPECT_EQ(kept.textureLevels().front().at(0), image);
    EXPECT_TRUE(kept.warnings().empty());

    const ReflectiveScene reduced(texturedScene({2049, 4, 3}));
    EXPECT_EQ(reduced.textureLevels().front().at(0).width(), 2048);
    EXPECT_EQ(reduced.warnings(),
              std::vector<std::string>{"scene 'test': 1 of 1 colour textures are reduced to 2048 "
                                       "texels a side; the largest has 2049"});
}

TEST(ReflectiveSceneTest, SaysThatAlphaCutsNoHoles) {
    scene::Scene scene = sceneOf(squareMesh(), {});
    scene.lights = {{}};
    scene.warnings = {"something is left out"};  // the manifest has it, whatever the technique
    scene.materials[0].alphaCutoff = 0.5F;
    EXPECT_EQ(
        ReflectiveScene(scene).warnings(),
        std::vector<std::string>{"scene 'test': materials whose alphaMode MASK cuts no holes: 1"});
}

TEST(ReflectiveSceneTest, ReadsTexturesBeyondTheirEdgesAsTheFileSays) {
    using Wrap = scene::Sampling::Wrap;
    scene::Scene scene =
        sceneOf(squareMesh(), {.baseColor = glm::vec4(1.0F), .baseColorTexture = 0});
    image::Image8 columns(512, 512, 3);  // the left quarter is white
    for (const auto [y, i] : test::grid(512, 3 * 128)) columns.at(i / 3, y, i % 3) = 255;
    scene.textures = {columns};
    scene.meshes[0].texcoords = {{-1, 0.5F}, {2, 0.5F}, {2, 0.5F}, {-1, 0.5F}};
    const auto at = [&](const scene::Sampling& sampling, float u) {
        scene.samplings = {sampling};
        return ReflectiveScene(scene).albedoAt(0, {(u + 1.0F) / 3.0F, 0.0F}).x;
    };
    struct Case {
        float u, repeated, mirrored, clamped;
    };
    for (const Case& c : {Case{-0.9F, 1, 0, 1},
                          {-0.1F, 0, 1, 1},
                          {0.1F, 1, 1, 1},
                          {0.5F, 0, 0, 0},
                          {1.1F, 1, 0, 0},
                          {1.9F, 0, 1, 0}}) {
        EXPECT_NEAR(at({}, c.u), c.repeated, 1e-5F) << c.u;
        EXPECT_NEAR(at({Wrap::Mirror, Wrap::Repeat, false}, c.u), c.mirrored, 1e-5F) << c.u;
        EXPECT_NEAR(at({Wrap::Clamp, Wrap::Repeat, false}, c.u), c.clamped, 1e-5F) << c.u;
    }
    // On the edge itself half of what repeats is the other side's; and between two texels.
    EXPECT_NEAR(at({}, 1.0F), 0.5F, 1e-3F);
    EXPECT_EQ(at({Wrap::Clamp, Wrap::Clamp, false}, 1.0F), 0.0F);
    EXPECT_EQ(at({Wrap::Mirror, Wrap::Clamp, false}, 1.0F), 0.0F);
    EXPECT_NEAR(at({}, 128.1F / 512.0F), 0.4F, 1e-2F);
    EXPECT_EQ(at({Wrap::Repeat, Wrap::Repeat, true}, 128.1F / 512.0F), 0.0F);
    EXPECT_EQ(ReflectiveScene(scene).warnings().size(), 1U) << "its light";
}

/// A texture whose left half has one roughness and metalness, and whose right half another.
image::Image8 halves(const glm::u8vec2& left, const glm::u8vec2& right) {
    return imageOf([&](int x, int) { return glm::u8vec3(0, x < 256 ? left : right); });
}

TEST(ReflectorRuleTest, LooksAtTheTexelsOfTextures) {
    struct Case {
        glm::u8vec2 left, right;  // roughness, metalness
        float roughness;
        float indexOfRefraction;
        bool isReflector;
    };
    for (const Case& c :
         {Case{{255, 0}, {255, 255}, 1.0F, 1.5F, false}, Case{{255, 0}, {50, 0}, 1.0F, 1.5F, true},
          Case{{255, 0}, {50, 0}, 1.0F, 1.0F, false},  // s of 0
          Case{{255, 0}, {255, 0}, 0.3F, 1.5F, true},  // the factor
          Case{{150, 0}, {110, 0}, 1.0F, 1.5F, false}}) {
        scene::Scene scene = sceneOf(squareMesh(), {.metallic = 1.0F,
                                                    .roughness = c.roughness,
                                                    .metallicRoughnessTexture = 0,
                                                    .indexOfRefraction = c.indexOfRefraction});
        scene.textures = {halves(c.left, c.right)};
        const ReflectiveScene prepared(scene);
        EXPECT_EQ(prepared.reflectorCount(), c.isReflector ? 1 : 0) << int{c.right.x};
        EXPECT_EQ(prepared.objects()[0].metallicRoughnessLayer, c.isReflector ? 0 : -1);
    }
}

// The background of an atlas, often 0, is no part of the object.
TEST(ReflectorRuleTest, LooksAtTexelsOfTrianglesOnly) {
    scene::Scene scene = sceneOf(squareMesh(), {.metallic = 1.0F, .metallicRoughnessTexture = 0});
    scene.textures = {halves({255, 255}, {0, 0})};
    EXPECT_EQ(ReflectiveScene(scene).reflectorCount(), 1);
    EXPECT_EQ(ReflectiveScene(scene, {.splitsParts = true}).reflectorCount(), 1);
    for (glm::vec2& texcoord : scene.meshes[0].texcoords) texcoord.x *= 0.49F;
    EXPECT_EQ(ReflectiveScene(scene).reflectorCount(), 0);
    EXPECT_EQ(ReflectiveScene(scene, {.splitsParts = true}).reflectorCount(), 0);
    scene.meshes[0].texcoords.clear();  // nothing to read the texture by
    EXPECT_EQ(ReflectiveScene(scene).reflectorCount(), 0);
}

/// The square with a normal texture of one value.
scene::Scene bentSquare(const glm::u8vec3& normal, float scale = 1.0F) {
    scene::Scene scene =
        sceneOf(squareMesh(), {.roughness = 0.0F, .normalTexture = 0, .normalScale = scale});
    scene.textures = {imageOf([&](int, int) { return normal; })};
    return scene;
}

TEST(TexturedNormalTest, LeansAlongUAndAgainstV) {
    // 255 is 1, 128 is 1/255; the square's u grows with x, its v against y.
    const glm::vec3 toViewer(0, 0, 1);
    const auto normal = [&](const scene::Scene& scene, const glm::mat4& pose,
                            const glm::vec3& outside, const glm::vec3& viewer) {
        return ReflectiveScene(scene).texturedNormalAt(0, {0.3F, 0.3F}, pose, outside, viewer);
    };
    const auto expectNear = [](const glm::vec3& actual, const glm::vec3& expected) {
        EXPECT_LT(glm::distance(actual, glm::normalize(expected)), 0.01F)
            << actual.x << " " << actual.y << " " << actual.z;
    };
    const glm::mat4 rest(1.0F);
    expectNear(normal(bentSquare({255, 128, 255}), rest, toViewer, toViewer), {1, 0, 1});
    expectNear(normal(bentSquare({128, 255, 255}), rest, toViewer, toViewer), {0, 1, 1});
    expectNear(normal(bentSquare({255, 128, 255}, 0.5F), rest, toViewer, toViewer), {0.5F, 0, 1});
    // Where the texture is stretched, each axis keeps its slope.
    scene::Scene stretched = bentSquare({255, 255, 255});
    for (glm::vec2& texcoord : stretched.meshes[0].texcoords) texcoord.y *= 3.0F;
    expectNear(normal(stretched, rest, toViewer, toViewer), {1, 1, 1});
    // From behind all of the frame is turned round.
    expectNear(normal(bentSquare({255, 128, 255}), rest, toViewer, -toViewer), {-1, 0, -1});
    // A mirrored instance: u grows against x, and the outside stays.
    expectNear(
        normal(bentSquare({255, 128, 255}), glm::scale(rest, {-1, 1, 1}), toViewer, toViewer),
        {-1, 0, 1});
    // Edge-on at most.
    expectNear(
        normal(bentSquare({255, 128, 128}), rest, toViewer, glm::normalize(glm::vec3(-1, 0, 0.5F))),
        glm::vec3(0.5F, 0, 1));
    // Texture coordinates that are all the same give no frame.
    scene::Scene flat = bentSquare({255, 128, 255});
    for (glm::vec2& texcoord : flat.meshes[0].texcoords) texcoord = glm::vec2(0.5F);
    EXPECT_EQ(normal(flat, rest, toViewer, toViewer), toViewer);
}

TEST(TexturedNormalTest, KeepsAMirrorFromBeingPlanar) {
    EXPECT_FALSE(ReflectiveScene(bentSquare({128, 128, 255})).objects()[0].isPlanar);
}

TEST(ReflectiveSceneTest, KnowsWhetherItHasMaterialTextures) {
    const auto hasThem = [](const scene::Material& material) {
        scene::Scene scene = sceneOf(squareMesh(), material);
        scene.textures = {randomImage(4, 4, 1)};
        return ReflectiveScene(scene).hasMaterialTextures();
    };
    EXPECT_FALSE(hasThem({.baseColorTexture = 0}));
    EXPECT_TRUE(hasThem({.emissiveTexture = 0}));
    EXPECT_TRUE(hasThem({.normalTexture = 0}));
    EXPECT_TRUE(hasThem({.roughness = 0.0F, .metallicRoughnessTexture = 0}));
}

TEST(ReflectiveSceneTest, FiltersTexturesInLinearLight) {
    scene::Scene scene =
        sceneOf(squareMesh(), {.baseColor = {0.5F, 1.0F, 1.0F, 1.0F}, .baseColorTexture = 1});
    scene.textures = {randomImage(4, 4, 1),  // nobody's
                      randomImage(512, 512, 2)};
    scene.meshes[0].colors.assign(4, {1.0F, 0.25F, 1.0F});
    const ReflectiveScene prepared(scene);
    ASSERT_EQ(prepared.textureLevels().front().size(), 1U);
    const std::array<float, 256> decoding = image::srgbDecoding();
    const auto texel = [&](int x, int y) {
        glm::vec3 value;
        for (int c = 0; c < 3; ++c) value[c] = decoding[scene.textures[1].at(x & 511, y & 511, c)];
        return value * glm::vec3(0.5F, 0.25F, 1.0F);
    };
    // In triangle 0 (left below, right below, right above): (u, v) = (b₁ + b₂, 1 − b₂).
    const auto albedoAt = [&](double xTexels, double yTexels) {
        const double b2 = 1.0 - yTexels / 512.0;
        return prepared.albedoAt(
            0, {static_cast<float>(xTexels / 512.0 - b2), static_cast<float>(b2)});
    };
    const auto expectNear = [](const glm::vec3& actual, const glm::vec3& expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], 1e-4F) << c;
    };
    expectNear(albedoAt(300.5, 400.5), texel(300, 400));  // the middle of a texel
    expectNear(albedoAt(301.0, 400.5), 0.5F * (texel(300, 400) + texel(301, 400)));
    expectNear(albedoAt(300.75, 401.0), 0.375F * (texel(300, 400) + texel(300, 401)) +
                                            0.125F * (texel(301, 400) + texel(301, 401)));
    expectNear(albedoAt(512.0, 400.5), 0.5F * (texel(511, 400) + texel(0, 400)));  // repeats
    expectNear(albedoAt(1024.5 + 7.0, 400.5), texel(7, 400));
    expectNear(albedoAt(-512.0, 0.0),
               0.25F * (texel(511, 511) + texel(0, 511) + texel(511, 0) + texel(0, 0)));
}

TEST(ShadeDiffuseTest, AddsAmbientLightsAndEmission) {
    const glm::vec3 up(0, 1, 0);
    EXPECT_EQ(shadeDiffuse({}, {}, up, glm::vec3(0.5F), {}), glm::vec3(0.2F));
    EXPECT_NEAR(shadeDiffuse({}, {}, -up, glm::vec3(0.5F), {}).x, 0.1F, 1e-6F);
    // Straight above at the radius: half the intensity; at 60° half of that.
    const scene::PointLight light{{0, 2, 0}, {0.4F, 0.8F, 100.0F}, 2.0F};
    const glm::vec3 lit = shadeDiffuse(std::span(&light, 1), {}, up, glm::vec3(0.5F), {0.1F, 0, 0});
    EXPECT_NEAR(lit.r, 0.5F * (0.4F + 0.2F) + 0.1F, 1e-6F);
    EXPECT_NEAR(lit.g, 0.5F * (0.4F + 0.4F), 1e-6F);
    EXPECT_EQ(lit.b, 1.0F);  // clamped
    const glm::vec3 tilted(std::sqrt(0.75F), 0.5F, 0);
    EXPECT_NEAR(shadeDiffuse(std::span(&light, 1), {}, tilted, glm::vec3(0.5F), {}).r,
                0.5F * (0.35F + 0.1F), 1e-6F);
    // From behind, and at the light itself: ambient only, and a number.
    EXPECT_NEAR(shadeDiffuse(std::span(&light, 1), {}, -up, glm::vec3(0.5F), {}).r, 0.1F, 1e-6F);
    EXPECT_EQ(shadeDiffuse(std::span(&light, 1), {0, 2, 0}, up, glm::vec3(0.5F), {}).r, 0.2F);
}

TEST(ReflectiveSceneTest, InterpolatesNormals) {
    scene::Mesh mesh = squareMesh();
    mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
    const ReflectiveScene prepared(sceneOf(mesh, {}));
    EXPECT_EQ(prepared.normalMeshAt(0, {0.25F, 0.5F}), glm::vec3(0.25F, 0.25F, 0.5F));
}

TEST(SurfacePicturesTest, AverageSamplesAndTurnRows) {
    HostGBuffer gbuffer;
    gbuffer.view.sizePx = {4, 4};
    gbuffer.surface.assign(16, 0);
    gbuffer.diffuse.assign(16, glm::vec3(0.0F));
    gbuffer.surface[0] = 1;  // the lowest sample on the left
    EXPECT_EQ(reflectivePixels(gbuffer, 2), (std::vector<std::uint8_t>{0, 0, 1, 0}));
    std::vector<std::uint8_t> marks(16, 0);
    marks[0] = marks[1] = 1;
    const image::ImageF marked = markedPicture(image::ImageF(2, 2, 3, 0.5F), marks, gbuffer, 2);
    EXPECT_FLOAT_EQ(marked.at(0, 1, 0), 0.5F * 0.3F + 0.5F);  // half of its samples
    EXPECT_FLOAT_EQ(marked.at(0, 1, 1), 0.5F * 0.3F);
    EXPECT_FLOAT_EQ(marked.at(1, 1, 0), 0.3F);
}

}  // namespace
}  // namespace gfxrepro::reflections
