#include "engine/scene/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <tiffio.h>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "engine/scene/scene.h"
#include "scenes/terrain/terrain.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

std::string messageOf(const fs::path& path) {
    try {
        loadHeightMap(path, {});
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

std::string bigEndian(const std::vector<int>& values) {
    std::string bytes;
    for (const int value : values) {
        bytes += static_cast<char>((value >> 8) & 255);
        bytes += static_cast<char>(value & 255);
    }
    return bytes;
}

void writeTiff(const fs::path& path, const void* values, int bits, int format,
               const char* noData = nullptr, glm::ivec2 size = {3, 2}) {
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, size.x);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, size.y);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
    if (noData != nullptr) {
        static const TIFFFieldInfo kInfo[] = {
            {42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDAL_NODATA")}};
        TIFFMergeFieldInfo(tiff, kInfo, 1);
        TIFFSetField(tiff, 42113, noData);
    }
    for (int y = 0; y < size.y; ++y) {
        const auto* row = static_cast<const char*>(values) + y * size.x * bits / 8;
        TIFFWriteScanline(tiff, const_cast<char*>(row), static_cast<std::uint32_t>(y), 0);
    }
    TIFFClose(tiff);
}

TEST(HeightMap, ReadsPngOf16And8Bits) {
    const TemporaryFolder folder;
    image::Image16 deep(3, 2, 1);
    for (int i = 0; i < 6; ++i) deep.values()[i] = static_cast<std::uint16_t>(10000 * i);
    image::writePng(folder.path() / "deep.PNG", deep);
    const HeightMap map = loadHeightMap(folder.path() / "deep.PNG", {5.0F, 0.5F, {}});
    EXPECT_EQ(map.sizeSamples, glm::ivec2(3, 2));
    EXPECT_EQ(map.heightM(2, 1), 25000.0F);
    EXPECT_EQ(map.position(2, 1), glm::vec3(10, 25000, 5));
    EXPECT_EQ(map.bounds().max, glm::vec3(10, 25000, 5));
    EXPECT_FALSE(map.isEightBit);

    image::Image8 shallow(2, 2, 1);
    shallow.values()[1] = 255;
    image::writePng(folder.path() / "shallow.png", shallow);
    const HeightMap eight = loadHeightMap(folder.path() / "shallow.png", {});
    EXPECT_TRUE(eight.isEightBit);
    EXPECT_EQ(eight.heightM(1, 0), 255.0F);
}

TEST(HeightMap, ReadsTiffsAndTheirNoData) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.tif";
    const std::uint16_t u16[] = {1, 2, 65535, 4, 5, 6};
    writeTiff(path, u16, 16, SAMPLEFORMAT_UINT);
    EXPECT_EQ(loadHeightMap(path, {}).heightM(2, 0), 65535.0F);

    const std::int16_t i16[] = {-7, -7, -7, -7, -32768, -7};
    writeTiff(path, i16, 16, SAMPLEFORMAT_INT);
    const HeightMap filled = loadHeightMap(path, {});
    EXPECT_EQ(filled.filledCount, 1U);
    for (const float height : filled.heightsM) EXPECT_EQ(height, -7.0F);

    const float f32[] = {0.25F, NAN, -9999.0F, 0.25F, 0.25F, 0.25F};
    writeTiff(path, f32, 32, SAMPLEFORMAT_IEEEFP, "-9999");
    const HeightMap floats = loadHeightMap(path, {});
    EXPECT_EQ(floats.filledCount, 2U);
    for (const float height : floats.heightsM) EXPECT_EQ(height, 0.25F);

    const std::string whole = readFile(path);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        writeFileAtomic(path, whole.substr(0, size));
        EXPECT_THAT(messageOf(path), HasSubstr("a.tif: ")) << size;
    }
}

