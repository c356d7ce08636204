#include "runner/run/scene_cache.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "tests/support/support.h"

namespace gfxrepro::run {
namespace {

constexpr std::size_t kHeights = 1000;

/// A map in memory, and nothing else.
scene::Scene terrain(Params&, std::uint64_t) {
    scene::Scene scene;
    scene.heights.emplace().heightsM.resize(kHeights);
    return scene;
}

TEST(SceneCache, CountsHeightsInMemory) {
    constexpr scene::GeneratorInfo kGenerators[] = {{"terrain", "", terrain}};
    const TemporaryFolder folder;
    folder.write("m/x.yaml", "scene: m/x\ndoc: an x\nsources: [{generator: terrain, seed: 1}]\n");
    const scene::Catalog catalog(folder.path(), folder.path(), kGenerators);
    constexpr std::size_t kMapBytes = kHeights * sizeof(float);
    SceneCache scenes(catalog, 2 * kMapBytes);
    for (const char* name : {"m/x@1", "m/x@2", "m/x@3"}) {
        EXPECT_EQ(scenes.get(name).sizeBytes, kMapBytes);
        scenes.beginCase("");
    }
    EXPECT_EQ(scenes.otherBytes(), 2 * kMapBytes);
    EXPECT_EQ(scenes.entries().size(), 2U) << "a third does not fit";
}

int timesMade = 0;

/// Something of everything, as much as is kept.
scene::Scene furnished(Params& params, std::uint64_t seed) {
    const auto count = params.getInt("count", 100000, {"points", "points", 1, 1000000});
    params.finish();
    ++timesMade;
    const scene::Mesh mesh{.name = "a",
                           .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                           .triangles = {{0, 1, 2}},
                           .material = 0};
    scene::Scene scene = scene::sceneOf(mesh);
    scene.materials.push_back({.name = "m", .roughness = 0.25F, .indexOfRefraction = 1.25F});
    scene.textures.emplace_back(2, 3, 4, std::uint8_t{7});
    scene.points.positions.assign(static_cast<std::size_t>(count),
                                  glm::vec3(static_cast<float>(seed)));
    scene.points.radii = {0.5F, 1.5F};
    scene.points.surface.positions = {glm::vec3(3)};
    scene.points.whole.add(glm::vec3(4));
    scene.cameras.push_back({.name = "c", .farM = 9.0F});
    scene.paths.push_back({"p", scene.cameras});
    scene.lights.push_back({.radiusM = 3.0F});
    scene.motions.push_back({.turnRad = 2.0F});
    scene.warnings = {"w"};
    return scene;
}

struct KeptScenes : FolderTest {
    KeptScenes() {
        folder.write("s/m/x.yaml",
                     "scene: m/x\ndoc: an x\nsources: [{generator: furnished, seed: 5}]\n");
        setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
        timesMade = 0;
    }
    ~KeptScenes() override { unsetenv("XDG_CACHE_HOME"); }

    /// As a process of its own gets it.
    scene::Scene got(const std::string& reference) {
        const scene::Catalog catalog(folder.path() / "s", folder.path(), kGenerators);
        return SceneCache(catalog, 0, kMostBytes).get(reference).scene;
    }
    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        const auto kept = folder.path() / "gfxrepro" / "scenes";
        if (!fs::exists(kept)) return all;
        for (const auto& file : fs::directory_iterator(kept)) all.push_back(file);
        return all;
    }

