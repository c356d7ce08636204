// Clouds of points as scanners' programs write them: XYZ in text, and LAS.
#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/srgb.h"
#include "engine/scene/load.h"
#include "engine/scene/point_sampling.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

using Lines = std::vector<std::string>;
using Points = std::vector<glm::vec3>;

struct LoadClouds : FolderTest {
    Scene xyz(const std::string& text) { return loadScene(folder.write("a.XYZ", text)); }
    Scene las(const std::string& bytes, const char* name = "a.las") {
        return loadScene(folder.write(name, bytes));
    }
    std::string xyzError(const std::string& text) {
        return errorText([&] { xyz(text); }, folder.path());
    }
    std::string lasError(const std::string& bytes, const char* name = "a.las") {
        return errorText([&] { las(bytes, name); }, folder.path());
    }
};

TEST_F(LoadClouds, ReadsPlacesOfXyz) {
    const Points expected{{0, 1, 2}, {-3.5F, 4e1F, 5}};
    for (const char* text :
         {"0 1 2\n-3.5 4e1 5\n", "0,1,2\r\n-3.5, 40, 5\r\n", "\t0;1;2\n\n-3.5;+40;5",
          "# made by x\n// and y\n0 1 2 # first\n-3.5 40 5\n", "2\n0 1 2\n-3.5 40 5\n",
          "x y z\n0 1 2\n-3.5 40 5\n", "//X Y Z\n0 1 2\n-3.5 40 5\n",
          "# x y z are metres\n0 1 2\n-3.5 40 5\n",
          "\xEF\xBB\xBF"
          "0 1 2\r-3.5 40 5\r"}) {
        const Scene scene = xyz(text);
        EXPECT_EQ(scene.points.positions, expected) << text;
        EXPECT_EQ(scene.warnings, Lines{}) << text;
        EXPECT_EQ(scene.triangleCount(), 0U);
    }
    EXPECT_EQ(xyz("z,x,y\n2,0,1\n5,-3.5,40\n").points.positions, expected);
}