TEST(HeightMap, ReadsWiderSamplesOfTiffs) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.tif";
    const std::int32_t i32[] = {-5, 16777216, 8848860, -2147483647, 4, -32768};
    writeTiff(path, i32, 32, SAMPLEFORMAT_INT, "-2147483647");
    const HeightMap whole = loadHeightMap(path, {});
    EXPECT_EQ(whole.filledCount, 2U);
    EXPECT_EQ(whole.heightM(0, 0), -5.0F);
    EXPECT_EQ(whole.heightM(1, 0), 16777216.0F);
    EXPECT_EQ(whole.heightM(2, 0), 8848860.0F);
    EXPECT_EQ(whole.unitWarning, "");
    const std::uint32_t u32[] = {3000000000U, 1, 2, 3, 4294967295U, 5};
    writeTiff(path, u32, 32, SAMPLEFORMAT_UINT, "4294967295");
    EXPECT_EQ(loadHeightMap(path, {}).heightM(0, 0), 3e9F);
    EXPECT_EQ(loadHeightMap(path, {}).filledCount, 1U);
    const double lowest = -std::numeric_limits<double>::max();
    const double f64[] = {0.1, NAN, lowest, 1.0, 2.0, -1.5};
    writeTiff(path, f64, 64, SAMPLEFORMAT_IEEEFP, "-1.7976931348623157e+308");
    const HeightMap doubles = loadHeightMap(path, {});
    EXPECT_EQ(doubles.filledCount, 2U);
    EXPECT_EQ(doubles.heightM(0, 0), 0.1F);
    EXPECT_EQ(doubles.heightM(2, 1), -1.5F);
    EXPECT_EQ(doubles.unitWarning,
              "its heights, floats of 64 bits, are rounded to 32: to some 7 digits");
    const double whole64[] = {1.0, NAN, lowest, 16777216.0, 0.5, -1.5};
    writeTiff(path, whole64, 64, SAMPLEFORMAT_IEEEFP, "-1.7976931348623157e+308");
    EXPECT_EQ(loadHeightMap(path, {}).unitWarning, "") << "floats of 32 bits hold them";
    writeTiff(path, f64, 64, SAMPLEFORMAT_IEEEFP, "-1.7976931348623157e+308");
    const std::string allowed =
        "; allowed: what fits into a float, as whole numbers up to 16777216";
    writeTiff(path, f64, 64, SAMPLEFORMAT_IEEEFP);
    EXPECT_EQ(messageOf(path),
              path.string() + ": sample 2 of row 0 is -1.7976931348623157e+308" + allowed);
    const std::int32_t odd[] = {1, 2, 3, 4, -16777217, 6};
    writeTiff(path, odd, 32, SAMPLEFORMAT_INT);
    EXPECT_EQ(messageOf(path), path.string() + ": sample 1 of row 1 is -16777217" + allowed);
}

TEST(HeightMap, NoDataOfFewDigitsIsThatOfTheSamples) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.tif";
    const auto filled = [&](float sample, const char* noData) {
        const float values[] = {1.0F, 2.0F, sample, 3.0F, 4.0F, 5.0F};
        writeTiff(path, values, 32, SAMPLEFORMAT_IEEEFP, noData);
        return loadHeightMap(path, {}).filledCount;
    };
    const float lowest = -std::numeric_limits<float>::max();
    for (const char* text : {"-3.4028234663852886e+38", "-3.402823e+38", "-3.4e+38"}) {
        EXPECT_EQ(filled(lowest, text), 1U) << text;
    }
    EXPECT_EQ(filled(-99999.9F, "-99999.9"), 1U);
    EXPECT_EQ(filled(-9999.0F, "-9999.5"), 0U);
    EXPECT_EQ(filled(3.4e37F, "3.4e38"), 0U);
    EXPECT_EQ(filled(7.0F, "-inf"), 0U);
}

