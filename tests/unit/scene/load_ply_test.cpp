
#include <cstring>
#include <limits>
#include <string>

#include "engine/scene/load.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

struct LoadPly : FolderTest {
    Scene load(const std::string& content) { return loadPly(folder.write("a.ply", content)); }
    std::string error(const std::string& content) {
        const auto path = folder.write("a.ply", content);
        return errorText([&] { loadPly(path); }, folder.path());
    }
};

const std::string kAscii =
    "ply\nformat ascii 1.0\ncomment a square\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

/// Bytes of numbers, in the other order where `isSwapped`.
template <class T>
std::string bytes(T value, bool isSwapped) {
    std::string text(reinterpret_cast<const char*>(&value), sizeof(T));
    return isSwapped ? std::string(text.rbegin(), text.rend()) : text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    return at == std::string::npos ? "NOT FOUND" : text.replace(at, from.size(), to);
}

TEST_F(LoadPly, FansPolygons) {
    const Scene scene = load(kAscii);
    ASSERT_EQ(scene.meshes.size(), 1U);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(scene.instances.size(), 1U);
}

TEST_F(LoadPly, ReadsWindowsLineEnds) {
    std::string content;
    for (const char c : kAscii) content += c == '\n' ? "\r\n" : std::string(1, c);
    EXPECT_EQ(load(content).triangleCount(), 2U);
}

TEST_F(LoadPly, ReadsBothEndiannessesAndSkipsWhatIsUnknown) {
    for (const bool isBig : {false, true}) {
        std::string content = "ply\nformat binary_" + std::string(isBig ? "big" : "little") +
                              "_endian 1.0\n"
                              "element camera 1\nproperty list ushort double knots\n"
                              "element face 1\nproperty uchar flags\n"
                              "property list uint ushort vertex_index\n"
                              "element vertex 3\nproperty double z\nproperty short quality\n"
                              "property float x\nproperty list uchar char tags\nproperty short y\n"
                              "end_header\n";
        content += bytes(std::uint16_t{2}, isBig) + bytes(1.0, isBig) + bytes(2.0, isBig);
        content += '\7' + bytes(std::uint32_t{3}, isBig);
        for (std::uint16_t i = 0; i < 3; ++i) content += bytes(i, isBig);
        for (int i = 0; i < 3; ++i) {
            content += bytes(0.5 + i, isBig) + bytes(std::int16_t{9}, isBig) +
                       bytes(static_cast<float>(i), isBig) + "\2zz" +
                       bytes(static_cast<std::int16_t>(-300 * i), isBig);
        }
        const Scene scene = load(content);
        ASSERT_EQ(scene.meshes.size(), 1U);
        EXPECT_EQ(scene.meshes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
        EXPECT_EQ(scene.meshes[0].positions,
                  (std::vector<glm::vec3>{{0, 0, 0.5}, {1, -300, 1.5}, {2, -600, 2.5}}));
    }
}

TEST_F(LoadPly, ReadsPointsWithAttributes) {
    const Scene scene = load(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float radius\n"
        "end_header\n0 0 0 0 0 2 255 0 188 0.5\n1 2 3 nan nan nan 0 255 0 0.25");
    EXPECT_TRUE(scene.meshes.empty());
    EXPECT_EQ(scene.points.positions[1], glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.points.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(scene.points.normals[1], glm::vec3(0));
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"left out: a normal that is not finite"});
    EXPECT_EQ(scene.points.radii, (std::vector<float>{0.5F, 0.25F}));
    EXPECT_EQ(scene.points.colors[0].r, 1.0F);
    EXPECT_NEAR(scene.points.colors[0].b, 0.5029F, 1e-4F);  // 188/255 in sRGB
}