TEST_F(LoadClouds, ReadsNormalsAndColoursOfXyz) {
    const Scene named =
        xyz("X Y Z Intensity Red Green Blue Nx Ny Nz\n"
            "0 0 0 7 255 0 0 0 2 0\n1 0 0 8 0 255 0 0 0 0\n");
    EXPECT_EQ(named.points.colors, (Points{{1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(named.points.normals, (Points{{0, 1, 0}, {0, 0, 0}}));
    EXPECT_EQ(named.warnings, Lines{"left out: the column 'intensity'"});

    const Scene normals = xyz("0 0 0 0 0.6 -0.8\n1 0 0 1 0 0\n");
    EXPECT_EQ(normals.points.normals.at(0), glm::vec3(0, 0.6F, -0.8F));
    EXPECT_EQ(normals.warnings, Lines{"columns 4 to 6 are taken as normals"});
    const Scene colours = xyz("0 0 0 255 128 0\n1 0 0 0 0 1\n");
    EXPECT_NEAR(image::srgbOf(colours.points.colors.at(0).g), 128.0F / 255.0F, 1e-6F);
    EXPECT_TRUE(colours.points.normals.empty());
    EXPECT_EQ(colours.warnings, Lines{"columns 4 to 6 are taken as colours"});
    const Scene both = xyz("0 0 0 12 0.5 0.5 0.5 0 0 1\n1 0 0 13 1 0.5 0.5 1 0 0\n");
    EXPECT_EQ(both.points.normals, (Points{{0, 0, 1}, {1, 0, 0}}));
    EXPECT_EQ(both.points.colors.size(), 2U);
    EXPECT_EQ(both.warnings, (Lines{"columns 5 to 7 are taken as colours",
                                    "columns 8 to 10 are taken as normals", "left out: column 4"}));
}

TEST_F(LoadClouds, SaysWhatIsLeftOutOfXyz) {
    EXPECT_EQ(xyz("0 0 0 4 5\nnan nan nan 4 5\n1 0 0 4 5\n").warnings,
              (Lines{"left out: a point whose place is no number", "left out: column 4",
                     "left out: column 5"}));
    EXPECT_EQ(xyz("0 0 0 -3 0 0\n").warnings, Lines{"left out: columns 4 to 6"});
    EXPECT_EQ(xyz("x y z nx ny\n0 0 0 1 0\n").warnings,
              (Lines{"left out: the column 'nx'", "left out: the column 'ny'"}));
}

TEST_F(LoadClouds, RefusesBrokenXyz) {
    EXPECT_EQ(xyzError(""), "DIR/a.XYZ:1: no points");
    EXPECT_EQ(xyzError("# nothing\n"), "DIR/a.XYZ:2: no points");
    EXPECT_EQ(xyzError("0 0\n"), "DIR/a.XYZ:1: the line lacks a number");
    EXPECT_EQ(xyzError("0 0 0\n1 0\n"), "DIR/a.XYZ:2: 2 columns; the first point has 3");
    EXPECT_EQ(xyzError("x y z\n0 0 0 1\n"), "DIR/a.XYZ:2: 4 columns; 3 are named");
    EXPECT_EQ(xyzError("0 0 inf\n"), "DIR/a.XYZ:1: 'inf' is not a finite number");
    EXPECT_EQ(xyzError("0 0 2e9\n"),
              "DIR/a.XYZ:1: a coordinate is 2e+09; -1e+09 to 1e+09 are allowed");
    EXPECT_EQ(xyzError("0 0 0 1 nan 0\n"), "DIR/a.XYZ:1: 'nan' is not a finite number");
    EXPECT_EQ(xyzError("2\nwater\nO 0 0 0\n"), "DIR/a.XYZ:2: the line lacks a number")
        << "of molecules";
    EXPECT_EQ(xyzError("3\n0 0 0\n1 0 0\n"), "DIR/a.XYZ:4: the file says 3 points and has 2");
    EXPECT_EQ(xyzError("\x1F\x8B\x08 0"),
              "DIR/a.XYZ: is compressed by gzip; allowed: as it is, text in UTF-8");
}

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof(value));
}

/// What a test says of a LAS file.
struct Las {
    int minor = 2;
    int format = 0;
    std::size_t recordBytes = 20;
    glm::dvec3 scale{0.5};
    glm::dvec3 offset{0.0};
    std::vector<std::pair<std::string, std::size_t>> records = {};  // user, and bytes

    /// As the ASPRS has it; `points` are steps of `scale`.
    std::string bytes(const std::vector<glm::ivec3>& points) const {
        const std::size_t head = minor == 4 ? 375 : minor == 3 ? 235 : 227;
        std::string result(head, '\0');
        std::memcpy(result.data(), "LASF", 4);
        put(result, 24, std::uint8_t{1});
        put(result, 25, static_cast<std::uint8_t>(minor));
        put(result, 94, static_cast<std::uint16_t>(head));
        put(result, 100, static_cast<std::uint32_t>(records.size()));
        put(result, 104, static_cast<std::uint8_t>(format));
        put(result, 105, static_cast<std::uint16_t>(recordBytes));
        const std::size_t count = points.size();
        if (minor == 4) put(result, 247, static_cast<std::uint64_t>(count));
        if (minor < 4) put(result, 107, static_cast<std::uint32_t>(count));
        for (int axis = 0; axis < 3; ++axis) {
            put(result, 131 + 8 * static_cast<std::size_t>(axis), scale[axis]);
            put(result, 155 + 8 * static_cast<std::size_t>(axis), offset[axis]);
        }
        for (const auto& [user, size] : records) {
            std::string record(54 + size, '\0');
            std::memcpy(record.data() + 2, user.data(), user.size());
            put(record, 20, static_cast<std::uint16_t>(size));
            result += record;
        }
        put(result, 96, static_cast<std::uint32_t>(result.size()));
        for (const glm::ivec3& point : points) {
            std::string record(recordBytes, '\0');
            for (int axis = 0; axis < 3; ++axis) {
                put(record, 4 * static_cast<std::size_t>(axis), std::int32_t{point[axis]});
            }
            result += record;
        }
        return result;
    }
};

const std::vector<glm::ivec3> kSteps{{0, 2, 4}, {-7, 80, 10}};

TEST_F(LoadClouds, ReadsPlacesOfLas) {
    const std::pair<int, Las> files[] = {
        {0, {.minor = 0}},
        {1, {.minor = 2, .format = 1, .recordBytes = 28}},
        {2, {.minor = 3, .format = 3, .recordBytes = 34}},
        {3, {.minor = 4, .format = 6, .recordBytes = 30}},
        {4, {.minor = 4, .format = 8, .recordBytes = 38}},
    };
    for (const auto& [number, file] : files) {
        const Scene scene = las(file.bytes(kSteps));
        EXPECT_EQ(scene.points.positions, (Points{{0, 1, 2}, {-3.5F, 40, 5}})) << number;
        EXPECT_TRUE(scene.points.colors.empty()) << number;
    }
    EXPECT_EQ(las(Las{}.bytes(kSteps)).warnings, Lines{});
}

TEST_F(LoadClouds, ReadsColoursOfLas) {
    const std::pair<std::size_t, Las> files[] = {
        {20, {.format = 2, .recordBytes = 26}},
        {28, {.format = 3, .recordBytes = 34}},
        {30, {.minor = 4, .format = 7, .recordBytes = 36}},
        {30, {.minor = 4, .format = 8, .recordBytes = 38}},
    };
    for (const auto& [at, file] : files) {
        for (const int whole : {65535, 255}) {
            std::string bytes = file.bytes(kSteps);
            const std::size_t place = bytes.size() - file.recordBytes + at;
            put(bytes, place, static_cast<std::uint16_t>(whole));
            put(bytes, place + 4, static_cast<std::uint16_t>(whole / 5));
            const Scene scene = las(bytes);
            EXPECT_EQ(scene.points.colors.at(0), glm::vec3(0)) << file.format;
            const glm::vec3& second = scene.points.colors.at(1);
            EXPECT_NEAR(second.r, 1.0F, 1e-6F);
            EXPECT_EQ(second.g, 0.0F);
            EXPECT_NEAR(image::srgbOf(second.b), 0.2F, 1e-6F) << file.format;
            EXPECT_EQ(scene.warnings, whole == 255
                                          ? Lines{"colours up to 255 are taken as parts of 255"}
                                          : Lines{});
        }
        EXPECT_EQ(las(file.bytes(kSteps)).warnings,
                  Lines{"left out: the colour of all points, which is black"});
    }
}

/// Of the old formats and of those of LAS 1.4 every field, and what may stand around points.
TEST_F(LoadClouds, SaysWhatIsLeftOutOfLas) {
    const Las old{.format = 1,
                  .recordBytes = 30,
                  .records = {{"LASF_Projection", 8}, {"LASF_Projection", 0}, {"x", 3}}};
    std::string bytes = old.bytes(kSteps);
    const std::size_t first = bytes.size() - 60;
    for (std::size_t at = 12; at < 28; ++at) bytes[first + at] = '\1';
    EXPECT_EQ(las(bytes).warnings,
              (Lines{"left out: a byte behind a point's record (4 times)",
                     "left out: a variable-length record of 'x'", "left out: the class of a point",
                     "left out: the coordinate reference system (2 times)",
                     "left out: the intensity of a point", "left out: the return of a point",
                     "left out: the scan angle of a point", "left out: the source of a point",
                     "left out: the time of a point", "left out: the user's data of a point"}));

    std::string extended = Las{.minor = 4, .format = 8, .recordBytes = 38}.bytes(kSteps);
    for (std::size_t at = 12; at < 38; ++at) extended[extended.size() - 38 + at] = '\1';
    put(extended, 243, std::uint32_t{2});
    EXPECT_EQ(las(extended).warnings,
              (Lines{"left out: an extended variable-length record (2 times)",
                     "left out: the class of a point", "left out: the infrared of a point",
                     "left out: the intensity of a point", "left out: the return of a point",
                     "left out: the scan angle of a point", "left out: the source of a point",
                     "left out: the time of a point", "left out: the user's data of a point"}));
}

TEST_F(LoadClouds, LeavesOutWithheldPointsOfLas) {
    const std::pair<char, Las> files[] = {{'\x80', {}},
                                          {'\x04', {.minor = 4, .format = 6, .recordBytes = 30}}};
    for (const auto& [flag, file] : files) {
        std::string bytes = file.bytes(kSteps);
        const std::size_t second = bytes.size() - file.recordBytes + 15;
        bytes[second] = flag;
        const Scene scene = las(bytes);
        EXPECT_EQ(scene.points.positions, (Points{{0, 1, 2}}));
        EXPECT_EQ(scene.warnings, Lines{"left out: a point that is marked as withheld"});
        bytes[second - file.recordBytes] = flag;
        EXPECT_EQ(lasError(bytes), "DIR/a.las: each of its points is marked as withheld");
    }
}

TEST_F(LoadClouds, RefusesCompressedLas) {
    const char* const refused =
        "is compressed (LAZ); allowed: LAS as it is, which laszip or PDAL make of it";
    for (const int bits : {0x80, 0x40}) {
        const std::string bytes = Las{.format = 1 | bits, .recordBytes = 28}.bytes(kSteps);
        EXPECT_EQ(lasError(bytes, "a.laz"), std::string("DIR/a.laz: ") + refused);
        EXPECT_EQ(lasError(bytes), std::string("DIR/a.las: ") + refused);
    }
}

TEST_F(LoadClouds, RefusesBrokenLas) {
    const std::string good = Las{}.bytes(kSteps);
    EXPECT_EQ(lasError("short"), "DIR/a.las: is no LAS file: does not begin with 'LASF'");
    EXPECT_EQ(lasError(good.substr(0, 110)), "DIR/a.las: ends early: has 110 bytes");
    EXPECT_EQ(lasError(good.substr(0, 266)), "DIR/a.las: has 266 bytes; its 2 points end at 267");
    EXPECT_EQ(lasError(Las{.minor = 5}.bytes(kSteps)),
              "DIR/a.las: is of LAS 1.5; 1.0 to 1.4 are allowed");
    EXPECT_EQ(lasError(Las{.format = 4, .recordBytes = 57}.bytes(kSteps)),
              "DIR/a.las: has points of format 4; 0 to 3 and 6 to 8 are allowed");
    EXPECT_EQ(lasError(Las{.format = 2}.bytes(kSteps)),
              "DIR/a.las: has records of 20 bytes; a point of format 2 takes 26");
    EXPECT_EQ(lasError(Las{}.bytes({})), "DIR/a.las: no points");
    EXPECT_EQ(
        lasError(Las{.scale = {1, 0, 1}}.bytes(kSteps)),
        "DIR/a.las: its scale is 0 and its offset 0; finite numbers are allowed, of scales but 0");
    EXPECT_EQ(lasError(Las{.offset = {0, 2e9, 0}}.bytes(kSteps)),
              "DIR/a.las: point 0: a coordinate is 2e+09; -1e+09 to 1e+09 are allowed");
    std::string records = Las{.records = {{"x", 3}}}.bytes(kSteps);
    put(records, 100, std::uint32_t{9});
    EXPECT_EQ(lasError(records),
              "DIR/a.las: its variable-length record 2 of 9 ends behind its first point");
    std::string many = Las{.minor = 4, .format = 6, .recordBytes = 30}.bytes(kSteps);
    put(many, 247, std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(lasError(many).substr(0, 24), "DIR/a.las: has 435 bytes");
}

/// Of a survey in UTM, with steps of a millimetre.
TEST_F(LoadClouds, KeepsPlacesFarFromTheOrigin) {
    const Las file{.scale = glm::dvec3(0.001), .offset = {500'000, 4'500'000, 0}};
    std::string text;
    std::vector<glm::ivec3> steps;
    for (int i = 0; i < 100; ++i) {
        steps.emplace_back(3 * i, i * i, 10'000 + i);
        text += fmt::format("{:.3f} {:.3f} {:.3f}\n", 500'000 + 0.001 * steps[i].x,
                            4'500'000 + 0.001 * steps[i].y, 0.001 * steps[i].z);
    }
    for (const Scene& scene : {las(file.bytes(steps)), xyz(text)}) {
        ASSERT_EQ(scene.points.positions.size(), 100U);
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const glm::dvec3 at = glm::dvec3(scene.points.positions[i]) + scene.offset;
            const glm::dvec3 expected = glm::dvec3(steps[i]) * 0.001 + file.offset;
            EXPECT_LT(glm::length(at - expected), 1e-5);
        }
        EXPECT_EQ(scene.warnings.size(), 1U);
    }
}

/// What points lack is made up for where they are drawn.
TEST_F(LoadClouds, NeedNoNormals) {
    std::string text;
    for (int i = 0; i < 100; ++i) text += fmt::format("{} 0 {}\n", i % 10, i / 10);
    PointCloud points = xyz(text).points;
    EXPECT_EQ(completePoints(points).normals, 100U);
    EXPECT_EQ(points.normals.at(44), glm::vec3(0, 1, 0));
}

}  // namespace
}  // namespace gfxrepro::scene
