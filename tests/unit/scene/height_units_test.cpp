// What files say of their heights' units.
#include <fmt/format.h>
#include <png.h>
#include <tiffio.h>

#include <cstdio>
#include <vector>

#include "engine/core/files.h"
#include "engine/scene/height_map.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

/// 2 x 2 values 0, 10, 20, 30 with tags of GDAL and GeoTIFF.
fs::path writeGeoTiff(const fs::path& path, const char* metadata, std::vector<double> scale,
                      std::vector<std::uint16_t> keys, std::vector<double> transform = {},
                      std::vector<double> keyDoubles = {}, std::vector<double> tiepoint = {},
                      const char* noData = nullptr) {
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    static const TIFFFieldInfo kInfo[] = {
        {33550, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("PixelScale")},
        {33922, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("Tiepoint")},
        {34264, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("Transform")},
        {34735, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("Keys")},
        {34736, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("KeyDoubles")},
        {42112, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("Metadata")},
        {42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("NoData")}};
    TIFFMergeFieldInfo(tiff, kInfo, 7);
    for (const int tag : {TIFFTAG_IMAGEWIDTH, TIFFTAG_IMAGELENGTH}) TIFFSetField(tiff, tag, 2);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_INT);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (metadata != nullptr) TIFFSetField(tiff, 42112, metadata);
    if (noData != nullptr) TIFFSetField(tiff, 42113, noData);
    const auto setDoubles = [&](int tag, const std::vector<double>& values) {
        if (values.empty()) return;
        TIFFSetField(tiff, static_cast<std::uint32_t>(tag), static_cast<int>(values.size()),
                     values.data());
    };
    setDoubles(33550, scale);
    setDoubles(34264, transform);
    setDoubles(34736, keyDoubles);
    setDoubles(33922, tiepoint);
    if (!keys.empty()) TIFFSetField(tiff, 34735, static_cast<int>(keys.size()), keys.data());
    std::int16_t rows[2][2] = {{0, 10}, {20, 30}};
    for (std::uint32_t y = 0; y < 2; ++y) TIFFWriteScanline(tiff, rows[y], y, 0);
    TIFFClose(tiff);
    return path;
}

using HeightUnits = FolderTest;

TEST_F(HeightUnits, ScaleAndOffsetOfAGeoTiffAreApplied) {
    const fs::path path =
        writeGeoTiff(folder.path() / "a.tif",
                     "<GDALMetadata>\n"
                     "  <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item>\n"
                     "  <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item>\n"
                     "</GDALMetadata>",
                     {}, {});
    const HeightMap map = loadHeightMap(path, {});
    EXPECT_FLOAT_EQ(map.heightM(0, 0), 100.0F);
    EXPECT_FLOAT_EQ(map.heightM(1, 1), 103.0F);
    EXPECT_FLOAT_EQ(loadHeightMap(path, {1.0F, 2.0F, 10.0F}).heightM(1, 1), 206.0F);
    EXPECT_EQ(map.spacingM, glm::vec2(1.0F));
    EXPECT_FALSE(map.isSpacingOfFile);
}

TEST_F(HeightUnits, ItemsOfMetadataAreReadAsXml) {
    const fs::path path = folder.path() / "a.tif";
    const auto highest = [&](const std::string& items) {  // 30 is stored
        writeGeoTiff(path, ("<GDALMetadata>" + items + "</GDALMetadata>").c_str(), {}, {});
        return loadHeightMap(path, {}).heightM(1, 1);
    };
    EXPECT_FLOAT_EQ(highest("<Item name='SCALE' sample='0' role='scale'>0.1</Item>"), 3.0F);
    EXPECT_FLOAT_EQ(highest("<Item role = \"scale\"\nname=\"SCALE\"> 1e-1 </Item>"), 3.0F);
    EXPECT_FLOAT_EQ(highest("<!-- <Item sample=\"0\" role=\"scale\">0.5</Item> --><Item "
                            "sample=\"0\" role=\"scale\">0.1</Item>"),
                    3.0F);
    EXPECT_FLOAT_EQ(highest("<Item sample=\"1\" role=\"scale\">0.5</Item><Item sample=\"0\" "
                            "role=\"scale\">0.1</Item>"),
                    3.0F);
    EXPECT_EQ(highest("<Item sample=\"1\" role=\"scale\">0.5</Item>"), 30.0F);
    EXPECT_EQ(highest("<Item name=\"role\" unrole=\"scale\">0.5</Item>"), 30.0F);
    const auto error = [&](const char* item) {
        return errorText([&] { highest(item); }, folder.path());
    };
    EXPECT_EQ(error("<Item role=\"scale\">0,1</Item>"),
              "DIR/a.tif: its scale is '0,1'; allowed: a number");
    EXPECT_EQ(error("<Item role=\"offset\">5 m</Item>"),
              "DIR/a.tif: its offset is '5 m'; allowed: a number");
}

