#include "runner/run/scene_cache.h"

#include <gtest/gtest.h>

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
    const test::TemporaryFolder folder;
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

}  // namespace
}  // namespace gfxrepro::run
