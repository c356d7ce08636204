// Skins, morph targets, shared accessors: where a glTF file's vertices stand.
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "engine/scene/animation.h"
#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

/// The square, and behind it numbers of a test's own: accessor 4 on, of floats.
struct PoseGltf : FolderTest {
    /// An accessor of type `type` with these numbers; returns its number.
    int add(const std::string& type, std::size_t count, const std::vector<float>& numbers) {
        const std::size_t at = bytes_.size();
        bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * 4);
        document_["bufferViews"].insert(
            document_["bufferViews"].size() - 1,
            ",{\"buffer\":0,\"byteOffset\":" + std::to_string(at) +
                ",\"byteLength\":" + std::to_string(numbers.size() * 4) + "}");
        document_["accessors"].insert(document_["accessors"].size() - 1,
                                      ",{\"bufferView\":" + std::to_string(views_++) +
                                          ",\"componentType\":5126,\"count\":" +
                                          std::to_string(count) + ",\"type\":\"" + type + "\"}");
        return accessors_++;
    }
    fs::path write() {
        folder.write("square.bin", bytes_);
        document_["buffers"] =
            R"([{"uri":"square.bin","byteLength":)" + std::to_string(bytes_.size()) + "}]";
        return folder.write("a.gltf", text(document_));
    }
    Scene load() { return loadGltf(write()); }

    Document document_ = square();
    std::string bytes_ = squareBytes();
    int views_ = 3;
    int accessors_ = 4;
};

const std::vector<float> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