TEST_F(HeightUnits, NoDataIsAWholeNumber) {
    const fs::path path = folder.path() / "a.tif";
    const auto filled = [&](const char* noData) {
        writeGeoTiff(path, nullptr, {}, {}, {}, {}, {}, noData);
        return loadHeightMap(path, {}).filledCount;
    };
    EXPECT_EQ(filled("10"), 1U);
    EXPECT_EQ(filled(" 2e1 "), 1U);
    EXPECT_EQ(filled("nan"), 0U);
    EXPECT_EQ(errorText([&] { filled("10,5"); }, folder.path()),
              "DIR/a.tif: its GDAL_NODATA is '10,5'; allowed: a number");
}

TEST_F(HeightUnits, UnitsThatAreNotKnownAreSaid) {
    const fs::path path = folder.path() / "a.tif";
    const auto warnings = [&](std::vector<std::uint16_t> keys,
                              std::vector<double> scale = {30, 30, 0},
                              std::vector<double> tiepoint = {}, const HeightMapUnits& units = {}) {
        writeGeoTiff(path, nullptr, std::move(scale), std::move(keys), {}, {}, std::move(tiepoint));
        const HeightMap map = loadHeightMap(path, units);
        return std::pair(map.spacingWarning, map.unitWarning);
    };
    using Pair = std::pair<std::string, std::string>;
    const std::string feet =
        "its coordinates, of EPSG 2263 and without a unit, are taken as metres";
    EXPECT_EQ(warnings({1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2263}), Pair(feet, ""));
    EXPECT_EQ(warnings({1, 1, 0, 1, 3072, 0, 1, 2263}, {30, 30, 0}, {}, {30.0F, 1.0F, {}}),
              Pair("", ""))
        << "given";
    EXPECT_EQ(warnings({1, 1, 0, 2, 3072, 0, 1, 2263, 3076, 0, 1, 9003}), Pair("", ""));
    EXPECT_EQ(warnings({1, 1, 0, 1, 3072, 0, 1, 32632}), Pair("", "")) << "UTM";
    EXPECT_EQ(warnings({1, 1, 0, 1, 4096, 0, 1, 6360}),
              Pair("", "its heights, of EPSG 6360 and without a unit, are taken as metres"));
    EXPECT_EQ(warnings({1, 1, 0, 2, 4096, 0, 1, 6360, 4099, 0, 1, 9003}), Pair("", ""));
    EXPECT_EQ(warnings({1, 1, 0, 1, 4096, 0, 1, 5703}), Pair("", ""));
    EXPECT_EQ(
        warnings({}, {}, {0, 0, 0, 0, 0, 0, 8, 0, 0, 240, 0, 0}),
        Pair("its points on the ground (ModelTiepoint) are not used: they say no spacing", ""));
    EXPECT_EQ(warnings({1, 1, 0, 1, 1024, 0, 1, 3}),
              Pair("its coordinates, of model type 3, are taken as those of a map", ""))
        << "geocentric";
    writeGeoTiff(path, "<Item role=\"scale\">0</Item>", {30, 30, 0}, {});
    EXPECT_EQ(loadHeightMap(path, {}).unitWarning, "its scale of 0 makes all its heights the same");
}