TEST_F(LoadPly, ReadsColoursByTheirTypeAndTexcoords) {
    for (const char* names : {"u v", "s t", "texture_u texture_v"}) {
        const std::string u(names, std::strchr(names, ' '));
        const std::string v(std::strchr(names, ' ') + 1);
        std::string content = replaced(
            kAscii, "property float z\n",
            "property float z\nproperty ushort red\nproperty float green\nproperty float blue\n"
            "property float " +
                u + "\nproperty float " + v + "\n");
        content =
            replaced(content, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n",
                     "0 0 0 65535 .25 1 .5 1\n1 0 0 0 0 0 0 0\n1 1 0 0 0 0 0 0\n0 1 0 0 0 0 0 0\n");
        const Mesh mesh = load(content).meshes.at(0);
        EXPECT_EQ(mesh.colors[0].r, 1.0F);
        EXPECT_NEAR(mesh.colors[0].g, 0.0509F, 1e-4F);  // 0.25 in sRGB
        EXPECT_EQ(mesh.texcoords[0], glm::vec2(0.5F, 1));
    }
}

TEST_F(LoadPly, TakesColoursAsADisplayShowsThem) {
    std::vector<std::string> warnings;
    const auto red = [&](const std::string& type, const std::string& names,
                         const std::string& value) {
        std::string content = kAscii;
        for (const char* channel : {"blue", "green", "red"}) {
            const std::string name = names == "r" ? std::string(1, *channel) : names + channel;
            content =
                replaced(content, "float z\n", "float z\nproperty " + type + ' ' + name + '\n');
        }
        for (const char* place : {"0 0 0\n", "1 0 0\n", "1 1 0\n", "0 1 0\n"}) {
            const std::string line(place, 5);
            content = replaced(content, "\n" + line + '\n', "\n" + line + ' ' + value + " 0 0\n");
        }
        const Scene scene = load(content);
        warnings = scene.warnings;
        return scene.meshes.at(0).colors.at(0).r;
    };
    EXPECT_NEAR(red("uchar", "", "128"), 0.2159F, 1e-4F);
    EXPECT_NEAR(red("float", "", "128"), 0.2159F, 1e-4F);
    EXPECT_NEAR(red("float", "", "0.501961"), 0.2159F, 1e-4F);
    EXPECT_NEAR(red("ushort", "", "32896"), 0.2159F, 1e-4F);
    EXPECT_NEAR(red("uchar", "diffuse_", "128"), 0.2159F, 1e-4F);
    EXPECT_NEAR(red("uchar", "r", "128"), 0.2159F, 1e-4F);
    EXPECT_EQ(warnings, std::vector<std::string>{});
    EXPECT_NEAR(red("float", "", "1.001"), 1.00228F, 1e-4F);
    // Integers of more bytes that hold one, or two.
    for (const char* type : {"int", "uint", "ushort", "short"}) {
        EXPECT_NEAR(red(type, "", "128"), 0.2159F, 1e-4F) << type;
        EXPECT_EQ(warnings, std::vector<std::string>{
                                "vertex colours, integers up to 128, are taken as parts of 255"});
    }
    EXPECT_NEAR(red("int", "", "32896"), 0.2159F, 1e-4F);
    EXPECT_NEAR(red("uint", "", "2155905152"), 0.2159F, 1e-4F);
    EXPECT_EQ(warnings, std::vector<std::string>{});
    EXPECT_NEAR(red("ushort", "", "65535"), 1.0F, 1e-6F);
    EXPECT_EQ(warnings, std::vector<std::string>{});
}

TEST_F(LoadPly, DropsVerticesThatNoFaceUses) {
    std::string content = replaced(kAscii, "element vertex 4", "element vertex 6");
    content = replaced(content, "0 0 0\n1 0 0", "9 9 9\n0 0 0\n1 0 0");
    content = replaced(content, "4 0 1 2 3", "1000 1000 1000\n4 1 2 3 4");
    const Scene scene = load(content);
    EXPECT_EQ(scene.bounds().max, glm::vec3(1, 1, 0));
    EXPECT_EQ(scene.vertexCount(), 4U);
    EXPECT_EQ(scene.meshes.at(0).triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(scene.warnings,
              std::vector<std::string>{"left out: a vertex that no face uses (2 times)"});
}

TEST_F(LoadPly, FillsConcavePolygons) {
    std::string content = replaced(kAscii, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3",
                                   "2 0 0\n1 .5 0\n0 0 0\n1 2 0\n4 0 1 2 3");
    EXPECT_EQ(load(content).meshes.at(0).triangles, (std::vector<glm::uvec3>{{3, 0, 1}, {3, 1, 2}}))
        << "the diagonal from 0 to 2 lies outside";
}

TEST_F(LoadPly, ReadsEveryElementThatHasFaces) {
    const std::string content =
        replaced(replaced(kAscii, "end_header",
                          "element triangle 1\nproperty list uchar int vertex_indices\nend_header"),
                 "4 0 1 2 3", "3 0 1 2\n3 0 2 3");
    EXPECT_EQ(load(content).triangleCount(), 2U);
}

TEST_F(LoadPly, SkipsAByteOrderMark) {
    EXPECT_EQ(load("\xEF\xBB\xBF" + kAscii).triangleCount(), 2U);
}

TEST_F(LoadPly, ReadsStrips) {
    const std::string content = replaced(replaced(kAscii, "element face 1", "element tristrips 1"),
                                         "4 0 1 2 3", "8 0 1 2 3 -1 3 2 1");
    EXPECT_EQ(load(content).meshes.at(0).triangles,
              (std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}, {3, 2, 1}}));
}