TEST_F(PoseGltf, JointsHoldASkinnedMeshWhereverItsNodeIs) {
    const int joints = add("VEC4", 4, std::vector<float>(16, 0.0F));
    const int weights = add("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    document_["meshes"] = R"([{"primitives":[{"indices":1,"attributes":{"POSITION":0,"NORMAL":0,)"
                          R"("JOINTS_0":)" +
                          std::to_string(joints) + R"(,"WEIGHTS_0":)" + std::to_string(weights) +
                          "}}]}]";
    document_["skins"] = R"([{"joints":[2]}])";
    // The joint is moved by its parent, and turned: x becomes y.
    document_["nodes"] = R"([{"mesh":0,"skin":0,"translation":[100,0,0]},
        {"translation":[0,5,0],"children":[2]},
        {"rotation":[0,0,0.70710678,0.70710678]}])";
    document_["scenes"] = R"([{"nodes":[0,1]}])";
    Scene scene = load();
    EXPECT_LT(glm::length(scene.bounds().min - glm::vec3(-1, 5, 0)), 1e-5F);
    EXPECT_LT(glm::length(scene.bounds().max - glm::vec3(0, 6, 0)), 1e-5F);
    EXPECT_LT(glm::length(scene.meshes.at(0).normals[1] - glm::vec3(0, 1, 0)), 1e-5F);
    EXPECT_TRUE(scene.warnings.empty());

    std::vector<float> bind = kIdentity;
    bind[12] = -1.0F;  // the mesh stood at x = 1 when it was bound
    document_["skins"] =
        R"([{"joints":[2],"inverseBindMatrices":)" + std::to_string(add("MAT4", 1, bind)) + "}]";
    EXPECT_LT(glm::length(load().bounds().min - glm::vec3(-1, 4, 0)), 1e-5F);
    bind[3] = 0.5F;
    const std::string bound = document_["skins"];
    document_["skins"] =
        R"([{"joints":[2],"inverseBindMatrices":)" + std::to_string(add("MAT4", 1, bind)) + "}]";
    EXPECT_EQ(errorText([&] { load(); }, folder.path()),
              "DIR/a.gltf: skin 0: joint 0: the last row of its matrix is 0.5, 0, 0, 1; 0, 0, 0, 1 "
              "is allowed");
    document_["skins"] = bound;

    // Joints say where it is: once.
    document_["nodes"].insert(document_["nodes"].find("\"mesh\":0,"),
                              R"("extensions":{"EXT_mesh_gpu_instancing":
                                 {"attributes":{"TRANSLATION":0}}},)");
    scene = load();
    EXPECT_EQ(scene.instances.size(), 1U);
    EXPECT_EQ(scene.warnings,
              std::vector<std::string>{
                  "left out: the instances of a skinned node (EXT_mesh_gpu_instancing)"});

    document_["scenes"] = R"([{"nodes":[0]}])";
    EXPECT_EQ(errorText([&] { load(); }, folder.path()),
              "DIR/a.gltf: skin 0: its joint, node 2, is not in the scene");
}

TEST_F(PoseGltf, JointsShareAVertexByTheirWeights) {
    const int joints = add("VEC4", 4, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 7});
    const int weights = add("VEC4", 4, {1, 0, 0, 0, 0, 1, 0, 0, .5, .5, 0, 0, 2, 6, 0, 0});
    document_["meshes"] = R"([{"primitives":[{"indices":1,"attributes":{"POSITION":0,"JOINTS_0":)" +
                          std::to_string(joints) + R"(,"WEIGHTS_0":)" + std::to_string(weights) +
                          "}}]}]";
    document_["skins"] = R"([{"joints":[1,2]}])";
    document_["nodes"] = R"([{"mesh":0,"skin":0},{},{"translation":[0,0,8]}])";
    document_["scenes"] = R"([{"nodes":[0,1,2]}])";
    const Mesh mesh = load().meshes.at(0);
    EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 8}, {1, 1, 4}, {0, 1, 6}}));

    document_["meshes"] = R"([{"primitives":[{"indices":1,"attributes":{"POSITION":0}}]}])";
    document_["skins"] = R"([{"joints":[2,1]}])";
    const Scene unheld = load();
    EXPECT_EQ(unheld.bounds().min, glm::vec3(0, 0, 8))
        << "the first joint holds what has no weights";
    EXPECT_EQ(
        unheld.warnings,
        std::vector<std::string>{
            "left out: weights that a skinned vertex lacks: the first joint holds it (4 times)"});
    document_["skins"] = R"([{"joints":[1,2]}])";

    const int bad = add("VEC4", 4, {0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    document_["meshes"] = R"([{"primitives":[{"indices":1,"attributes":{"POSITION":0,"JOINTS_0":)" +
                          std::to_string(bad) + R"(,"WEIGHTS_0":)" + std::to_string(weights) +
                          "}}]}]";
    EXPECT_EQ(errorText([&] { load(); }, folder.path()),
              "DIR/a.gltf: mesh 0 primitive 0: joint 2 is not one of the 2 of its skin");
}

TEST_F(PoseGltf, MorphTargetsHaveTheirDefaultWeights) {
    const int up = add("VEC3", 4, {0, 0, 3, 0, 0, 3, 0, 0, 3, 0, 0, 3});
    const int aside = add("VEC3", 4, {4, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0});
    const auto meshes = [&](const char* weights) {
        document_["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,)"
                              R"("targets":[{"POSITION":)" +
                              std::to_string(up) + R"(},{"POSITION":)" + std::to_string(aside) +
                              "}]}]" + weights + "}]";
    };
    meshes(R"(,"weights":[1,0.5])");
    EXPECT_EQ(load().bounds().min, glm::vec3(2, 0, 3));
    meshes(R"(,"weights":[1,0.5,0,7])");
    EXPECT_EQ(load().warnings,
              std::vector<std::string>{"left out: a weight of a morph target that is not there"});
    meshes(R"(,"weights":[1,0.5])");
    document_["nodes"] = R"([{"mesh":0,"weights":[0.5]},{"mesh":0},{"mesh":0,"weights":[0.5]}])";
    document_["scenes"] = R"([{"nodes":[0,1,2]}])";
    const Scene scene = load();
    ASSERT_EQ(scene.meshes.size(), 2U) << "one for each pose";
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
    EXPECT_EQ(scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)].bounds().min,
              glm::vec3(0, 0, 1.5F));
    EXPECT_EQ(scene.meshes[static_cast<std::size_t>(scene.instances[1].mesh)].bounds().min,
              glm::vec3(2, 0, 3));
    document_["nodes"] = R"([{"mesh":0}])";
    document_["scenes"] = R"([{"nodes":[0]}])";
    meshes("");
    EXPECT_EQ(load().bounds().max, glm::vec3(1, 1, 0)) << "0 where nothing is said";
}

TEST_F(PoseGltf, PrimitivesKeepTheVerticesThatTheyUse) {
    document_["accessors"].insert(
        document_["accessors"].size() - 1,
        R"(,{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"})");
    document_["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"indices":4},
        {"attributes":{"POSITION":0},"indices":4}]}])";
    const Scene scene = load();
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].normals.size(), 3U);
    EXPECT_FALSE(scene.meshes[0].isFlat);
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"left out: a vertex that no triangle uses"});
}

/// Each with its own copy, these vertices would be 1.2 GB.
TEST_F(PoseGltf, ManyPrimitivesShareALargeArray) {
    constexpr std::size_t kVertices = 100'000;
    std::vector<float> positions(3 * kVertices);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<float>(i % 97);
    const std::string attribute =
        R"({"attributes":{"POSITION":)" + std::to_string(add("VEC3", kVertices, positions)) + "}";
    std::string primitives;
    for (int i = 0; i < 1000; ++i) {
        document_["accessors"].insert(document_["accessors"].size() - 1,
                                      R"(,{"bufferView":1,"componentType":5123,"byteOffset":)" +
                                          std::to_string(i % 4 * 2) +
                                          R"(,"count":3,"type":"SCALAR"})");
        primitives +=
            (i > 0 ? "," : "") + attribute + ",\"indices\":" + std::to_string(accessors_++) + "}";
    }
    document_["meshes"] = "[{\"primitives\":[" + primitives + "]}]";
    const Scene scene = load();
    EXPECT_EQ(scene.triangleCount(), 1000U);
    EXPECT_LE(scene.vertexCount(), 3000U);
}

