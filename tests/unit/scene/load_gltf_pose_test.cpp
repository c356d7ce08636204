// Skins, morph targets, shared accessors: where a glTF file's vertices stand.

#include <string>

#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

/// The square, and behind it numbers of a test's own: accessor 4 on, of floats.
struct PoseGltf : testing::Test {
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
        folder_.write("square.bin", bytes_);
        document_["buffers"] =
            R"([{"uri":"square.bin","byteLength":)" + std::to_string(bytes_.size()) + "}]";
        return folder_.write("a.gltf", text(document_));
    }
    Scene load() { return loadGltf(write()); }

    Document document_ = square();
    std::string bytes_ = squareBytes();
    int views_ = 3;
    int accessors_ = 4;
    TemporaryFolder folder_;
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
    EXPECT_EQ(errorText([&] { load(); }, folder_.path()),
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
    EXPECT_EQ(errorText([&] { load(); }, folder_.path()),
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
    EXPECT_EQ(errorText([&] { load(); }, folder_.path()),
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

}  // namespace
}  // namespace gfxrepro::scene