TEST_F(LoadPly, ReadsNumbersAtTheEdgesOfTheirRange) {
    const Mesh mesh = load(replaced(kAscii, "0 0 0\n", "1e-60 +0.5 -1e9\n")).meshes.at(0);
    EXPECT_EQ(mesh.positions[0], glm::vec3(0, 0.5F, -1e9F));
}

TEST_F(LoadPly, SaysWhereAHeaderIsWrong) {
    EXPECT_EQ(error(""), "DIR/a.ply:1: the file ends before 'end_header'");
    EXPECT_EQ(error("solid\n"), "DIR/a.ply:1: a PLY file begins with the line 'ply'");
    EXPECT_EQ(error("ply\nformat ascii 2.0\n"),
              "DIR/a.ply:2: the format line must be 'format ascii 1.0', 'format "
              "binary_little_endian 1.0' or 'format binary_big_endian 1.0'");
    EXPECT_EQ(error(replaced(kAscii, "float x", "long x")),
              "DIR/a.ply:5: 'long' is not a type; char, uchar, short, ushort, int, uint, float and "
              "double are");
    EXPECT_EQ(error(replaced(kAscii, "vertex 4", "vertex -4")),
              "DIR/a.ply:4: '-4' is not a count of elements");
    EXPECT_EQ(error(replaced(kAscii, "element face", "element vertex")),
              "DIR/a.ply:8: element 'vertex' is declared twice");
    EXPECT_EQ(error(replaced(kAscii, "list uchar", "list float")),
              "DIR/a.ply:9: a list is counted in integers, not in float");
    EXPECT_EQ(error(replaced(kAscii, "comment", "komment")),
              "DIR/a.ply:3: 'komment' is unknown; comment, obj_info, element, property and "
              "end_header are allowed");
    EXPECT_EQ(error(replaced(kAscii, "property float x\n", "")),
              "DIR/a.ply:4: element 'vertex' lacks x, y or z");
    EXPECT_EQ(error(replaced(kAscii, "vertex_indices", "corners")),
              "DIR/a.ply:8: element 'face' lacks the list vertex_indices");
    EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n"),
              "DIR/a.ply: no vertices");
}

TEST_F(LoadPly, RefusesCountsBeyondTheFile) {
    EXPECT_EQ(error(replaced(kAscii, "vertex 4", "vertex 4000000000")),
              "DIR/a.ply:4: 4000000000 rows of element 'vertex' do not fit into the file");
    EXPECT_EQ(error(replaced(kAscii, "vertex 4", "vertex 18446744073709551615")),
              "DIR/a.ply:4: 18446744073709551615 vertices; at most 4294967295 are allowed");
    EXPECT_EQ(error(replaced(kAscii, "face 1", "face 900000000000")),
              "DIR/a.ply:8: 900000000000 rows of element 'face' do not fit into the file");
    EXPECT_EQ(error(replaced(kAscii, "\n4 0 1 2 3", "\n200 0 1 2 3")),
              "DIR/a.ply:15: face 0: a list of 200 indices does not fit into the file");
}