TEST_F(PoseGltf, HidesWhatSaysSo) {
    document_["nodes"] = R"([{"mesh":0},{"mesh":0,"translation":[5,0,0],"children":[2],
        "extensions":{"KHR_node_visibility":{"visible":false}}},{"mesh":0}])";
    document_["scenes"] = R"([{"nodes":[0,1]}])";
    const Scene scene = load();
    EXPECT_EQ(scene.instances.size(), 1U);
    EXPECT_EQ(scene.warnings, std::vector<std::string>{
                                  "left out: a node that KHR_node_visibility hides (2 times)"});
}

Camera keyAt(const glm::vec3& position, const glm::vec3& target, float fovRad = 1.0F) {
    return Camera{.position = position, .target = target, .verticalFovRad = fovRad};
}

CameraPath bentPath() {
    CameraPath path{"bent",
                    {keyAt({0, 0, 0}, {0, 0, -1}, 0.8F), keyAt({1, 2, 0}, {3, 0, -1}, 1.2F),
                     keyAt({4, 1, 5}, {0, 7, 2}, 0.9F), keyAt({2, 2, 2}, {9, 1, 1}, 1.0F)}};
    path.keys[1].up = {1, 0, 0};
    path.keys[1].nearM = 0.1F;
    path.keys[2].nearM = 0.3F;
    path.keys[1].farM = 10.0F;
    path.keys[2].farM = 20.0F;
    return path;
}

void expectNear(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 1e-5F) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "axis " << i;
}

TEST(CameraAt, PassesThroughItsKeysAtEqualSteps) {
    const CameraPath path = bentPath();
    for (std::size_t i = 0; i < path.keys.size(); ++i) {
        SCOPED_TRACE(i);
        const Camera camera = cameraAt(path, static_cast<double>(i) / 3.0);
        expectNear(camera.position, path.keys[i].position);
        expectNear(camera.target, path.keys[i].target);
        expectNear(camera.up, path.keys[i].up);
        EXPECT_NEAR(camera.verticalFovRad, path.keys[i].verticalFovRad, 1e-5F);
        EXPECT_NEAR(camera.nearM, path.keys[i].nearM, 1e-5F);
        EXPECT_EQ(camera.name, "bent");
    }
}

TEST(CameraAt, IsCatmullRomBetweenKeys) {
    // Halfway, the spline is (−p0 + 9 p1 + 9 p2 − p3) / 16.
    const CameraPath path = bentPath();
    const Camera camera = cameraAt(path, 0.5);
    const auto halfway = [](auto a, auto b, auto c, auto d) {
        return (-a + 9.0F * b + 9.0F * c - d) / 16.0F;
    };
    const auto& k = path.keys;
    expectNear(camera.position,
               halfway(k[0].position, k[1].position, k[2].position, k[3].position));
    expectNear(camera.target, halfway(k[0].target, k[1].target, k[2].target, k[3].target));
    EXPECT_NEAR(camera.verticalFovRad, (-0.8F + 9.0F * 1.2F + 9.0F * 0.9F - 1.0F) / 16.0F, 1e-5F);
    EXPECT_NEAR(glm::length(camera.up), 1.0F, 1e-6F);
    // The planes are linear.
    EXPECT_NEAR(camera.nearM, 0.2F, 1e-6F);
    EXPECT_NEAR(camera.farM, 15.0F, 1e-5F);
}

TEST(CameraAt, EqualStepsOnALineAreEvenAwayFromItsEnds) {
    CameraPath path;
    for (int i = 0; i < 5; ++i) {
        const auto x = static_cast<float>(i);
        path.keys.push_back(keyAt({x, 0, 0}, {x, 0, -1}));
    }
    for (double time = 0.25; time <= 0.75; time += 0.05) {
        EXPECT_NEAR(cameraAt(path, time).position.x, 4.0 * time, 1e-5);
    }
}

TEST(CameraAt, HasNoKinksAtItsKeys) {
    const CameraPath path = bentPath();
    constexpr double kStep = 1e-3;
    for (const double key : {1.0 / 3.0, 2.0 / 3.0}) {
        const glm::vec3 here = cameraAt(path, key).position;
        const glm::vec3 before = here - cameraAt(path, key - kStep).position;
        const glm::vec3 after = cameraAt(path, key + kStep).position - here;
        // The bend within a step; a kink would be of the size of the steps themselves.
        EXPECT_LT(glm::length(after - before), 0.1F * glm::length(before));
    }
}