/// By ModelPixelScale and ModelTiepoint, or by ModelTransformation: 0, 10, 20, 30 are stored.
TEST_F(HeightUnits, ZOfTheModelIsApplied) {
    const fs::path path = folder.path() / "a.tif";
    const auto corners = [&](std::vector<double> scale, std::vector<double> tiepoint,
                             std::vector<double> transform = {}, const char* metadata = nullptr,
                             std::vector<std::uint16_t> keys = {}) {
        writeGeoTiff(path, metadata, std::move(scale), std::move(keys), std::move(transform), {},
                     std::move(tiepoint));
        const HeightMap map = loadHeightMap(path, {});
        return std::pair(map.heightM(0, 0), map.heightM(1, 1));
    };
    using Pair = std::pair<float, float>;
    EXPECT_EQ(corners({30, 30, 0}, {0, 0, 0, 7, 8, 0}), Pair(0, 30));
    EXPECT_EQ(corners({30, 30, 0.5}, {0, 0, 0, 7, 8, 0}), Pair(0, 15));
    EXPECT_EQ(corners({30, 30, 1}, {0, 0, 0, 7, 8, 100}), Pair(100, 130));
    EXPECT_EQ(corners({30, 30, 0.5}, {0, 0, 10, 7, 8, 100}), Pair(95, 110));
    EXPECT_EQ(corners({30, 30, 0.5}, {}, {}, nullptr, {1, 1, 0, 1, 4099, 0, 1, 9002}),
              Pair(0, 30 * 0.1524F));
    EXPECT_EQ(corners({}, {}, {30, 0, 0, 7, 0, -30, 0, 8, 0, 0, 0.5, 100, 0, 0, 0, 1}),
              Pair(100, 115));
    // Points on the ground that are given one by one scale nothing.
    EXPECT_EQ(corners({}, {0, 0, 0, 7, 8, 100, 1, 0, 0, 8, 8, 99}), Pair(0, 30));
    const char* metadata =
        "<GDALMetadata>\n"
        "  <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item>\n"
        "  <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item>\n"
        "</GDALMetadata>";
    EXPECT_EQ(corners({30, 30, 0.5}, {0, 0, 0, 7, 8, 100}, {}, metadata), Pair(100, 115));
    EXPECT_EQ(corners({30, 30, 1}, {0, 0, 0, 7, 8, 0}, {}, metadata), Pair(100, 115));
    const auto error = [&](std::vector<double> scale, std::vector<double> tiepoint,
                           std::vector<double> transform, const char* text = nullptr) {
        return errorText([&] { corners(scale, tiepoint, transform, text); }, folder.path());
    };
    EXPECT_EQ(error({30, 30, 0}, {0, 0, 0, 7, 8, 100}, {}),
              "DIR/a.tif: z begins at 100, where its scale is 0; allowed: another scale, or 0");
    EXPECT_EQ(error({}, {}, {30, 0, 0, 7, 0, -30, 0, 8, 0, 1, 1, 0, 0, 0, 0, 1}),
              "DIR/a.tif: its ModelTransformation tilts its heights; allowed: level ones");
    EXPECT_EQ(error({30, 30, 2}, {0, 0, 0, 7, 8, 0}, {}, metadata),
              "DIR/a.tif: scale 0.5 and offset 100 of its metadata, 2 and 0 of its model's z; "
              "allowed: the same, or of one alone");
}

/// Along x and z, to some digits.
void expectSpacing(glm::vec2 found, float x, float z) {
    EXPECT_NEAR(found.x, x, 4e-4F * x);
    EXPECT_NEAR(found.y, z, 4e-4F * z);
}