    static constexpr std::uintmax_t kMostBytes = 3'000'000;  // two of 1.2 MB
    static constexpr scene::GeneratorInfo kGenerators[] = {{"furnished", "", furnished}};
};

TEST_F(KeptScenes, AreWhatWasMade) {
    const scene::Scene made = got("m/x");
    const scene::Scene kept = got("m/x");
    EXPECT_EQ(timesMade, 1);
    ASSERT_EQ(files().size(), 1U);
    EXPECT_EQ(kept.name, "m/x");
    EXPECT_EQ(kept.origin.kind, made.origin.kind);
    EXPECT_EQ(kept.origin.description, "generator furnished, seed 5");
    ASSERT_EQ(kept.meshes.size(), 1U);
    EXPECT_EQ(kept.meshes[0].name, "a");
    EXPECT_EQ(kept.meshes[0].positions, made.meshes[0].positions);
    EXPECT_EQ(kept.meshes[0].triangles, made.meshes[0].triangles);
    EXPECT_EQ(kept.meshes[0].material, 0);
    EXPECT_EQ(kept.instances.size(), made.instances.size());
    EXPECT_EQ(kept.instances[0].worldFromMesh, glm::mat4(1.0F));
    EXPECT_EQ(kept.materials[0].name, "m");
    EXPECT_EQ(kept.materials[0].roughness, 0.25F);
    EXPECT_EQ(kept.materials[0].indexOfRefraction, 1.25F);
    EXPECT_EQ(kept.textures, made.textures);
    EXPECT_EQ(kept.points.positions, made.points.positions);
    EXPECT_EQ(kept.points.radii, made.points.radii);
    EXPECT_EQ(kept.points.surface.positions, made.points.surface.positions);
    EXPECT_EQ(kept.points.whole.max, made.points.whole.max);
    EXPECT_EQ(kept.cameras[0].farM, 9.0F);
    EXPECT_EQ(kept.paths[0].name, "p");
    EXPECT_EQ(kept.paths[0].keys[0].name, "c");
    EXPECT_EQ(kept.lights[0].radiusM, 3.0F);
    EXPECT_EQ(kept.motions[0].turnRad, 2.0F);
    EXPECT_EQ(kept.warnings, std::vector<std::string>{"w"});
}

TEST_F(KeptScenes, AreOfTheirSeedAndParameters) {
    got("m/x");
    EXPECT_EQ(got("m/x@6").points.positions.front(), glm::vec3(6));
    EXPECT_EQ(got("m/x?count=90000").points.positions.size(), 90000U);
    EXPECT_EQ(timesMade, 3);
}

TEST_F(KeptScenes, TakeNoMoreRoomThanTheyMay) {
    for (const char* name : {"m/x@1", "m/x@2", "m/x@3"}) got(name);
    EXPECT_EQ(files().size(), 2U);
    got("m/x@3");
    EXPECT_EQ(timesMade, 3);
}

TEST_F(KeptScenes, AreOfFilesThatAreRefined) {
    folder.write("y.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    folder.write("s/m/y.yaml",
                 "scene: m/y\ndoc: a y\nsources: [{file: y.off, refine_to: 65000}]\n");
    const scene::Scene refined = got("m/y");
    EXPECT_EQ(files().size(), 1U);
    const scene::Scene kept = got("m/y");
    EXPECT_EQ(kept.meshes[0].positions, refined.meshes[0].positions);
    EXPECT_EQ(kept.meshes[0].triangles, refined.meshes[0].triangles);
    EXPECT_EQ(kept.origin.description, refined.origin.description);
    EXPECT_EQ(kept.origin.sha256, refined.origin.sha256);
}

TEST_F(KeptScenes, SmallOnesAreNot) {
    got("m/x?count=10");
    EXPECT_TRUE(files().empty());
}

TEST_F(KeptScenes, ATornFileIsMadeAnew) {
    got("m/x");
    const std::string whole = readFile(files().front());
    std::string changed = whole;
    changed[changed.size() / 2] ^= 1;
    for (const std::string& torn : {std::string(), whole.substr(0, 70), changed, whole + '\0'}) {
        writeFileAtomic(files().front(), torn);
        EXPECT_EQ(got("m/x").points.positions.size(), 100000U);
        EXPECT_EQ(readFile(files().front()), whole);
    }
    EXPECT_EQ(timesMade, 5);
}

TEST_F(KeptScenes, WhereNothingCanBeWrittenNothingIsKept) {
    folder.write("gfxrepro", "a file where the folder would be");
    EXPECT_EQ(got("m/x").points.positions.size(), 100000U);
    EXPECT_EQ(got("m/x").points.positions.size(), 100000U);
    EXPECT_EQ(timesMade, 2);
}

}  // namespace
}  // namespace gfxrepro::run
