// Heights in a file: the same as in memory, made once, remade where damaged, never too many.
#include "engine/scene/height_file.h"

#include <png.h>
#include <tiffio.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "engine/scene/height_map.h"
#include "engine/scene/height_rows.h"
#include "scenes/terrain/terrain.h"
#include "tests/support/cut_tiff.h"
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
    const FractalTerrain shape{.sizeSamples = 33};
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

// Maps from files into files: the heights of those in memory, holes filled by bands, bounds.

/// A hole in five, and a region of holes wider than a band.
std::vector<float> withHoles(glm::ivec2 size) {
    std::mt19937 random(7);
    std::vector<float> heights;
    for (int i = 0; i < size.x * size.y; ++i) {
        const glm::ivec2 at(i % size.x, i / size.x);
        const bool isHole = random() % 5 == 0 || (at.x > 20 && at.y > 40 && at.y < 260);
        heights.push_back(isHole ? NAN : static_cast<float>(random() % 1000U));
    }
    return heights;
}

/// All levels whole, one after the other.
std::vector<float> filledByAWholePyramid(std::vector<float> fine, glm::ivec2 size) {
    if (size == glm::ivec2(1)) return fine;
    const glm::ivec2 half = (size + 1) / 2;
    std::vector<float> coarse;
    for (int i = 0; i < half.x * half.y; ++i) {
        float sum = 0.0F;
        int count = 0;
        for (int j = 0; j < 4; ++j) {
            const glm::ivec2 at(2 * (i % half.x) + j % 2, 2 * (i / half.x) + j / 2);
            if (at.x >= size.x || at.y >= size.y) continue;
            const float value = fine[static_cast<std::size_t>(at.y * size.x + at.x)];
            if (!std::isfinite(value)) continue;
            sum += value;
            ++count;
        }
        coarse.push_back(count > 0 ? sum / static_cast<float>(count) : NAN);
    }
    coarse = filledByAWholePyramid(std::move(coarse), half);
    const auto at = [&](int x, int y) {
        return coarse[static_cast<std::size_t>(std::clamp(y, 0, half.y - 1) * half.x +
                                               std::clamp(x, 0, half.x - 1))];
    };
    for (int i = 0; i < size.x * size.y; ++i) {
        float& value = fine[static_cast<std::size_t>(i)];
        if (std::isfinite(value)) continue;
        const int x = i % size.x / 2, y = i / size.x / 2;
        const int farX = i % size.x % 2 == 0 ? x - 1 : x + 1;
        const int farY = i / size.x % 2 == 0 ? y - 1 : y + 1;
        value = 0.5625F * at(x, y) + 0.1875F * at(farX, y) + 0.1875F * at(x, farY) +
                0.0625F * at(farX, farY);
    }
    return fine;
}

TEST(HoleFilling, BandsGetWhatTheWholePyramidGives) {
    for (const glm::ivec2 size :
         {glm::ivec2(90, 400), {64, 64}, {65, 129}, {1, 300}, {7, 1}, {130, 63}}) {
        std::vector<float> expected = withHoles(size);
        expected[0] = 5.0F;
        HeightMap map{.sizeSamples = size, .heightsM = expected};
        fillHoles(map);
        expected = filledByAWholePyramid(expected, size);
        EXPECT_EQ(map.heightsM, expected) << size.x << " x " << size.y;
    }
}

/// 70 × 150 values, of which some are `none`.
std::vector<std::int16_t> values() {
    std::vector<std::int16_t> result;
    for (int i = 0; i < 70 * 150; ++i) {
        result.push_back(static_cast<std::int16_t>(i % 11 == 3 ? -32768 : i % 977));
    }
    return result;
}

void writeTiledTiff(const fs::path& path, const std::vector<std::int16_t>& values, int tileSide) {
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 70);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 150);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_INT);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    if (tileSide == 0) {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 47);
        for (std::uint32_t y = 0; y < 150; ++y) {
            std::vector<std::int16_t> row(values.begin() + 70 * y, values.begin() + 70 * (y + 1));
            TIFFWriteScanline(tiff, row.data(), y, 0);
        }
    } else {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, tileSide);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, tileSide);
        for (int top = 0; top < 150; top += tileSide) {
            for (int left = 0; left < 70; left += tileSide) {
                std::vector<std::int16_t> tile;
                for (int i = 0; i < tileSide * tileSide; ++i) {
                    const int x = std::min(left + i % tileSide, 69);
                    const int y = std::min(top + i / tileSide, 149);
                    tile.push_back(values[static_cast<std::size_t>(70 * y + x)]);
                }
                TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                              static_cast<std::uint32_t>(top), 0, 0);
            }
        }
    }
    TIFFClose(tiff);
}