TEST_F(HeightUnits, SpacingComesFromTheFileUnlessItIsGiven) {
    const fs::path path = folder.path() / "a.tif";
    const auto spacing = [&](std::vector<double> scale, std::vector<std::uint16_t> keys) {
        return loadHeightMap(writeGeoTiff(path, nullptr, std::move(scale), std::move(keys)), {})
            .spacingM;
    };
    const std::vector<std::uint16_t> projected{1, 1, 0, 1, 1024, 0, 1, 1};
    EXPECT_EQ(spacing({30, 30, 0}, projected), glm::vec2(30.0F));
    EXPECT_EQ(spacing({30, 30, 0}, {}), glm::vec2(30.0F));
    EXPECT_EQ(spacing({30, 10, 0}, projected), glm::vec2(30.0F, 10.0F));
    const std::vector<std::uint16_t> feet{1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9002};
    expectSpacing(spacing({30, 60, 0}, feet), 9.144F, 18.288F);
    const std::vector<std::uint16_t> degrees{1, 1, 0, 1, 1024, 0, 1, 2};
    expectSpacing(spacing({1.0 / 3600, 1.0 / 3600, 0}, degrees), 30.87F, 30.87F);
    EXPECT_EQ(spacing({}, projected), glm::vec2(1.0F));
    writeGeoTiff(path, nullptr, {30, 10, 0}, projected);
    EXPECT_TRUE(loadHeightMap(path, {}).isSpacingOfFile);
    EXPECT_EQ(loadHeightMap(path, {}).bounds().max, glm::vec3(30, 30, 10));
    EXPECT_EQ(loadHeightMap(path, {2.0F, 1.0F, {}}).spacingM, glm::vec2(2.0F));
    EXPECT_FALSE(loadHeightMap(path, {2.0F, 1.0F, {}}).isSpacingOfFile);
}

TEST_F(HeightUnits, SpacingOfATransformAndOfOtherUnitsIsConverted) {
    const fs::path path = folder.path() / "a.tif";
    // Samples 10 m apart, turned by 3-4-5: 6 east and 8 south a column, 8 west and 6 south a row.
    const std::vector<double> turned{6, -8, 0, 5e5, -8, -6, 0, 4e6, 0, 0, 0, 0, 0, 0, 0, 1};
    writeGeoTiff(path, nullptr, {}, {1, 1, 0, 1, 1024, 0, 1, 1}, turned);
    expectSpacing(loadHeightMap(path, {}).spacingM, 10.0F, 10.0F);
    const auto spacing = [&](std::vector<std::uint16_t> keys, std::vector<double> doubles = {}) {
        writeGeoTiff(path, nullptr, {0.5, 0.5, 0}, std::move(keys), {}, std::move(doubles));
        const glm::vec2 both = loadHeightMap(path, {}).spacingM;
        EXPECT_EQ(both.x, both.y);
        return both.x;
    };
    EXPECT_FLOAT_EQ(spacing({1, 1, 0, 1, 3076, 0, 1, 9036}), 500.0F);
    EXPECT_FLOAT_EQ(spacing({1, 1, 0, 1, 3076, 0, 1, 9003}), 600.0F / 3937.0F);
    EXPECT_FLOAT_EQ(spacing({1, 1, 0, 2, 3076, 0, 1, 32767, 3077, 34736, 1, 1}, {7, 0.25}), 0.125F);
    EXPECT_EQ(errorText(
                  [&] {
                      spacing({1, 1, 0, 1, 3076, 0, 1, 9014});
                  },
                  folder.path()),
              "DIR/a.tif: the linear unit is 9014; allowed: 9001 (metre), 9002 (foot), 9003 (US "
              "survey foot), 9036 (kilometre)");
    EXPECT_EQ(errorText(
                  [&] {
                      spacing({1, 1, 0, 2, 1024, 0, 1, 2, 2054, 0, 1, 9101});
                  },
                  folder.path()),
              "DIR/a.tif: the angular unit is 9101; allowed: 9102 (degree)");
    // Who says it does not need the file's.
    const HeightMapUnits units{.spacingM = 5.0F};
    EXPECT_EQ(loadHeightMap(folder.path() / "a.tif", units).spacingM, glm::vec2(5.0F));
}

