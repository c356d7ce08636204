#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "engine/image/srgb.h"
#include "engine/scene/load.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

using namespace std::string_literals;
using Lines = std::vector<std::string>;

struct LoadOffStl : FolderTest {
    Scene off(const std::string& text) { return loadScene(folder.write("a.off", text)); }
    Scene stl(const std::string& text) { return loadScene(folder.write("a.STL", text)); }
    template <class Load>
    std::string error(Load&& load) {
        return errorText(load, folder.path());
    }
    std::string offError(const std::string& text) {
        return error([&] { off(text); });
    }
    std::string stlError(const std::string& text) {
        return error([&] { stl(text); });
    }
};

double areaOf(const Scene& scene) {
    const Mesh mesh = flattened(scene);
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 *p = mesh.positions.data(), &a = p[t.x], &b = p[t.y], &c = p[t.z];
        area += 0.5 * double{glm::length(glm::cross(b - a, c - a))};
    }
    return area;
}

TEST_F(LoadOffStl, ReadsOffOfAnyPolygons) {
    // An L, in the forms of headers that are in use; edges may not be counted.
    const std::string body = "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 5\n";
    for (const char* head : {"OFF\n6 1 0\n", "OFF 6 1 0\n", "OFF6 1 0\n", "# of\n\nOFF # a\n6 1\n",
                             "6 1 0\n", "\xEF\xBB\xBFOFF\r\n6 1 0\r\n"}) {
        const Scene scene = off(head + body);
        EXPECT_EQ(scene.triangleCount(), 4U) << head;
        EXPECT_NEAR(areaOf(scene), 3.0, 1e-6) << head;
        EXPECT_EQ(scene.warnings, Lines{}) << head;
    }
}

TEST_F(LoadOffStl, ReadsWhatOffSaysOfVertices) {
    const Mesh mesh = off("STCNOFF\n3 1 0\n0 0 0 0 0 2 255 0 0 255 0 0.5\n"
                          "1 0 0 0 0 2 0 255 0 255 1 0.5\n0 1 0 0 0 2 0 0 255 255 0 1\n3 0 1 2\n")
                          .meshes.at(0);
    EXPECT_EQ(mesh.normals.at(1), glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.colors.at(1), glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.texcoords.at(1), glm::vec2(1, 0.5F));
    const Scene points = off("COFF\n2 0 0\n0 0 0 0.5 0.5 0.5\n5 0 0 1 1 1 1\n");
    EXPECT_EQ(points.points.positions.at(1), glm::vec3(5, 0, 0));
    EXPECT_NEAR(points.points.colors.at(0).r, 0.214F, 1e-3F);
    const Scene far = off("OFF\n3 1 0\n500000.25 0 0\n500000.5 0 0\n500000.25 1 0\n3 0 1 2\n");
    EXPECT_EQ(far.offset.x + double{far.bounds().min.x}, 500000.25);
}

TEST_F(LoadOffStl, TakesIntegersOfOffAsPartsOf255) {
    const auto red = [&](const std::string& colour, const Lines& warnings = {}) {
        const Scene scene = off("COFF\n2 0 0\n0 0 0 " + colour + "\n5 0 0 0 0 0\n");
        EXPECT_EQ(scene.warnings, warnings) << colour;
        return image::srgbOf(scene.points.colors.at(0).r);
    };
    const float part = 1.0F / 255.0F;
    EXPECT_NEAR(red("1 0 0 255"), part, 1e-6F) << "alpha tells it";
    EXPECT_NEAR(red("1 0 2"), part, 1e-6F);
    EXPECT_NEAR(red("1 0 0 2", {"left out: the alpha of a vertex's colour"}), part, 1e-6F);
    EXPECT_NEAR(red("255 0 0 1", {"left out: the alpha of a vertex's colour"}), 1.0F, 1e-6F);
    for (const char* points : {"1.0 0 0", "1 0 0 1.0", "1e0 0 0", "1 .5 0 1"}) {
        EXPECT_NEAR(red(points), 1.0F, 1e-6F) << points;
    }
    EXPECT_NEAR(red("1.001 0.5 0", {"vertex colours up to 1.001 are taken as parts of 1"}), 1.0F,
                2e-3F);
    EXPECT_NEAR(red("0.5 0 0 255", {"vertex colours up to 0.5 are taken as parts of 255"}),
                0.5F * part, 1e-6F);
    const Lines either{
        "vertex colours of 0 and 1, without a point, are taken as parts of 1, not of 255"};
    EXPECT_NEAR(red("1 0 0", either), 1.0F, 1e-6F);
    EXPECT_NEAR(red("1 0 0 1", either), 1.0F, 1e-6F);
    EXPECT_EQ(red("0 0 0 1"), 0.0F);
}

TEST_F(LoadOffStl, SaysWhatIsLeftOutOfOff) {
    EXPECT_EQ(
        off("COFF\n4 3 0\n0 0 0 1 1 1 0.5\n1 0 0 1 1 1 1 7 7\n0 1 0 1 1 1 1\n"
            "9 9 9 1 1 1 1\n3 0 1 2 255 0 0\n2 0 1\n3 2 1 0\n")
            .warnings,
        (Lines{"left out: a face of fewer than 3 corners",
               "left out: a number behind a vertex (2 times)",
               "left out: a vertex that no face uses", "left out: the alpha of a vertex's colour",
               "left out: the colour of a face"}));
}

