// Coordinates far from the origin, as surveys have them.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

/// 400 points 2 cm apart, at 500 000, 4 500 000.
std::string points(const char* type) {
    std::string content = "ply\nformat ascii 1.0\nelement vertex 400\n";
    for (const char* axis : {"x", "y", "z"}) content += fmt::format("property {} {}\n", type, axis);
    content += "end_header\n";
    for (int i = 0; i < 400; ++i) {
        content += fmt::format("{:.3f} {:.3f} 10\n", 500'000 + 0.02 * (i % 20),
                               4'500'000 + 0.02 * (i / 20));
    }
    return content;
}

std::size_t differentPoints(const std::vector<glm::vec3>& positions) {
    std::set<std::pair<float, float>> different;
    for (const glm::vec3& p : positions) different.emplace(p.x, p.y);
    return different.size();
}

using FarFiles = FolderTest;

TEST_F(FarFiles, PointsKeepTheirPlaces) {
    for (const char* type : {"double", "float"}) {  // text has the digits, whatever it declares
        const Scene scene = loadPly(folder.write("a.ply", points(type)));
        EXPECT_EQ(differentPoints(scene.points.positions), 400U) << type;
        EXPECT_LT(glm::length(scene.bounds().size() - glm::vec3(0.38F, 0.38F, 0)), 1e-5F);
        const glm::dvec3 first = glm::dvec3(scene.points.positions[0]) + scene.offset;
        EXPECT_LT(glm::length(first - glm::dvec3(500'000, 4'500'000, 10)), 1e-6);
        ASSERT_EQ(scene.warnings.size(), 1U);
        EXPECT_THAT(scene.warnings[0], StartsWith("its coordinates lie far from the origin: ("));
    }
}

TEST_F(FarFiles, FacesKeepTheirShape) {
    const Scene scene =
        loadObj(folder.write("a.obj",
                             "v 0 0 0\nv 500000.12 4500000.12 10\nv 500000.22 4500000.12 10\n"
                             "v 500000.22 4500000.22 10\nv 500000.12 4500000.22 10\nf 2 3 4 5\n"));
    EXPECT_LT(glm::length(scene.bounds().size() - glm::vec3(0.1F, 0.1F, 0)), 1e-6F);
    EXPECT_EQ(scene.triangleCount(), 2U);
}

TEST_F(FarFiles, NodesFarAwayKeepTheirDistance) {
    folder.write("square.bin", squareBytes());
    Document document = square();
    document["nodes"] = R"([{"children":[1,2],"translation":[500000,4500000,0]},
        {"mesh":0,"translation":[0.12,0.1,0]},{"mesh":0,"translation":[0.14,0.1,0]}])";
    const Scene scene = loadGltf(folder.write("a.gltf", text(document)));
    ASSERT_EQ(scene.instances.size(), 2U);
    const glm::vec3 apart(scene.instances[1].worldFromMesh[3] -
                          scene.instances[0].worldFromMesh[3]);
    EXPECT_LT(glm::length(apart - glm::vec3(0.02F, 0, 0)), 1e-6F);
    EXPECT_EQ(scene.offset, glm::dvec3(500'001, 4'500'001, 0));
}

/// Vertices 0.01 mm apart in a mesh that its node puts 2000 m away, where a float's step is 0.12
/// mm.
TEST_F(FarFiles, VerticesThatANodeWouldJoinKeepTheirPlaces) {
    folder.write("square.bin", squareBytes());
    const auto at = [&](const char* scale) {
        Document document = square();
        document["nodes"] = fmt::format(
            R"([{{"translation":[2000,0,0],"children":[1,2]}},{{"mesh":0,"scale":[{},1,1]}},
                {{"mesh":0,"translation":[3,0,0]}}])",
            scale);
        document["scenes"] = R"([{"nodes":[0]}])";
        return loadGltf(folder.write("a.gltf", text(document)));
    };
    const auto width = [](const Scene& scene) {
        const glm::mat4& m = scene.instances.at(0).worldFromMesh;
        return (m * glm::vec4(1, 0, 0, 1)).x - (m * glm::vec4(0, 0, 0, 1)).x;
    };
    const Scene fine = at("0.00001");
    EXPECT_NEAR(width(fine), 1e-5F, 3e-7F);
    EXPECT_EQ(fine.offset, glm::dvec3(2002, 0, 0));
    EXPECT_EQ(fine.warnings.size(), 1U);
    const Scene coarse = at("0.5");
    EXPECT_EQ(coarse.offset, glm::dvec3(0.0));
    EXPECT_TRUE(coarse.warnings.empty());
}

TEST_F(FarFiles, OthersStayAsTheyAre) {
    // A knob of 1 cm among the files of a room.
    const std::string face = "\nv 20.01 0 0\nv 20 0.01 0\nf 1 2 3\n";
    EXPECT_EQ(loadObj(folder.write("a.obj", "v 20 0 0" + face)).offset, glm::dvec3(0.0));
    EXPECT_EQ(loadObj(folder.write("a.obj", "v 500000 1 2")).points.positions.at(0),
              glm::vec3(500'000, 1, 2))
        << "one point";
}

TEST_F(FarFiles, PointsThatFloatsWouldJoinKeepTheirPlaces) {
    const auto metre = [&](const char* type, int count) {  // of 4000 m along x
        std::string content = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", count + 1);
        for (const char* axis : {"x", "y", "z"}) {
            content += fmt::format("property {} {}\n", type, axis);
        }
        content += "end_header\n";
        for (int i = 0; i <= count; ++i)
            content += fmt::format("{:.4f} 0 0\n", 4000 + 1.0 * i / count);
        return loadPly(folder.write("a.ply", content));
    };
    for (const char* type : {"double", "float"}) {
        const Scene scene = metre(type, 10'000);  // a float's step there: 0.24 mm
        EXPECT_EQ(differentPoints(scene.points.positions), 10'001U) << type;
        EXPECT_NEAR(scene.offset.x + double{scene.points.positions[1].x}, 4000.0001, 1e-7);
        EXPECT_EQ(scene.warnings.size(), 1U);
        const Scene coarse = metre(type, 8);
        EXPECT_EQ(coarse.offset, glm::dvec3(0.0)) << type;
        EXPECT_EQ(coarse.points.positions[1], glm::vec3(4000.125F, 0, 0));
        EXPECT_TRUE(coarse.warnings.empty());
    }
}

/// Between two vertices or points that are not at one place.
float leastDistance(const Scene& scene) {
    const std::vector<glm::vec3> places =
        scene.points.positions.empty() ? flattened(scene).positions : scene.points.positions;
    float least = std::numeric_limits<float>::infinity();
    for (const glm::vec3& a : places) {
        for (const glm::vec3& b : places) {
            if (a != b) least = std::min(least, glm::length(a - b));
        }
    }
    return least;
}

/// What lies together keeps its shape, wherever a stray vertex is.
TEST_F(FarFiles, StrayVerticesDecideNothing) {
    for (const char* stray : {"0 0 0", "600000 4400000 10"}) {
        std::string cloud = points("double") + stray + "\n";
        cloud.replace(cloud.find("400"), 3, "401");
        const Scene scene = loadPly(folder.write("a.ply", cloud));
        EXPECT_EQ(differentPoints(scene.points.positions), 401U) << stray;
        EXPECT_NEAR(leastDistance(scene), 0.02F, 1e-6F) << stray;
        const glm::dvec3 first = glm::dvec3(scene.points.positions[0]) + scene.offset;
        EXPECT_LT(glm::length(first - glm::dvec3(500'000, 4'500'000, 10)), 1e-6);

        const std::string a = "500000.12 4500000.12 10", b = "500000.22 4500000.12 10",
                          c = "500000.22 4500000.22 10", d = "500000.12 4500000.22 10";
        const auto facet = [](const std::string& p, const std::string& q, const std::string& r) {
            return "facet normal 0 0 1\nouter loop\nvertex " + p + "\nvertex " + q + "\nvertex " +
                   r + "\nendloop\nendfacet\n";
        };
        const std::pair<const char*, std::string> files[] = {
            {"a.obj", "v " + a + "\nv " + b + "\nv " + c + "\nv " + d + "\nv " + stray +
                          "\nf 1 2 3 4\nf 1 4 5\n"},
            {"a.off", "OFF\n5 2 0\n" + a + '\n' + b + '\n' + c + '\n' + d + '\n' + stray +
                          "\n4 0 1 2 3\n3 0 3 4\n"},
            {"a.stl",
             "solid a\n" + facet(a, b, c) + facet(a, c, d) + facet(a, d, stray) + "endsolid a\n"},
        };
        for (const auto& [name, content] : files) {
            const Scene model = loadScene(folder.write(name, content));
            EXPECT_NEAR(leastDistance(model), 0.1F, 1e-6F) << name << ' ' << stray;
        }
    }
    folder.write("square.bin", squareBytes());
    Document document = square();
    document["nodes"] = R"([{"children":[1,2],"translation":[500000,4500000,0]},
        {"mesh":0,"translation":[0.12,0.1,0]},{"mesh":0,"translation":[0.14,0.1,0]},{"mesh":0}])";
    document["scenes"] = R"([{"nodes":[0,3]}])";
    const Scene scene = loadGltf(folder.write("a.gltf", text(document)));
    EXPECT_NEAR(leastDistance(scene), 0.02F, 1e-6F);
}

/// More than half of the corners share each coordinate.
TEST_F(FarFiles, CornersThatShareCoordinatesKeepTheirPlaces) {
    const auto expectSides = [&](const std::string& content, float sideM, const char* why) {
        const Scene scene = loadObj(folder.write("a.obj", content));
        EXPECT_EQ(scene.warnings.size(), 1U) << why;
        const glm::vec3 size = scene.bounds().size();
        EXPECT_NEAR(size.x, sideM, 1e-5F * sideM) << why;
        EXPECT_NEAR(size.y, sideM, 1e-5F * sideM) << why;
    };
    const std::string corner = "v 500000.1 4500000.1 0\n";
    const std::string two = "v 500000.7 4500000.1 0\nv 500000.1 4500000.7 0\n";
    expectSides(corner + two + "f 1 2 3\n", 0.6F, "triangle");
    expectSides(corner + two + "v 500000.1 4500000.1 0.6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
                0.6F, "tetrahedron");
    expectSides(corner + "v 500010.7 4500000.1 0\nv 500000.1 4500010.7 0\nf 1 2 3\n", 10.6F,
                "larger");
    expectSides(
        "v 5000.0001 3000.0001 0\nv 5000.0003 3000.0001 0\nv 5000.0001 3000.0003 0\n"
        "f 1 2 3\n",
        0.0002F, "smaller");
}

/// Half of a room's vertices in a knob of 1 mm: files that belong together keep their places.
TEST_F(FarFiles, FinePartsOfARoomMoveNothing) {
    std::string content = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 3\n";
    for (int i = 0; i < 6; ++i) content += fmt::format("v 5 5.{:04} 1\n", i);
    const Scene scene = loadObj(folder.write("a.obj", content));
    EXPECT_EQ(scene.offset, glm::dvec3(0.0));
    EXPECT_TRUE(scene.warnings.empty());
}

/// Of 800 km, so that floats have steps of 3 cm at both ends: no offset helps.
TEST_F(FarFiles, VerticesThatFallTogetherAreCounted) {
    const auto warnings = [&](const char* name, const std::string& content) {
        return loadScene(folder.write(name, content)).warnings;
    };
    using Lines = std::vector<std::string>;
    const Lines two{
        "floats put 2 of its vertices where others are: it reaches to 400000, where their steps "
        "are 0.03125"};
    const std::vector<std::string> places{"-400000 0 0", "-400000.01 0 0", "-400000.5 0 0",
                                          "400000 0 0",  "400000.01 0 0",  "400000.5 0 0",
                                          "-400000 0 0", "400000 0 0"};
    std::string obj, rows, stl = "solid\n";
    for (const std::string& place : places) {
        obj += "v " + place + '\n';
        rows += place + '\n';
    }
    EXPECT_EQ(warnings("a.obj", obj + "f 1 2 3\nf 4 5 6\nf 7 8 1\n"), two);
    EXPECT_EQ(warnings("a.off", "OFF 8 3 0\n" + rows + "3 0 1 2\n3 3 4 5\n3 6 7 0\n"), two);
    for (const char* type : {"float", "double"}) {
        const std::string head = fmt::format(
            "ply\nformat ascii 1.0\nelement vertex 8\nproperty {0} x\nproperty {0} y\n"
            "property {0} z\nend_header\n",
            type);
        EXPECT_EQ(warnings("a.ply", head + rows), two) << type;
    }
    for (std::size_t i : {0U, 3U}) {
        stl += "facet normal 0 0 1\nouter loop\n";
        for (std::size_t k = i; k < i + 3; ++k) stl += "vertex " + places[k] + '\n';
        stl += "endloop\nendfacet\n";
    }
    EXPECT_EQ(warnings("a.stl", stl + "endsolid\n"), two);
    folder.write("square.bin", squareBytes());
    Document document = square();
    document["nodes"] =
        R"([{"mesh":0,"translation":[-400000,0,0],"scale":[0.01,0.01,1]},
        {"mesh":0,"translation":[399999,0,0]}])";
    document["scenes"] = R"([{"nodes":[0,1]}])";
    EXPECT_EQ(warnings("a.gltf", text(document)), two) << "of one node";
    EXPECT_EQ(warnings("a.obj", "v -60000 0 0\nv 60000 0 0\nv 60000.001 0 0\nf 1 2 3\n"),
              Lines{"floats put 1 of its vertices where others are: it reaches to 60000, where "
                    "their steps are 0.00390625"})
        << "a triangle without one of its edges";
    for (const char* same : {"60000", "60000.00000000001"}) {
        const std::string third = fmt::format("v {} 0 1e-50\n", same);
        EXPECT_EQ(warnings("a.obj", "v -60000 0 0\nv 60000 0 0\n" + third + "f 1 2 3\n"), Lines{});
    }
    EXPECT_EQ(warnings("a.obj", "v -400000 0 0\nv 400000 0 0\nv 400000 0.01 0\nf 1 2 3\n"),
              Lines{});
}

TEST_F(FarFiles, ComeBackFromWhatIsSaved) {
    const Scene scene = loadPly(folder.write("a.ply", points("double")));
    savePly(folder.path() / "b.ply", scene);
    saveGlb(folder.path() / "b.glb", scene);
    for (const char* name : {"b.ply", "b.glb"}) {
        const Scene back = loadScene(folder.path() / name);
        ASSERT_EQ(back.points.positions.size(), 400U) << name;
        for (std::size_t i = 0; i < 400; i += 57) {
            EXPECT_LT(glm::length(glm::dvec3(back.points.positions[i]) + back.offset -
                                  glm::dvec3(scene.points.positions[i]) - scene.offset),
                      1e-6)
                << name;
        }
    }
}

}  // namespace
}  // namespace gfxrepro::scene