TEST_F(HeightUnits, SamplesThatStandAskewAreRefused) {
    const fs::path path = folder.path() / "a.tif";
    const auto error = [&](std::vector<double> scale, std::vector<double> transform,
                           std::vector<std::uint16_t> keys = {}) {
        writeGeoTiff(path, nullptr, std::move(scale), std::move(keys), std::move(transform));
        return errorText([&] { loadHeightMap(path, {}); }, folder.path());
    };
    EXPECT_EQ(error({}, {30, 0, 0, 0, 0, -10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), "no error");
    EXPECT_EQ(loadHeightMap(path, {}).spacingM, glm::vec2(30.0F, 10.0F));
    const std::string askew = "DIR/a.tif: its rows and columns are askew; allowed: at right angles";
    EXPECT_EQ(error({}, {10, 6, 0, 0, 0, -8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), askew);
    const HeightMapUnits units{.spacingM = 8.0F};
    EXPECT_EQ(loadHeightMap(path, units).spacingM, glm::vec2(8.0F)) << "by who reads it";
    // Turned in degrees at 60 degrees north, where those from west to east are half as long.
    const std::vector<std::uint16_t> degrees{1, 1, 0, 1, 1024, 0, 1, 2};
    EXPECT_EQ(error({}, {1, -1, 0, 0, -1, -1, 0, 62, 0, 0, 0, 0, 0, 0, 0, 1}, degrees), askew);
    EXPECT_EQ(error({}, {0, 1, 0, 0, 1, 0, 0, 59, 0, 0, 0, 0, 0, 0, 0, 1}, degrees), "no error");
    expectSpacing(loadHeightMap(path, {}).spacingM, 111133.0F, 55566.0F);
    const std::string north =
        "DIR/a.tif: its rows go north; allowed: from west to east and north to south";
    EXPECT_EQ(error({30, -30, 0}, {}), north);
    EXPECT_EQ(error({}, {30, 0, 0, 0, 0, 30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), north);
    const std::string west =
        "DIR/a.tif: its columns go west; allowed: from west to east and north to south";
    EXPECT_EQ(error({-30, 30, 0}, {}), west);
    EXPECT_EQ(error({}, {-30, 0, 0, 0, 0, -30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), west);
    EXPECT_EQ(error({}, {0, -30, 0, 0, 30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}),
              "DIR/a.tif: it is mirrored; allowed: from west to east and north to south");
    EXPECT_EQ(error({}, {-30, 0, 0, 0, 0, 30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), "no error")
        << "turned about";
}

TEST_F(HeightUnits, OtherPagesRowsAndBitsAreRefused) {
    const fs::path path = folder.path() / "a.tif";
    const auto error = [&](int pages, std::uint32_t kind, int orientation,
                           int colours = PHOTOMETRIC_MINISBLACK, int bits = 8) {
        TIFF* tiff = TIFFOpen(path.c_str(), "w");
        for (int page = 0; page < pages; ++page) {
            for (const int tag : {TIFFTAG_IMAGEWIDTH, TIFFTAG_IMAGELENGTH}) {
                TIFFSetField(tiff, tag, 2);
            }
            TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
            TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
            TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, colours);
            if (colours == PHOTOMETRIC_PALETTE) {
                std::uint16_t palette[256] = {};
                TIFFSetField(tiff, TIFFTAG_COLORMAP, palette, palette, palette);
            }
            TIFFSetField(tiff, TIFFTAG_ORIENTATION, orientation);
            if (page > 0) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, kind);
            std::uint8_t row[16] = {1, 2};  // of two samples of up to 64 bits
            for (std::uint32_t y = 0; y < 2; ++y) TIFFWriteScanline(tiff, row, y, 0);
            TIFFWriteDirectory(tiff);
        }
        TIFFClose(tiff);
        return errorText([&] { loadHeightMap(path, {}); }, folder.path());
    };
    EXPECT_EQ(error(2, FILETYPE_REDUCEDIMAGE, 1), "no error");
    EXPECT_EQ(error(2, 0, 1), "DIR/a.tif: has 2 pages; one is allowed");
    EXPECT_EQ(error(1, 0, 4), "DIR/a.tif: orientation 4; allowed: 1 (rows from the top)");
    EXPECT_EQ(error(1, 0, 1, PHOTOMETRIC_PALETTE),
              "DIR/a.tif: a palette of colours; a height map is grey");
    for (const int bits : {1, 2, 4, 12, 24, 64}) {
        EXPECT_EQ(error(1, 0, 1, PHOTOMETRIC_MINISBLACK, bits),
                  fmt::format("DIR/a.tif: 1 × {} bits a sample (sample format 1); allowed: one "
                              "number, an integer of 8, 16 or 32 bits or a float of 32 or 64",
                              bits));
    }
}

TEST_F(HeightUnits, MapsThatAreNotTrueToScaleAreCorrectedOrSaid) {
    const auto load = [&](std::vector<std::uint16_t> key, double north) {
        std::vector<std::uint16_t> keys{1, 1, 0, 2, 1024, 0, 1, 1};
        keys.insert(keys.end(), key.begin(), key.end());
        std::vector<double> tiepoint;
        if (north >= 0.0) tiepoint = {0, 0, 0, 7, north + 40, 0};  // of its middle
        return loadHeightMap(
            writeGeoTiff(folder.path() / "a.tif", nullptr, {40, 40, 0}, keys, {}, {}, tiepoint),
            {});
    };
    constexpr double kAt60M = 8399737.89;  // ln(tan(75°)) · 6378137
    for (const auto code : {std::uint16_t{3395}, std::uint16_t{3785}, std::uint16_t{3857}}) {
        const HeightMap map = load({3072, 0, 1, code}, kAt60M);
        expectSpacing(map.spacingM, 20.0F, 20.0F);
        EXPECT_EQ(map.spacingWarning,
                  "its samples stand 40 m apart on its map, of Mercator's projection, and 20 m on "
                  "the ground in its middle; they are drawn 20 m apart");
        EXPECT_EQ(load({3072, 0, 1, code}, 0.0).spacingWarning, "") << "at the equator";
    }
    const HeightMap somewhere = load({3072, 0, 1, 3857}, -1.0);
    EXPECT_EQ(somewhere.spacingM, glm::vec2(40.0F));
    EXPECT_EQ(somewhere.spacingWarning,
              "its coordinates, of Mercator's projection, do not say how far north it lies: its "
              "samples are drawn 40 m apart, as at the equator");
    // Equirectangular: 60 degrees north.
    const HeightMap plate = load({3072, 0, 1, 4087}, 6378137.0 * 3.14159265358979 / 3);
    expectSpacing(plate.spacingM, 20.0F, 40.0F);
    EXPECT_EQ(plate.spacingWarning, "");
    const std::string untrue =
        "its projection is not true to scale: its samples are drawn as far apart as on its map";
    EXPECT_EQ(load({3072, 0, 1, 6933}, 0.0).spacingWarning, untrue);
    EXPECT_EQ(load({3075, 0, 1, 7}, 0.0).spacingWarning, untrue);
    EXPECT_EQ(load({3075, 0, 1, 1}, 0.0).spacingWarning, "") << "transverse Mercator";
    EXPECT_EQ(load({3072, 0, 1, 32633}, kAt60M).spacingM, glm::vec2(40.0F)) << "UTM";
}

TEST_F(HeightUnits, DegreesFromWestToEastAreShorterInTheNorth) {
    const std::vector<std::uint16_t> geographic{1, 1, 0, 1, 1024, 0, 1, 2};
    const auto load = [&](std::vector<double> scale, std::vector<double> tiepoint,
                          std::vector<double> transform = {}) {
        const fs::path path =
            writeGeoTiff(folder.path() / "a.tif", nullptr, std::move(scale), geographic,
                         std::move(transform), {}, std::move(tiepoint));
        return loadHeightMap(path, {});
    };
    const double second = 1.0 / 3600;
    // 60 degrees north: half as long.
    const HeightMap map = load({second, second, 0}, {0, 0, 0, 7, 60 + second, 0});
    expectSpacing(map.spacingM, 15.435F, 30.87F);
    EXPECT_EQ(map.spacingWarning, "");
    const HeightMap same =
        load({}, {}, {second, 0, 0, 7, 0, -second, 0, 60 + second, 0, 0, 0, 0, 0, 0, 0, 1});
    expectSpacing(same.spacingM, 15.435F, 30.87F);
    expectSpacing(load({2 * second, second, 0}, {0, 0, 0, 7, 60, 0}).spacingM, 30.87F, 30.87F);
    expectSpacing(load({second, second, 0}, {0, 0, 0, 7, 1, 0}).spacingM, 30.865F, 30.87F);
    const HeightMap nowhere = load({2 * second, second, 0}, {});
    expectSpacing(nowhere.spacingM, 61.74F, 30.87F);
    EXPECT_EQ(nowhere.spacingWarning,
              "its coordinates, of latitude and longitude, do not say how far north it lies: its "
              "samples are drawn 61.7405 x 30.8703 m apart, as at the equator");
    const auto latitudeError = [&](double north) {
        return errorText([&] { load({1, 1, 0}, {0, 0, 0, 7, north, 0}); }, folder.path());
    };
    EXPECT_EQ(latitudeError(90.5), "no error");
    EXPECT_EQ(latitudeError(91),
              "DIR/a.tif: its middle has the latitude 90; allowed: between -90 and 90");
    EXPECT_EQ(latitudeError(-89.5),
              "DIR/a.tif: its middle has the latitude -90.5; allowed: between -90 and 90");
}

TEST_F(HeightUnits, SrtmTilesSayWhereTheyLieByTheirNames) {
    const std::string tile(std::size_t{2} * 1201 * 1201, '\0');
    const auto ofTile = [&](const char* name) {
        return loadHeightMap(folder.write(name, tile), {});
    };
    for (const char* name : {"N47W123.hgt", "S48E007.hgt", "n47w123.hgt"}) {
        const HeightMap map = ofTile(name);  // at 47.5 degrees
        expectSpacing(map.spacingM, 62.566F, 92.611F);
        expectSpacing({map.bounds().size().x, map.bounds().size().z}, 75079.0F, 111133.0F);
        EXPECT_EQ(map.spacingWarning, "") << name;
    }
    for (const char* name : {"a.hgt", "tile.hgt", "X60E007.hgt", "N90E007.hgt", "S91E007.hgt"}) {
        const HeightMap map = ofTile(name);
        EXPECT_EQ(map.spacingM.x, map.spacingM.y);
        EXPECT_EQ(map.spacingWarning,
                  "its name says no latitude, as that of N46E007.hgt does: its samples are drawn "
                  "as far apart from west to east as from north to south");
    }
}

TEST_F(HeightUnits, HeightsInFeetBecomeMetres) {
    const fs::path path = folder.path() / "a.tif";
    const auto highest = [&](const char* metadata, std::vector<std::uint16_t> keys) {
        writeGeoTiff(path, metadata, {}, std::move(keys));
        return loadHeightMap(path, {}).heightM(1, 1);  // 30 is stored
    };
    EXPECT_FLOAT_EQ(highest(nullptr, {1, 1, 0, 1, 4099, 0, 1, 9002}), 9.144F);
    EXPECT_FLOAT_EQ(highest(nullptr, {1, 1, 0, 1, 4099, 0, 1, 9001}), 30.0F);
    EXPECT_FLOAT_EQ(highest("<GDALMetadata>\n"
                            "  <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item>\n"
                            "  <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item>\n"
                            "  <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item>\n"
                            "</GDALMetadata>",
                            {}),
                    35.052F);  // 115 ft
    const auto unit = [&](const std::string& name) {
        const std::string metadata =
            "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">" + name +
            "</Item></GDALMetadata>";
        return highest(metadata.c_str(), {});
    };
    for (const char* metre : {"m", "metre", "Metre", "METERS"}) {
        EXPECT_FLOAT_EQ(unit(metre), 30.0F) << metre;
    }
    for (const char* foot : {"US survey foot", "US Survey Foot", "ftUS", "US-ft"}) {
        EXPECT_FLOAT_EQ(unit(foot), 36000.0F / 3937.0F) << foot;
    }
    EXPECT_EQ(errorText([&] { unit("Fathom"); }, folder.path()),
              "DIR/a.tif: its heights are in 'Fathom'; allowed: m, ft, us-ft");
    EXPECT_EQ(errorText(
                  [&] {
                      highest(nullptr, {1, 1, 0, 1, 4099, 0, 1, 9014});
                  },
                  folder.path()),
              "DIR/a.tif: the vertical unit is 9014; allowed: 9001 (metre), 9002 (foot), 9003 (US "
              "survey foot), 9036 (kilometre)");
}

TEST_F(HeightUnits, SrtmTilesHaveTheSpacingOfTheirFormat) {
    const fs::path path = folder.write("N00E000.hgt", "");
    fs::resize_file(path, 2884802);
    expectSpacing(loadHeightMap(path, {}).spacingM, 92.61F, 92.61F);
    fs::resize_file(path, 25934402);
    expectSpacing(loadHeightMap(path, {}).spacingM, 30.87F, 30.87F);
}

/// Two rows of two samples, `bits` each. `describe(png, info)` adds chunks.
template <class Describe>
void writeGrey(const fs::path& path, int bits, unsigned char row, const Describe& describe) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, 2, 2, bits, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    describe(png, info);
    png_write_info(png, info);
    for (int y = 0; y < 2; ++y) png_write_row(png, &row);
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

TEST_F(HeightUnits, PngOfFewBitsHasTheNumbersThatItStores) {
    const fs::path path = folder.path() / "a.png";
    const auto heights = [&](int bits, unsigned char row) {
        writeGrey(path, bits, row, [](png_structp, png_infop) {});
        const HeightMap map = loadHeightMap(path, {});
        return std::vector<float>{map.heightM(0, 0), map.heightM(1, 1)};
    };
    EXPECT_EQ(heights(4, 0xF3), (std::vector<float>{15, 3}));
    EXPECT_EQ(heights(2, 0x90), (std::vector<float>{2, 1}));
    EXPECT_EQ(heights(1, 0x40), (std::vector<float>{0, 1}));
}

TEST_F(HeightUnits, PngSaysHowLargeItsPixelsAre) {
    const fs::path path = folder.path() / "a.png";
    const auto loaded = [&](int unit, const char* x, const char* y) {
        writeGrey(path, 4, 0xF3,
                  [&](png_structp png, png_infop info) { png_set_sCAL_s(png, info, unit, x, y); });
        return loadHeightMap(path, {});
    };
    const HeightMap map = loaded(PNG_SCALE_METER, "30.5", "3.05e1");
    EXPECT_EQ(map.spacingM, glm::vec2(30.5F));
    EXPECT_TRUE(map.isSpacingOfFile);
    EXPECT_EQ(map.spacingWarning, "");
    const HeightMap uneven = loaded(PNG_SCALE_METER, "30", "60");
    EXPECT_EQ(uneven.spacingM, glm::vec2(30.0F, 60.0F));
    EXPECT_EQ(uneven.spacingWarning, "");
    const HeightMap angles = loaded(PNG_SCALE_RADIAN, "0.5", "0.5");
    EXPECT_EQ(angles.spacingM, glm::vec2(1.0F));
    EXPECT_EQ(angles.spacingWarning,
              "left out: the size of its pixels (chunk sCAL), none in metres");
    EXPECT_EQ(loadHeightMap(path, {30.0F, 1.0F, {}}).spacingWarning, "") << "given";
    writeGrey(path, 4, 0xF3, [](png_structp png, png_infop info) {
        char purpose[] = "height", unit[] = "m", zero[] = "0", one[] = "1";
        char* parameters[] = {zero, one};
        png_set_pCAL(png, info, purpose, 0, 15, PNG_EQUATION_LINEAR, 2, unit, parameters);
    });
    EXPECT_EQ(
        loadHeightMap(path, {}).unitWarning,
        "left out: what its values mean (chunk pCAL): heights are the numbers that are stored");
}

TEST_F(HeightUnits, APngThatIsTurnedIsNone) {
    const fs::path path = folder.path() / "a.png";
    const auto turned = [&](char orientation) {
        std::string exif("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\0\0\0\0\0\0\0\0", 26);
        exif[18] = orientation;
        writeGrey(path, 4, 0xF3, [&](png_structp png, png_infop info) {
            png_set_eXIf_1(png, info, static_cast<png_uint_32>(exif.size()),
                           reinterpret_cast<png_bytep>(exif.data()));
        });
        return errorText([&] { loadHeightMap(path, {}); }, folder.path());
    };
    EXPECT_EQ(turned(1), "no error");
    EXPECT_EQ(turned(6), "DIR/a.png: turned by its Exif; allowed: as stored");
}

}  // namespace
}  // namespace gfxrepro::scene