TEST(HeightMap, ReadsSrtmTiles) {
    const TemporaryFolder folder;
    std::vector<int> values(1201 * 1201, 300);
    values[1] = -5;
    values[1201 * 600 + 600] = -32768;
    writeFileAtomic(folder.path() / "N00E000.hgt", bigEndian(values));
    const HeightMap map = loadHeightMap(folder.path() / "N00E000.hgt", {});
    EXPECT_EQ(map.heightM(1, 0), -5.0F);
    EXPECT_EQ(map.heightM(600, 600), 300.0F);
    EXPECT_EQ(map.filledCount, 1U);

    const fs::path cut = folder.path() / "cut.hgt";
    writeFileAtomic(cut, "12345");
    EXPECT_EQ(messageOf(cut),
              cut.string() +
                  ": 5 bytes; an SRTM tile has 2884802 (1201 x 1201) or 25934402 (3601 x 3601)");
}

TEST(HeightMap, ReadsRawFilesBesideTheirSidecar) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.raw";
    writeFileAtomic(path, bigEndian({-1, 2, 3, 4, 77, 6}));
    EXPECT_EQ(messageOf(path),
              path.string() + ": a raw height map needs " + path.string() +
                  ".yaml with width (integer, 2 … 65537), height (integer, 2 … 65537), type (u16 | "
                  "i16 | f32), byte_order (little | big), no_data (number)");
    const fs::path sidecar = path.string() + ".yaml";
    writeFileAtomic(sidecar, "{width: 2, height: 3, type: i16, byte_order: big, no_data: 77}\n");
    const HeightMap map = loadHeightMap(path, {});
    EXPECT_EQ(map.heightM(0, 0), -1.0F);
    EXPECT_EQ(map.heightM(1, 2), 6.0F);
    EXPECT_EQ(map.filledCount, 1U);

    writeFileAtomic(sidecar, "{width: 2, height: 4, type: i16}\n");
    EXPECT_EQ(messageOf(path), path.string() + ": 12 bytes; 2 x 4 samples of i16 need 16");
    writeFileAtomic(sidecar, "{width: 1, height: 2, type: f32}\n");
    EXPECT_EQ(messageOf(path), sidecar.string() + ":1:9: width is 1; allowed: 2 … 65537");
    writeFileAtomic(sidecar, "{width: 2, height: 3, type: f64}\n");
    EXPECT_EQ(messageOf(path), sidecar.string() + ":1:29: type is f64; allowed: u16 | i16 | f32");
    writeFileAtomic(sidecar, "{width: 2, height: 3, typ: f32}\n");
    EXPECT_EQ(messageOf(path),
              sidecar.string() +
                  ":1:23: a raw height map's sidecar: unknown key 'typ'; did you mean 'type'?");
}

/// `value` in four bytes at `at`, the first the highest.
void setBigEndian(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[at + i] = static_cast<char>((value >> (24 - 8 * i)) & 255U);
    }
}

TEST(HeightMap, RefusesPngsCutShortAndOfHugeHeaders) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.png";
    image::Image16 noise(17, 9, 1);
    for (std::size_t i = 0; i < noise.values().size(); ++i) {
        noise.values()[i] = static_cast<std::uint16_t>(i * i * 977U);
    }
    image::writePng(path, noise);
    const std::string whole = readFile(path);
    for (std::size_t size = 0; size + 13 < whole.size(); size += 5) {  // less the closing chunk
        writeFileAtomic(path, whole.substr(0, size));
        EXPECT_THAT(messageOf(path), HasSubstr("a.png: ")) << size;
    }
    // Width and height behind a signature of 8, a length of 4 and "IHDR"; then their checksum.
    const auto messageWithSide = [&](std::uint32_t side) {
        std::string huge = whole;
        setBigEndian(huge, 16, side);
        setBigEndian(huge, 20, side);
        std::uint32_t crc = 0xFFFFFFFFU;
        for (std::size_t i = 12; i < 29; ++i) {
            crc ^= static_cast<unsigned char>(huge[i]);
            for (int bit = 0; bit < 8; ++bit) {
                crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
            }
        }
        setBigEndian(huge, 29, ~crc);
        writeFileAtomic(path, huge);
        return messageOf(path);
    };
    EXPECT_EQ(messageWithSide(0x7FFFFFFF), path.string() + ": Invalid IHDR data");
    EXPECT_EQ(messageWithSide(65538),
              path.string() +
                  ": the header declares 65538 x 65538 pixels; 1 to 65537 a side are allowed");
    EXPECT_EQ(messageWithSide(65537),
              path.string() +
                  ": the header declares 65537 x 65537 pixels of 8 bytes, too many for a file of " +
                  std::to_string(whole.size()) + " bytes");
}