TEST(CameraAt, TimesOutsideAreClamped) {
    const CameraPath path = bentPath();
    expectNear(cameraAt(path, -2.0).position, path.keys.front().position);
    expectNear(cameraAt(path, 1.5).position, path.keys.back().position);
}

TEST(CameraAt, OneKeyStandsStill) {
    const CameraPath path{"still", {keyAt({1, 2, 3}, {4, 5, 6}, 0.7F)}};
    for (const double time : {-1.0, 0.0, 0.4, 1.0, 3.0}) {
        const Camera camera = cameraAt(path, time);
        expectNear(camera.position, {1, 2, 3});
        expectNear(camera.target, {4, 5, 6});
        EXPECT_NEAR(camera.verticalFovRad, 0.7F, 1e-6F);
    }
}

TEST(CameraAt, APathWithoutKeysIsAnError) {
    EXPECT_EQ(errorText([] {
                  cameraAt(CameraPath{"empty", {}}, 0.5);
              }),
              "the camera path 'empty' has no keys");
}

/// Three instances, of which the second moves.
Scene movingScene(const Motion& motion) {
    Scene scene;
    scene.instances.resize(3);
    for (int i = 0; i < 3; ++i) {
        scene.instances[static_cast<std::size_t>(i)].worldFromMesh = glm::scale(
            glm::translate(glm::mat4(1.0F), glm::vec3(static_cast<float>(i), 0.0F, 0.0F)),
            glm::vec3(2.0F));
    }
    scene.motions = {motion};
    scene.motions[0].instance = 1;
    return scene;
}

glm::vec3 movedAt(const Scene& scene, double time, const glm::vec3& pointMesh) {
    return glm::vec3(posesAt(scene, time).at(1) * glm::vec4(pointMesh, 1.0F));
}

TEST(PosesAt, LeavesWhatDoesNotMove) {
    const Motion motion{.turnRad = 2.0F, .swing = {1, 0, 0}};
    const Scene scene = movingScene(motion);
    for (const double time : {0.0, 0.3, 1.0}) {
        const auto poses = posesAt(scene, time);
        ASSERT_EQ(poses.size(), 3U);
        EXPECT_EQ(poses[0], scene.instances[0].worldFromMesh);
        EXPECT_EQ(poses[2], scene.instances[2].worldFromMesh);
    }
}

TEST(PosesAt, TurnsAboutItsPivot) {
    const Motion motion{.pivot = {5, 3, 1}, .turnRad = glm::pi<float>()};
    const Scene scene = movingScene(motion);
    // The mesh's (2, 1.5, 0.5) lies on the pivot in the world: it stays.
    for (const double time : {0.0, 0.2, 0.5, 1.0}) {
        expectNear(movedAt(scene, time, {2, 1.5F, 0.5F}), {5, 3, 1});
    }
    // (7, 3, 1) goes a quarter about +y, to −z of the pivot, then opposite.
    expectNear(movedAt(scene, 0.0, {3, 1.5F, 0.5F}), {7, 3, 1});
    expectNear(movedAt(scene, 0.5, {3, 1.5F, 0.5F}), {5, 3, -1});
    expectNear(movedAt(scene, 1.0, {3, 1.5F, 0.5F}), {3, 3, 1});
}

TEST(PosesAt, SwingsAFullPeriodAsOftenAsItSays) {
    const Motion motion{.swing = {0, 0.5F, 1}, .swingCount = 2.0F};
    const Scene scene = movingScene(motion);
    const glm::vec3 rest(1, 0, 0);
    for (const double time : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        expectNear(movedAt(scene, time, glm::vec3(0)), rest);
    }
    expectNear(movedAt(scene, 0.125, glm::vec3(0)), rest + glm::vec3(0, 0.5F, 1));
    expectNear(movedAt(scene, 0.375, glm::vec3(0)), rest - glm::vec3(0, 0.5F, 1));
    expectNear(movedAt(scene, 0.625, glm::vec3(0)), rest + glm::vec3(0, 0.5F, 1));
}

TEST(PosesAt, TimesOutsideAreClamped) {
    const Motion motion{.turnRad = 1.0F};
    const Scene scene = movingScene(motion);
    EXPECT_EQ(posesAt(scene, -1.0), posesAt(scene, 0.0));
    EXPECT_EQ(posesAt(scene, 7.0), posesAt(scene, 1.0));
    EXPECT_NE(posesAt(scene, 0.0), posesAt(scene, 1.0));
}

}  // namespace
}  // namespace gfxrepro::scene