TEST_F(LoadPly, SaysWhereARowIsWrong) {
    EXPECT_EQ(error(replaced(kAscii, "1 1 0", "1 nan 0")),
              "DIR/a.ply:13: vertex 2: y is nan; finite numbers in the range of float are allowed");
    EXPECT_EQ(error(replaced(kAscii, "1 1 0", "1 1e39 0")),
              "DIR/a.ply:13: vertex 2: y is inf; finite numbers in the range of float are allowed");
    EXPECT_EQ(error(replaced(kAscii, "1 1 0", "1 -3e38 0")),
              "DIR/a.ply:13: vertex 2: y is -3e+38; -1e+09 to 1e+09 are allowed");
    EXPECT_EQ(error(replaced(kAscii, "1 1 0", "1 one 0")),
              "DIR/a.ply:13: vertex 2: 'one' is not a number of type float");
    EXPECT_EQ(error(replaced(kAscii, "4 0 1 2 3", "300 0 1 2 3")),
              "DIR/a.ply:15: face 0: 300 does not fit into uchar");
    EXPECT_EQ(error(replaced(kAscii, "4 0 1 2 3", "4 0 1 2 4")),
              "DIR/a.ply:15: face 0: index 4 is not one of the 4 vertices");
    EXPECT_EQ(
        error(replaced(replaced(kAscii, "uchar int", "uchar float"), "4 0 1 2 3", "4 0 1.5 2 3")),
        "DIR/a.ply:15: face 0: index 1.5 is not one of the 4 vertices");
    EXPECT_EQ(error(replaced(kAscii, "4 0 1 2 3", "4 0 1 2 -1")),
              "DIR/a.ply:15: face 0: index -1 is not one of the 4 vertices");
    EXPECT_EQ(error(replaced(kAscii, "4 0 1 2 3\n", "4 0 1 2")),
              "DIR/a.ply:15: face 0: a list of 4 indices does not fit into the file");
    EXPECT_EQ(error(replaced(replaced(kAscii, "uchar int", "char int"), "4 0 1 2 3", "-4 0 1 2 3")),
              "DIR/a.ply:15: face 0: a list of -4 indices does not fit into the file");
}

TEST_F(LoadPly, GivesTheByteOfBinaryErrors) {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
        "property float y\nproperty float z\nend_header\n";
    const std::string x = bytes(1.0F, false);
    EXPECT_EQ(error(header + x + bytes(std::numeric_limits<float>::infinity(), false) + x),
              "DIR/a.ply: byte " + std::to_string(header.size() + 8) +
                  ": vertex 0: y is inf; finite numbers in the range of float are allowed");
    EXPECT_EQ(error(header + x + x + bytes(3e38F, false)),
              "DIR/a.ply: byte " + std::to_string(header.size() + 12) +
                  ": vertex 0: z is 3e+38; -1e+09 to 1e+09 are allowed");
    EXPECT_EQ(error(header + x + x),
              "DIR/a.ply:3: 1 rows of element 'vertex' do not fit into the file");
}

/// Looked up by name, these took minutes.
TEST_F(LoadPly, AHeaderOfManyElementsIsReadAtOnce) {
    std::string header = "ply\nformat ascii 1.0\n";
    constexpr int kCount = 300'000;
    for (int i = 0; i < kCount; ++i) header += "element e" + std::to_string(i) + " 0\n";
    EXPECT_EQ(error(header + "element e7 0\nend_header\n"),
              "DIR/a.ply:" + std::to_string(kCount + 3) + ": element 'e7' is declared twice");
}

TEST_F(LoadPly, AFileOfZerosHasItsErrorSoonAndInALine) {
    const auto errorOf = [&](const std::string& head, std::uintmax_t bytes) {
        const auto path = folder.write("a.ply", head);
        fs::resize_file(path, bytes);  // nearly all of it a hole
        return errorText([&] { loadPly(path); }, folder.path());
    };
    EXPECT_EQ(errorOf("ply\nformat ascii 1.0\ncomment ", 100'000'000),
              "DIR/a.ply:3: a line of 99999979 bytes; a header's have at most 65536");
    const std::string head = kAscii.substr(0, kAscii.find("0 0 0\n"));
    const std::string zeros(100, '?');
    EXPECT_EQ(errorOf(head, 100'000'000), "DIR/a.ply:11: vertex 0: '" + zeros + "…' (" +
                                              std::to_string(100'000'000 - head.size()) +
                                              " bytes) is not a number of type float");
}

}  // namespace
}  // namespace gfxrepro::scene
