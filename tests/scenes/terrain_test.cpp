#include "scenes/terrain/terrain.h"

#include "engine/core/files.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

TEST(FractalTerrain, IsTheSameForASeedAndHasItsRelief) {
    FractalTerrain shape;
    shape.sizeSamples = 129;
    const HeightMap a = fractalTerrain(shape, 1);
    EXPECT_EQ(a.heightsM, fractalTerrain(shape, 1).heightsM);
    EXPECT_NE(a.heightsM, fractalTerrain(shape, 2).heightsM);
    EXPECT_EQ(a.bounds().min.y, 0.0F);
    EXPECT_NEAR(a.bounds().max.y, shape.reliefM, 0.01F);
    shape.sizeSamples = 1;
    EXPECT_EQ(fractalTerrain(shape, 1).heightsM, std::vector<float>{0.0F});
}

TEST(FractalTerrain, IsTheSameInAFile) {
    const TemporaryFolder folder;
    FractalTerrain shape;
    shape.sizeSamples = 129;
    const HeightMap expected = fractalTerrain(shape, 5);
    for (int i = 0; i < 2; ++i) {  // made, then found
        const HeightMap found = fractalTerrainInFile(shape, 5, folder.path(), "key");
        ASSERT_NE(found.file, nullptr);
        EXPECT_EQ(found.spacingM, expected.spacingM);
        for (int at = 0; at < 129 * 129; ++at) {
            ASSERT_EQ(found.heightM(at % 129, at / 129), expected.heightM(at % 129, at / 129));
        }
    }
    writeFileAtomic(folder.path() / "file", "no folder");
    testing::internal::CaptureStderr();
    const HeightMap kept = fractalTerrainInFile(shape, 5, folder.path() / "file", "key");
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "warning: a generated terrain is held in memory, all of it: cannot create " +
                  (folder.path() / "file").string() + ": Not a directory\n");
    EXPECT_EQ(kept.heightsM, expected.heightsM);
}

}  // namespace
}  // namespace gfxrepro::scene
