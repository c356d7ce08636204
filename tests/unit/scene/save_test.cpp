
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "engine/core/random.h"
#include "engine/scene/load.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

using Lines = std::vector<std::string>;

/// A mesh whose numbers use all their bits.
Mesh randomMesh(std::uint64_t seed) {
    Random random(seed);
    const auto vec3 = [&random] {
        return glm::vec3{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
    };
    Mesh mesh{.name = "mesh" + std::to_string(seed)};
    for (std::uint32_t i = 0; i < 100; ++i) {
        mesh.positions.push_back(vec3());
        mesh.normals.push_back(glm::normalize(vec3()));
        mesh.texcoords.push_back({random.uniform(-1, 2), random.uniform()});
        mesh.colors.push_back(glm::abs(vec3()));
        mesh.triangles.push_back({i, random.index(100), random.index(100)});  // all are used
    }
    return mesh;
}

void expectSame(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.texcoords, b.texcoords);
    EXPECT_EQ(a.colors, b.colors);
    EXPECT_EQ(a.triangles, b.triangles);
}

using SavePly = FolderTest;

TEST_F(SavePly, ComesBackExactly) {
    const Mesh mesh = randomMesh(1);
    savePly(folder.path() / "a.PLY", sceneOf(mesh));
    const Scene scene = loadScene(folder.path() / "a.PLY");
    expectSame(scene.meshes.at(0), mesh);
    EXPECT_EQ(scene.name, "a");
    EXPECT_EQ(scene.origin.kind, Origin::Kind::Real);
    EXPECT_EQ(scene.origin.description, "a.PLY");
    EXPECT_EQ(scene.origin.sha256.size(), 64U);
}

TEST_F(SavePly, KeepsPoints) {
    Scene scene;
    const Mesh mesh = randomMesh(2);
    scene.points = {mesh.positions, mesh.normals, std::vector<float>(100, 0.1F), mesh.colors};
    savePly(folder.path() / "a.ply", scene);
    const PointCloud points = loadPly(folder.path() / "a.ply").points;
    EXPECT_EQ(points.positions, scene.points.positions);
    EXPECT_EQ(points.normals, scene.points.normals);
    EXPECT_EQ(points.radii, scene.points.radii);
    EXPECT_EQ(points.colors, scene.points.colors);
}

TEST_F(SavePly, RefusesNothing) {
    EXPECT_EQ(errorText([&] { savePly(folder.path() / "a.ply", Scene{}); }, folder.path()),
              "cannot write DIR/a.ply: the scene has no triangles and no points");
}

TEST(LoadScene, ListsTheExtensions) {
    EXPECT_EQ(errorText([] { loadScene("model.fbx"); }),
              "model.fbx: unknown extension '.fbx'; .ply, .obj, .gltf, .glb, .off, .stl, .xyz and "
              ".las are allowed");
}

Material unusualMaterial() {
    return Material{.name = "unusual",
                    .baseColor = {0.1F, 0.2F, 0.3F, 0.7F},
                    .metallic = 0.9F,
                    .roughness = 0.3F,
                    .emissive = {0.1F, 17.3F, 3.3F},
                    .baseColorTexture = 0,
                    .metallicRoughnessTexture = 1,
                    .normalTexture = 0,
                    .normalScale = 0.75F,
                    .emissiveTexture = 1,
                    .alphaCutoff = 0.6F,
                    .isDoubleSided = true,
                    .isUnlit = true,
                    .transmission = 0.8F,
                    .indexOfRefraction = 1.31F};
}

using SaveGlb = FolderTest;