TEST_F(LoadOffStl, RefusesBrokenOff) {
    EXPECT_EQ(offError("OFF BINARY\n"), "DIR/a.off:1: binary OFF is not read; text is");
    EXPECT_EQ(offError("4OFF\n1 0 0\n"),
              "DIR/a.off:1: '4OFF' is not read; OFF is, with ST, C and N before it");
    EXPECT_EQ(offError("OFF\n0 0 0\n"), "DIR/a.off:2: no vertices");
    EXPECT_EQ(offError("OFF\n-1 0 0\n"),
              "DIR/a.off:2: '-1' is no count of vertices; 0 to 4294967294 are allowed");
    EXPECT_EQ(offError("OFF\n4000000000 1 0\n0 0 0\n"), "DIR/a.off:4: the file ends early");
    const std::string triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(offError(triangle + "3 0 1 3\n"),
              "DIR/a.off:6: '3' is no vertex of the file; 0 to 2 are allowed");
    EXPECT_EQ(offError(triangle + "4 0 1 2\n"), "DIR/a.off:6: the face lacks corners");
    EXPECT_EQ(offError("OFF\n1 0 0\n0 nan 0\n"), "DIR/a.off:3: 'nan' is not a finite number");
    EXPECT_EQ(offError("OFF\n1 0 0\n0 0\n"), "DIR/a.off:3: the line lacks a number");
    EXPECT_EQ(offError("OFF\n1 0 0\n0 0 2e9\n"),
              "DIR/a.off:3: a coordinate is 2e+09; -1e+09 to 1e+09 are allowed");
}

constexpr const char* kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e0 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\n";

/// `facets` of that corner, with attributes.
std::string binaryStl(std::uint32_t facets, const std::string& head = "solid, says its exporter",
                      const std::string& attribute = "\x1f\0"s) {
    std::string bytes = head;
    bytes.resize(80, ' ');
    bytes.append(reinterpret_cast<const char*>(&facets), 4);
    const float facet[] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (std::uint32_t i = 0; i < facets; ++i) {
        bytes.append(reinterpret_cast<const char*>(facet), sizeof(facet));
        bytes += i == 0 ? "\0\0"s : attribute;
    }
    return bytes;
}

TEST_F(LoadOffStl, ReadsBothFormsOfStl) {
    const std::string two =
        fmt::format("solid a name\n{}endsolid\nsolid\n{}endsolid a\n", kFacet, kFacet);
    std::string upper = two;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string oneLine = two;
    std::ranges::replace(oneLine, '\n', ' ');
    for (const std::string& text : {two, upper, oneLine, binaryStl(2), binaryStl(2, "")}) {
        const Scene scene = stl(text);
        const Mesh& mesh = scene.meshes.at(0);
        EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}}));
        EXPECT_EQ(mesh.positions.at(4), glm::vec3(1, 0, 0));
        EXPECT_TRUE(mesh.normals.empty());
    }
    EXPECT_EQ(stl(two).warnings, Lines{});
    const std::string named = "solid facet normal 0 0 1\n" + std::string(kFacet);
    EXPECT_EQ(stl(named + "endsolid facet normal 0 0 1\n").triangleCount(), 1U);
    EXPECT_EQ(stl(binaryStl(2) + "12").triangleCount(), 2U);
}

TEST_F(LoadOffStl, SaysWhatIsLeftOutOfStl) {
    EXPECT_EQ(stl(binaryStl(3, "by x") + "12").warnings,
              (Lines{"left out: a byte behind the facets (2 times)",
                     "left out: the attribute of a facet (2 times)"}));
}

TEST_F(LoadOffStl, RefusesBrokenStl) {
    EXPECT_EQ(stlError("solid\nendsolid\n"), "DIR/a.STL: no facets");
    EXPECT_EQ(stlError("solid a facet endsolid"), "DIR/a.STL:2: the file ends without 'endsolid'");
    EXPECT_EQ(stlError(binaryStl(0, "")), "DIR/a.STL: no facets");
    EXPECT_EQ(stlError(binaryStl(2, "").substr(0, 150)),
              "DIR/a.STL: has 150 bytes; a binary STL file of its 2 facets has 184, one in text "
              "begins with 'solid'");
    EXPECT_EQ(stlError("short"),
              "DIR/a.STL: has 5 bytes; a binary STL file of its 0 facets has 84, one in text "
              "begins with 'solid'");
    EXPECT_EQ(stlError("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n"),
              "DIR/a.STL:5: a facet of 1 corners; 3 are allowed");
    EXPECT_EQ(stlError("solid\nvertex 0 0\n"), "DIR/a.STL:2: the line lacks a number");
    EXPECT_EQ(stlError("solid\nvertex 0 0 1e10\n"),
              "DIR/a.STL:2: a coordinate is 1e+10; -1e+09 to 1e+09 are allowed");
    EXPECT_EQ(stlError("solid\nvertex 0 0 1\n"), "DIR/a.STL:3: the file ends within a facet");
    EXPECT_THAT(stlError(fmt::format("solid\n{}", kFacet)),
                HasSubstr(": the file ends without 'endsolid'"))
        << "cut between two facets";
    EXPECT_EQ(stlError("solid\nfacets\n"),
              "DIR/a.STL:2: 'facets' is unknown; solid, facet normal, outer loop, vertex, endloop, "
              "endfacet and endsolid are allowed");
    std::string infinite = binaryStl(1, "");
    const float huge = 1e30F;
    std::memcpy(infinite.data() + 84 + 12, &huge, sizeof(huge));
    EXPECT_EQ(stlError(infinite),
              "DIR/a.STL: facet 0: a coordinate is 1e+30; -1e+09 to 1e+09 are allowed");
}

}  // namespace
}  // namespace gfxrepro::scene