/// Grey with alpha; holes are transparent.
void writePng(const fs::path& path, const std::vector<std::int16_t>& values, int interlacing) {
    FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, 70, 150, 16, PNG_COLOR_TYPE_GRAY_ALPHA, interlacing,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    std::vector<std::uint8_t> bytes;
    for (const std::int16_t value : values) {
        const bool isHole = value < 0;
        bytes.push_back(static_cast<std::uint8_t>(isHole ? 9 : value >> 8));
        bytes.push_back(static_cast<std::uint8_t>(isHole ? 9 : value & 255));
        bytes.insert(bytes.end(), 2, isHole ? 0 : 255);
    }
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < 150; ++y) rows.push_back(&bytes[y * 70 * 4]);
    png_write_image(png, rows.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

using HeightRows = FolderTest;

TEST_F(HeightRows, MapsInFilesAreThoseInMemory) {
    const std::vector<std::int16_t> all = values();
    const auto at = [&](const char* name) { return folder.path() / name; };
    writeTiledTiff(at("strips.tif"), all, 0);
    writeTiledTiff(at("tiles.tif"), all, 32);
    writePng(at("rows.png"), all, PNG_INTERLACE_NONE);
    writePng(at("interlaced.png"), all, PNG_INTERLACE_ADAM7);
    folder.write("bare.raw",
                 std::string(reinterpret_cast<const char*>(all.data()), 2 * all.size()));
    folder.write("bare.raw.yaml", "{width: 70, height: 150, type: i16}");
    const HeightMapUnits units{3.0F, 0.5F, 20.0F};
    std::vector<float> first;
    for (const char* name : {"strips.tif", "tiles.tif", "rows.png", "interlaced.png", "bare.raw"}) {
        const HeightMap inMemory = loadHeightMapInFile(at(name), units, folder.path(), name);
        EXPECT_EQ(inMemory.file, nullptr) << "small";
        EXPECT_EQ(inMemory.filledCount, 955U + 10U) << name;
        if (first.empty()) first = inMemory.heightsM;
        EXPECT_EQ(inMemory.heightsM, first) << name;
        for (int i = 0; i < 2; ++i) {  // made, and found there
            const HeightMap map = loadHeightMapInFile(at(name), units, folder.path(), name, 100);
            ASSERT_NE(map.file, nullptr);
            EXPECT_EQ(map.sizeSamples, glm::ivec2(70, 150));
            EXPECT_EQ(map.spacingM, glm::vec2(3.0F));
            EXPECT_EQ(map.filledCount, inMemory.filledCount);
            const float* heights = map.file->heightsM(0);
            EXPECT_EQ(std::vector<float>(heights, heights + 70 * 150), first) << name;
        }
    }
    // One without holes is read once.
    folder.write("whole.raw", std::string(2 * 70 * 150, '\1'));
    folder.write("whole.raw.yaml", "{width: 70, height: 150, type: u16}");
    const HeightMap whole = loadHeightMapInFile(at("whole.raw"), {}, folder.path(), "whole", 100);
    EXPECT_EQ(whole.file->lowestM(), 257.0F);
    EXPECT_EQ(whole.filledCount, 0U);
}

TEST_F(HeightRows, BrokenFilesLeaveNothingBehind) {
    const fs::path cache = folder.path() / "cache";
    const auto message = [&](const char* name) {
        return errorText([&] { loadHeightMapInFile(folder.path() / name, {}, cache, "key", 100); },
                         folder.path());
    };
    writePng(folder.path() / "whole.png", values(), PNG_INTERLACE_NONE);
    const std::string png = readFile(folder.path() / "whole.png");
    folder.write("cut.png", png.substr(0, png.size() / 2));
    testing::internal::CaptureStderr();
    EXPECT_TRUE(message("cut.png").starts_with(
        "DIR/cut.png: the file ends early in chunk IDAT: bytes needed from byte "));
    folder.write("cut.tif", test::cutTiff());
    EXPECT_EQ(
        message("cut.tif"),
        "DIR/cut.tif: the file ends early in strip 0: bytes needed from byte 122 on: 4, found: 3");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // and is not tried in memory
    folder.write("none.raw", std::string(2 * 70 * 150, '\x80'));
    folder.write("none.raw.yaml", "{width: 70, height: 150, type: i16, no_data: -32640}");
    EXPECT_EQ(message("none.raw"), "DIR/none.raw: no sample has data; allowed: at least one");
    EXPECT_EQ(message("gone.png"), "cannot read DIR/gone.png: No such file or directory");
    EXPECT_EQ(message("gone.hgt"), "cannot read DIR/gone.hgt: No such file or directory");
    std::size_t files = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(cache)) {
        EXPECT_EQ(entry.path().filename(), "lock");
        ++files;
    }
    EXPECT_EQ(files, 1U);
}

TEST_F(HeightRows, RefusesWhatCannotBeReadInPieces) {
    folder.write("wide.raw", "");
    folder.write("wide.raw.yaml", "{width: 65538, height: 2, type: u16}");
    EXPECT_EQ(errorText([&] { openHeightRows(folder.path() / "wide.raw"); }, folder.path()),
              "DIR/wide.raw.yaml:1:9: width is 65538; allowed: 2 … 65537");
    folder.write("long.raw", std::string(4 * 20000, '\0'));
    folder.write("long.raw.yaml", "{width: 2, height: 20000, type: u16}");
    EXPECT_EQ(
        errorText([&] { loadHeightMap(folder.path() / "long.raw", {}); }, folder.path()),
        "DIR/long.raw: a height map of 2 x 20000 samples; allowed in memory: 2 to 16385 a side");
    folder.write("file", "no folder");
    EXPECT_EQ(errorText(
                  [&] {
                      loadHeightMapInFile(folder.path() / "long.raw", {}, folder.path() / "file",
                                          "key");
                  },
                  folder.path()),
              "DIR/long.raw: 2 x 20000 samples have no file: cannot create DIR/file: Not a "
              "directory; allowed without one, in memory: at most 16385 a side (1 GiB)");

    const fs::path tiled = folder.path() / "tiled.tif";
    TIFF* tiff = TIFFOpen(tiled.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 65537);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 3);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 2048);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 2048);
    std::vector<float> tile(2048 * 2048);
    TIFFWriteTile(tiff, tile.data(), 0, 0, 0, 0);
    TIFFClose(tiff);
    EXPECT_EQ(errorText([&] { openHeightRows(tiled); }, folder.path()),
              "DIR/tiled.tif: a row of tiles of 2048 x 2048 samples has 529 MiB; allowed: at most "
              "260, as it is read whole");
}

}  // namespace
}  // namespace gfxrepro::scene
