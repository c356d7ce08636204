// Heights in a file: the same as in memory, made once, remade where damaged, never too many.
#include "engine/scene/height_file.h"

#include <atomic>
#include <chrono>
#include <cmath>

#include "engine/core/error.h"
#include "engine/scene/height_map.h"
#include "scenes/terrain/terrain.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

float heightAt(int column, int row) {
    return std::sin(0.1F * static_cast<float>(column)) * static_cast<float>(row % 50);
}

/// 200 × 130 samples; `rows` counts those that were made.
std::shared_ptr<const HeightFile> opened(const fs::path& folder, const std::string& key,
                                         std::atomic<int>& rows,
                                         std::uintmax_t mostBytes = HeightFile::kMostBytes) {
    return HeightFile::openOrBuild(
        folder, key, {200, 130},
        HeightFile::inParallel(200,
                               [&](int row, float* heightsM) {
                                   ++rows;
                                   for (int i = 0; i < 200; ++i) heightsM[i] = heightAt(i, row);
                               }),
        [] { return std::size_t{7}; }, mostBytes);
}

TEST(HeightFile, HasEverySampleAtEveryLevel) {
    const TemporaryFolder folder;
    std::atomic<int> rows = 0;
    const auto file = opened(folder.path(), "a", rows);
    EXPECT_EQ(rows, 130);
    EXPECT_EQ(file->filledCount(), 7U);
    ASSERT_EQ(file->levelCount(), 3);
    EXPECT_EQ(file->sizeSamples(2), glm::ivec2(50, 33));
    HeightMap map, inMemory;
    map.sizeSamples = inMemory.sizeSamples = {200, 130};
    map.file = file;
    for (int i = 0; i < 200 * 130; ++i) inMemory.heightsM.push_back(heightAt(i % 200, i / 200));
    for (int level = 0; level < 5; ++level) {
        const int step = 1 << level;
        for (int row = -step; row < 130 + 2 * step; row += step) {
            for (int column = -step; column < 200 + 2 * step; column += step) {
                ASSERT_EQ(map.clampedHeightM(column, row, level),
                          inMemory.clampedHeightM(column, row));
                ASSERT_EQ(map.clampedHeightM(column, row), inMemory.clampedHeightM(column, row));
            }
        }
        map.release();  // what is looked at again comes back
    }
    const HeightMap::Extremes ends = map.extremes(), expected = inMemory.extremes();
    EXPECT_EQ(ends.lowestM, expected.lowestM);
    EXPECT_EQ(ends.highestM, expected.highestM);
    EXPECT_EQ(ends.highestSample, expected.highestSample);
    EXPECT_FALSE(map.isEmpty());
}

TEST(HeightFile, IsMadeOnceAndAgainWhereItIsDamaged) {
    const TemporaryFolder folder;
    std::atomic<int> rows = 0;
    opened(folder.path(), "a", rows);
    opened(folder.path(), "a", rows);
    EXPECT_EQ(rows, 130);
    const fs::path path = folder.path() / "a.heights";
    const std::string whole = readFile(path);
    std::string oldVersion = whole;
    oldVersion[8] = 0;
    int expected = 130;
    for (const std::string& content :
         {whole.substr(0, whole.size() - 4), std::string(), oldVersion}) {
        writeFileAtomic(path, content);
        opened(folder.path(), "a", rows);
        EXPECT_EQ(rows, expected += 130);
        EXPECT_EQ(readFile(path), whole);
    }
}

TEST(HeightFile, TheFileOpenedLongestAgoGoes) {
    const TemporaryFolder folder;
    std::atomic<int> rows = 0;
    const auto first = opened(folder.path(), "a", rows);
    const std::uintmax_t bytes = fs::file_size(folder.path() / "a.heights");
    opened(folder.path(), "b", rows);
    const auto hourAgo = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(folder.path() / "b.heights", hourAgo);
    writeFileAtomic(folder.path() / "x.heights.tmp1", "left behind");
    opened(folder.path(), "c", rows, 2 * bytes);
    EXPECT_TRUE(fs::exists(folder.path() / "a.heights"));
    EXPECT_FALSE(fs::exists(folder.path() / "b.heights"));
    EXPECT_TRUE(fs::exists(folder.path() / "c.heights"));
    EXPECT_FALSE(fs::exists(folder.path() / "x.heights.tmp1"));
    // One alone stays, however large; who has a file that went keeps it.
    opened(folder.path(), "d", rows, 1);
    EXPECT_FALSE(fs::exists(folder.path() / "a.heights"));
    EXPECT_TRUE(fs::exists(folder.path() / "d.heights"));
    EXPECT_EQ(first->heightsM(0)[205], heightAt(5, 1));
}

TEST(HeightFile, ResamplesAsInMemoryAndStaysThereWithoutAFolder) {
    const TemporaryFolder folder;
    FractalTerrain shape;
    shape.sizeSamples = 33;
    const HeightMap coarse = fractalTerrain(shape, 5);
    const HeightMap expected = resampled(coarse, 257, 30.0F, 3);
    const HeightMap found = resampledInFile(coarse, 257, 30.0F, 3, folder.path(), "key");
    ASSERT_NE(found.file, nullptr);
    EXPECT_EQ(found.file->key(), "key");
    EXPECT_EQ(found.sizeSamples, expected.sizeSamples);
    EXPECT_EQ(found.spacingM, expected.spacingM);
    for (int i = 0; i < 257 * 257; ++i) {
        ASSERT_EQ(found.heightM(i % 257, i / 257), expected.heightM(i % 257, i / 257));
    }
    writeFileAtomic(folder.path() / "file", "no folder");
    const HeightMap kept = resampledInFile(coarse, 257, 30.0F, 3, folder.path() / "file", "key");
    EXPECT_EQ(kept.file, nullptr);
    EXPECT_EQ(kept.heightsM, expected.heightsM);
    EXPECT_EQ(
        errorText([&] { resampledInFile(coarse, 32769, 0.0F, 3, folder.path() / "file", "key"); }),
        "a resampled height map: 32769 x 32769 samples have no file: cannot create " +
            (folder.path() / "file").string() +
            ": Not a directory; allowed without one, in memory: at most 16385 a side (1 GiB)");
}

}  // namespace
}  // namespace gfxrepro::scene