TEST_F(SaveGlb, KeepsInstancesMaterialsTexturesAndCameras) {
    Scene scene;
    scene.meshes = {randomMesh(3), randomMesh(4)};
    scene.meshes[1].material = 1;
    scene.meshes[0].colors.clear();
    scene.materials = {Material{}, unusualMaterial()};
    scene.textures.emplace_back(3, 2, 4, std::uint8_t{77});
    scene.textures.emplace_back(1, 1, 3, std::uint8_t{7});  // used by nothing
    scene.samplings = {{Sampling::Wrap::Mirror, Sampling::Wrap::Clamp, true}};
    scene.instances = {{0, glm::mat4(1.0F)},
                       {1, glm::translate(glm::mat4(1.0F), glm::vec3(0.1F, 2, 3))},
                       {0, glm::scale(glm::mat4(1.0F), glm::vec3(-0.3F, 1, 1))}};
    const Camera camera{.name = "eye", .position = {1, 2, 3}, .target = {0, 0, 0}};
    scene.cameras = {camera};
    saveGlb(folder.path() / "a.glb", scene);
    const Scene back = loadGltf(folder.path() / "a.glb");

    ASSERT_EQ(back.meshes.size(), 2U);
    expectSame(back.meshes[0], scene.meshes[0]);
    expectSame(back.meshes[1], scene.meshes[1]);
    EXPECT_EQ(back.meshes[1].name, "mesh4");
    EXPECT_EQ(back.meshes[0].material, -1);
    EXPECT_EQ(back.meshes[1].material, 1);
    ASSERT_EQ(back.instances.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back.instances[i].mesh, scene.instances[i].mesh);
        EXPECT_EQ(back.instances[i].worldFromMesh, scene.instances[i].worldFromMesh);
    }
    EXPECT_EQ(back.textures.at(0), scene.textures[0]);
    EXPECT_EQ(back.samplings, scene.samplings);
    const Camera& eye = back.cameras.at(0);
    EXPECT_EQ(eye.position, camera.position);
    EXPECT_LT(
        glm::length(glm::normalize(eye.target - eye.position) + glm::normalize(camera.position)),
        1e-6F);
    EXPECT_LT(glm::length(eye.target - camera.target), 1e-6F) << "the distance is kept, too";
    EXPECT_EQ(eye.verticalFovRad, camera.verticalFovRad);
    EXPECT_EQ(eye.farM, camera.farM);
}

TEST_F(SaveGlb, KeepsWhichMeshesAreFlat) {
    Scene scene;
    for (const bool isFlat : {false, true}) {
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::mat4(1.0F)});
        scene.meshes.push_back(randomMesh(3));
        scene.meshes.back().normals.clear();
        scene.meshes.back().isFlat = isFlat;
    }
    saveGlb(folder.path() / "a.glb", scene);
    const Scene back = loadGltf(folder.path() / "a.glb");
    EXPECT_FALSE(back.meshes.at(0).isFlat);
    EXPECT_TRUE(back.meshes.at(1).isFlat);
    EXPECT_TRUE(back.warnings.empty());
}

TEST_F(SaveGlb, KeepsEveryMemberOfAMaterial) {
    Scene scene = sceneOf(randomMesh(5));
    scene.textures.emplace_back(1, 1, 3, std::uint8_t{7});
    scene.textures.emplace_back(1, 1, 3, std::uint8_t{9});
    scene.materials = {unusualMaterial(), Material{}};
    saveGlb(folder.path() / "a.glb", scene);
    const Scene back = loadGltf(folder.path() / "a.glb");
    ASSERT_EQ(back.materials.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const Material& a = back.materials[i];
        const Material& b = scene.materials[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.baseColor, b.baseColor);
        EXPECT_EQ(a.metallic, b.metallic);
        EXPECT_EQ(a.roughness, b.roughness);
        EXPECT_EQ(a.emissive, b.emissive);
        EXPECT_EQ(a.baseColorTexture, b.baseColorTexture);
        EXPECT_EQ(a.metallicRoughnessTexture, b.metallicRoughnessTexture);
        EXPECT_EQ(a.normalTexture, b.normalTexture);
        EXPECT_EQ(a.normalScale, b.normalScale);
        EXPECT_EQ(a.emissiveTexture, b.emissiveTexture);
        EXPECT_EQ(a.alphaCutoff, b.alphaCutoff);
        EXPECT_EQ(a.isDoubleSided, b.isDoubleSided);
        EXPECT_EQ(a.isUnlit, b.isUnlit);
        EXPECT_EQ(a.transmission, b.transmission);
        EXPECT_EQ(a.indexOfRefraction, b.indexOfRefraction);
    }
}

/// Numbers that use all their bits, as far away as floats allow or relative to an offset.
Scene litAndMoving(const glm::dvec3& offset) {
    Scene scene = sceneOf(randomMesh(7));
    scene.instances.push_back({0, glm::translate(glm::mat4(1.0F), glm::vec3(0.1F, 2, 3))});
    scene.offset = offset;
    scene.lights = {{{0.1F, 2, 3}, {0.3F, 0.7F, 1.9F}, 4.3F}, {{1, 0, 0}, glm::vec3(0.0F), 1.1F}};
    const Camera key{.position = {0.1F, 0.2F, 0.3F},
                     .up = {0.6F, 0.8F, 0},
                     .verticalFovRad = 0.9F,
                     .nearM = 0.3F};
    scene.paths = {{"path_1", {key, Camera{}}}, {"path_2", {Camera{}}}};
    scene.motions = {{1, {0.1F, 2, 3}, {0.6F, 0, 0.8F}, 0.7F, {0, 0.3F, 0}, 2.5F}};
    return scene;
}