TEST(HeightMap, RefusesTiffsOfHugeHeaders) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.tif";
    const std::uint16_t values[] = {1, 2, 3, 4, 5, 6};
    writeTiff(path, values, 16, SAMPLEFORMAT_UINT);
    std::string bytes = readFile(path);
    // Entries of the directory: tag, type (4: 32 bits), count, value; little endian.
    for (const char* entry :
         {"\x00\x01\x03\x00\x01\x00\x00\x00", "\x01\x01\x03\x00\x01\x00\x00\x00"}) {
        const std::size_t at = bytes.find(std::string(entry, 8));
        ASSERT_NE(at, std::string::npos);
        bytes.replace(at + 2, 1, "\x04");
        bytes.replace(at + 8, 4, std::string("\x00\x00\x00\x40", 4));  // 2^30
    }
    writeFileAtomic(path, bytes);
    EXPECT_EQ(messageOf(path), path.string() + ": Incorrect count for \"StripOffsets\"");
}

TEST(HeightMap, RefusesFilesOfOneSampleASide) {
    const TemporaryFolder folder;
    const fs::path png = folder.path() / "a.png", tiff = folder.path() / "a.tif";
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {1, 7}, {7, 1}}) {
        const auto values = std::vector<std::uint16_t>(static_cast<std::size_t>(size.x * size.y));
        const std::string expected = fmt::format(
            ": a height map of {} x {} samples; allowed: 2 to 65537 a side", size.x, size.y);
        image::writePng(png, image::Image16(size.x, size.y, 1));
        EXPECT_EQ(messageOf(png), png.string() + expected);
        writeTiff(tiff, values.data(), 16, SAMPLEFORMAT_UINT, nullptr, size);
        EXPECT_EQ(messageOf(tiff), tiff.string() + expected);
    }
    const fs::path srtm = folder.path() / "a.hgt";
    writeFileAtomic(srtm, "12");
    EXPECT_EQ(messageOf(srtm),
              srtm.string() +
                  ": 2 bytes; an SRTM tile has 2884802 (1201 x 1201) or 25934402 (3601 x 3601)");
}

TEST(HeightMap, NonSquareFilesAreServed) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.png";
    for (const glm::ivec2 size : {glm::ivec2(2, 2), {2, 7}, {9, 2}}) {
        image::Image16 image(size.x, size.y, 1);
        for (std::size_t i = 0; i < image.values().size(); ++i) {
            image.values()[i] = static_cast<std::uint16_t>(300 + i);
        }
        image::writePng(path, image);
        const HeightMap map = loadHeightMap(path, {});
        EXPECT_EQ(map.sizeSamples, size);
        EXPECT_EQ(map.heightsM.back(), static_cast<float>(299 + size.x * size.y));
    }
}

TEST(HeightMap, RefusesOtherFiles) {
    const TemporaryFolder folder;
    EXPECT_EQ(messageOf("a.asc"),
              "a.asc: unknown kind of height map; allowed: .png .tif .tiff .hgt .raw .r16 .bin");
    const fs::path path = folder.path() / "rgb.png";
    image::writePng(path, image::Image8(2, 2, 3));
    EXPECT_EQ(messageOf(path),
              path.string() + ": 3 channels; a height map is grey, with or without alpha");
}

TEST(HeightMap, HolesAreFilledFromAround) {
    HeightMap map{.sizeSamples = {40, 23}};
    map.heightsM.assign(40 * 23, std::numeric_limits<float>::quiet_NaN());
    EXPECT_THROW(fillHoles(map), Error);
    map.heightsM[0] = 10.0F;
    map.heightsM[40 * 23 - 1] = 20.0F;
    fillHoles(map);
    EXPECT_EQ(map.filledCount, 40U * 23U - 2U);
    EXPECT_EQ(map.heightsM[0], 10.0F);
    for (const float height : map.heightsM) {
        EXPECT_GE(height, 10.0F);
        EXPECT_LE(height, 20.0F);
    }
    EXPECT_LT(map.heightM(2, 2), map.heightM(37, 20));
}