TEST_F(SaveGlb, KeepsLightsPathsAndMotions) {
    const Scene scene = litAndMoving(glm::dvec3(0.0));
    EXPECT_EQ(saveGlb(folder.path() / "a.glb", scene), Lines{});
    const Scene back = loadGltf(folder.path() / "a.glb");
    EXPECT_EQ(back.warnings, Lines{});
    ASSERT_EQ(back.lights.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(back.lights[i].position, scene.lights[i].position);
        EXPECT_EQ(back.lights[i].intensity, scene.lights[i].intensity);
        EXPECT_EQ(back.lights[i].radiusM, scene.lights[i].radiusM);
    }
    ASSERT_EQ(back.paths.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(back.paths[i].name, scene.paths[i].name);
        ASSERT_EQ(back.paths[i].keys.size(), scene.paths[i].keys.size());
        const Camera &a = back.paths[i].keys[0], &b = scene.paths[i].keys[0];
        EXPECT_EQ(a.position, b.position);
        EXPECT_EQ(a.target, b.target);
        EXPECT_EQ(a.up, b.up);
        EXPECT_EQ(a.verticalFovRad, b.verticalFovRad);
        EXPECT_EQ(a.nearM, b.nearM);
        EXPECT_EQ(a.farM, b.farM);
    }
    ASSERT_EQ(back.motions.size(), 1U);
    const Motion &a = back.motions[0], &b = scene.motions[0];
    EXPECT_EQ(a.instance, b.instance);
    EXPECT_EQ(a.pivot, b.pivot);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.turnRad, b.turnRad);
    EXPECT_EQ(a.swing, b.swing);
    EXPECT_EQ(a.swingCount, b.swingCount);
}

TEST_F(SaveGlb, KeepsLightsPathsAndMotionsFarAway) {
    const Scene scene = litAndMoving({5e6, 0, 0});
    saveGlb(folder.path() / "a.glb", scene);
    const Scene back = loadGltf(folder.path() / "a.glb");
    const auto expectNear = [&](const glm::vec3& a, const glm::vec3& b) {
        const glm::dvec3 apart = glm::dvec3(a) + back.offset - glm::dvec3(b) - scene.offset;
        EXPECT_LT(glm::length(apart), 1e-5);
    };
    EXPECT_NE(back.offset, glm::dvec3(0.0));
    expectNear(back.lights.at(0).position, scene.lights[0].position);
    expectNear(back.paths.at(0).keys[0].target, scene.paths[0].keys[0].target);
    expectNear(back.motions.at(0).pivot, scene.motions[0].pivot);
    EXPECT_EQ(back.motions[0].swing, scene.motions[0].swing);
}

TEST(Save, SaysWhatIsLeftOut) {
    const TemporaryFolder folder;
    Scene scene = litAndMoving(glm::dvec3(0.0));
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].normals.clear();
    scene.meshes[1].isFlat = true;
    scene.instances.push_back({1, glm::mat4(1.0F)});
    scene.cameras = {Camera{}};
    scene.materials = {Material{}, Material{}};
    scene.textures.emplace_back(1, 1, 3, std::uint8_t{7});
    scene.points.positions = {glm::vec3(1.0F)};
    scene.points.radii = {0.1F};
    scene.heights = HeightMap{};
    EXPECT_EQ(saveGlb(folder.path() / "a.glb", scene),
              (Lines{"left out: a height map", "left out: the radius of a point"}));
    EXPECT_EQ(
        savePly(folder.path() / "a.ply", scene),
        (Lines{"left out: a camera", "left out: a camera path (2 times)", "left out: a height map",
               "left out: a light (2 times)", "left out: a material (2 times)",
               "left out: a motion", "left out: a point beside triangles", "left out: a texture",
               "left out: that the triangles of a mesh are flat",
               "left out: the normals of a mesh, as others have none"}));
}

TEST_F(SaveGlb, KeepsPoints) {
    Scene scene;
    const Mesh mesh = randomMesh(6);
    scene.points = {mesh.positions, mesh.normals, {}, mesh.colors};
    scene.points.surface = mesh;
    const Lines surface{"left out: the surface that points were taken of"};
    EXPECT_EQ(saveGlb(folder.path() / "a.glb", scene), surface);
    EXPECT_EQ(savePly(folder.path() / "a.ply", scene), surface);
    const PointCloud points = loadGltf(folder.path() / "a.glb").points;
    EXPECT_EQ(points.positions, scene.points.positions);
    EXPECT_EQ(points.normals, scene.points.normals);
    EXPECT_EQ(points.colors, scene.points.colors);
}

}  // namespace
}  // namespace gfxrepro::scene