TEST(HeightMap, SamplesMayStandFurtherApartOneWay) {
    for (const glm::vec2 spacingM : {glm::vec2(10, 20), glm::vec2(20, 10)}) {
        Scene scene;
        HeightMap& map = scene.heights.emplace();
        map.sizeSamples = {5, 9};
        map.spacingM = spacingM;
        for (int i = 0; i < 45;
             ++i) {  // rises by a half to the east, falls by a quarter southwards
            const glm::vec2 at = glm::vec2(i % 5, i / 5) * spacingM;
            map.heightsM.push_back(0.5F * at.x - 0.25F * at.y);
        }
        const glm::vec3 end = glm::vec3(4, 0, 8) * glm::vec3(spacingM.x, 0, spacingM.y);
        EXPECT_EQ(map.bounds().min, glm::vec3(0, -0.25F * end.z, 0));
        EXPECT_EQ(map.bounds().max, glm::vec3(end.x, 0.5F * end.x, end.z));
        const Mesh mesh = heightMapMesh(map);
        EXPECT_EQ(mesh.positions.back(), glm::vec3(end.x, 0.5F * end.x - 0.25F * end.z, end.z));
        const glm::vec3 normal = glm::normalize(glm::vec3(-0.5F, 1.0F, 0.25F));
        for (const glm::vec3& found : mesh.normals) EXPECT_LT(glm::distance(found, normal), 1e-5F);
        EXPECT_EQ(resampled(map, 17, 0.0F, 1).spacingM, 0.5F * spacingM);
        addTerrainCameras(scene);
        const glm::vec3 flight = scene.cameras.at(1).position;
        EXPECT_EQ(glm::vec2(flight.x, flight.z), glm::vec2(2, 6) * spacingM);
    }
    EXPECT_EQ(metresText({10.0F, 20.0F}), "10 x 20 m");
    EXPECT_EQ(metresText({0.1F, 0.1F}), "0.1 m");
}

TEST(HeightMap, ResamplingKeepsTheSamplesAndBoundsTheDetail) {
    const FractalTerrain shape{.sizeSamples = 33, .spacingM = 160.0F};
    const HeightMap coarse = fractalTerrain(shape, 5);
    const HeightMap smooth = resampled(coarse, 257, 0.0F, 1);
    const HeightMap rough = resampled(coarse, 257, 30.0F, 1);
    EXPECT_EQ(rough.spacingM, glm::vec2(20.0F));
    float greatest = 0.0F;
    for (const auto [row, column] : test::grid(257, 257)) {
        greatest =
            std::max(greatest, std::abs(rough.heightM(column, row) - smooth.heightM(column, row)));
        if (row % 8 == 0 && column % 8 == 0) {
            EXPECT_EQ(rough.heightM(column, row), coarse.heightM(column / 8, row / 8));
        }
    }
    EXPECT_GT(greatest, 1.0F);
    EXPECT_LE(greatest, 30.0F);
    EXPECT_THROW(resampled(coarse, 32, 0.0F, 1), Error);
}

TEST(HeightMap, MeshFacesUpAndHoldsTheCorners) {
    const FractalTerrain shape{.sizeSamples = 100};
    const HeightMap map = fractalTerrain(shape, 5);
    const Mesh mesh = heightMapMesh(map, 10);
    EXPECT_LE(mesh.positions.size(), 100U);
    EXPECT_EQ(mesh.positions.back(), map.position(99, 99));
    for (const glm::uvec3& t : mesh.triangles) {
        EXPECT_GT(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                             mesh.positions[t.z] - mesh.positions[t.x])
                      .y,
                  0.0F);
    }
    EXPECT_EQ(heightMapMesh(map, 513).triangles.size(), 2U * 99U * 99U);
}

}  // namespace
}  // namespace gfxrepro::scene
