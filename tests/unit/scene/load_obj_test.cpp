#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/image/png_io.h"
#include "engine/scene/load.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

using test::errorText;
using test::TemporaryFolder;

class LoadObj : public testing::Test {
  protected:
    Scene load(const std::string& content) { return loadObj(folder_.write("a.obj", content)); }
    std::string error(const std::string& content) {
        const auto path = folder_.write("a.obj", content);
        return errorText([&] { loadObj(path); }, folder_.path());
    }
    TemporaryFolder folder_;
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(LoadObj, KeepsTheVerticesOfPlainFiles) {
    const Scene scene = load(kSquare + "v 9 9 9\nf 4 3 2\nf 1 2 3 4\n");
    ASSERT_EQ(scene.meshes.size(), 1U);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions.size(), 5U);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{3, 2, 1}, {0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.material, -1);
    EXPECT_TRUE(scene.materials.empty());
}

TEST_F(LoadObj, SharesVerticesOfEqualTriples) {
    const Mesh mesh = load(kSquare +
                           "vt 0 0\nvt 1 0.25\nvn 0 0 2\n"
                           "f 1/1/1 2/2/1 3/1/1\nf -4/-2/-1 -2/1/1 4/2/1\n")
                          .meshes.at(0);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.texcoords[0], glm::vec2(0, 1));
    EXPECT_EQ(mesh.texcoords[1], glm::vec2(1, 0.75F));
    EXPECT_EQ(mesh.normals[3], glm::vec3(0, 0, 1));
}

TEST_F(LoadObj, DropsAttributesThatSomeCornersLack) {
    const Mesh mesh =
        load(kSquare + "vt 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1/1/1 3/1/1 4/1/1\n").meshes.at(0);
    EXPECT_EQ(mesh.positions.size(), 4U);
    EXPECT_TRUE(mesh.texcoords.empty());
    EXPECT_EQ(mesh.normals.size(), 4U);
}

TEST_F(LoadObj, ReadsColoursContinuationsAndComments) {
    const Mesh mesh = load(
                          "# colours\nv 0 0 0 1 0.5 0 # red\nv 1 0 0 \\\n 0 0 1\r\nv 1 1 0 0 0 "
                          "0\nf 1 \\\r\n2 3\n")
                          .meshes.at(0);
    EXPECT_EQ(mesh.colors, (std::vector<glm::vec3>{{1, 0.5F, 0}, {0, 0, 1}, {0, 0, 0}}));
    EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(LoadObj, SplitsByMaterial) {
    image::writePng(folder_.path() / "wood grain.png", image::Image8(2, 1, 1, 128));
    folder_.write("a.mtl",
                  "newmtl wood\nKd 1 0.5 0.25\nKe 2 0 0\nNs 0\nd 0.5\nNi 1.4\n"
                  "map_Kd wood grain.png\nnewmtl glass\nKd 1\nTr 0.9\nmap_Kd gone.png\n");
    const Scene scene = load("mtllib a.mtl\n" + kSquare +
                             "usemtl wood\nf 1 2 3\nusemtl glass\nf 1 3 4\nusemtl wood\nf 2 3 4\n");
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_EQ(scene.meshes[0].name, "wood");
    EXPECT_EQ(scene.meshes[0].triangles.size(), 2U);
    EXPECT_EQ(scene.meshes[1].positions.size(), 3U);
    EXPECT_EQ(scene.meshes[1].material, 1);
    const Material& wood = scene.materials.at(0);
    EXPECT_EQ(wood.baseColor, glm::vec4(1, 0.5F, 0.25F, 0.5F));
    EXPECT_EQ(wood.emissive, glm::vec3(2, 0, 0));
    EXPECT_EQ(wood.roughness, 1.0F);
    EXPECT_EQ(wood.indexOfRefraction, 1.4F);
    EXPECT_EQ(wood.baseColorTexture, 0);
    EXPECT_EQ(scene.textures.at(0), image::Image8(2, 1, 3, 128));
    EXPECT_NEAR(scene.materials.at(1).baseColor.a, 0.1F, 1e-6F);
    EXPECT_EQ(scene.materials.at(1).baseColorTexture, -1);
}

TEST_F(LoadObj, LivesWithoutItsMaterialFile) {
    const Scene scene = load("mtllib gone.mtl\nmtllib /etc/passwd\nmtllib ../x.mtl\n" + kSquare +
                             "usemtl wood\nf 1 2 3\n");
    EXPECT_EQ(scene.materials.at(0).name, "wood");
    EXPECT_EQ(scene.materials.at(0).baseColor, Material{}.baseColor);
    ASSERT_EQ(scene.warnings.size(), 3U);
    EXPECT_EQ(scene.warnings[0],
              "material file 'gone.mtl' is not beside the model: its materials are grey");
}

TEST_F(LoadObj, ReadsVerticesWithoutFacesAsPoints) {
    EXPECT_EQ(load(kSquare + "l 1 2\n").points.positions.size(), 4U);
    EXPECT_EQ(error("o nothing\n"), "DIR/a.obj: no vertices");
}

TEST_F(LoadObj, SaysWhereItIsWrong) {
    EXPECT_EQ(error("v 0 0\n"), "DIR/a.obj:1: the line lacks a number");
    EXPECT_EQ(error("v 0 \\\n0\n\nv 0 zero 0\n"), "DIR/a.obj:1: the line lacks a number");
    EXPECT_EQ(error("\nv 0 zero 0\n"), "DIR/a.obj:2: 'zero' is not a finite number");
    EXPECT_EQ(error("v 0 inf 0\n"), "DIR/a.obj:1: 'inf' is not a finite number");
    EXPECT_EQ(error("v 0 0 1e9\nv 0 -3e38 0\n"),
              "DIR/a.obj:2: a coordinate is -3e+38; -1e+09 to 1e+09 are allowed");
    EXPECT_EQ(error(kSquare + "f 1 2 5\n"),
              "DIR/a.obj:5: index 5 is not one of the 4 'v' lines so far");
    EXPECT_EQ(error(kSquare + "f 1 2 -5\n"),
              "DIR/a.obj:5: index -5 is not one of the 4 'v' lines so far");
    EXPECT_EQ(error(kSquare + "f 0 1 2\n"),
              "DIR/a.obj:5: index 0 is not one of the 4 'v' lines so far");
    EXPECT_EQ(error(kSquare + "f 1/1 2/1 3/1\n"),
              "DIR/a.obj:5: index 1 is not one of the 0 'vt' lines so far");
    EXPECT_EQ(error(kSquare + "f 1 2 x\n"),
              "DIR/a.obj:5: 'x' is not a corner; v, v/vt, v//vn and v/vt/vn are allowed");
    EXPECT_EQ(error(kSquare + "f 1 2 99999999999999999999\n"),
              "DIR/a.obj:5: '99999999999999999999' is not a corner; v, v/vt, v//vn and v/vt/vn are "
              "allowed");
    EXPECT_EQ(error(kSquare + "f 1 2\n"),
              "DIR/a.obj:5: a face of 2 corners; 3 or more are allowed");
}

TEST_F(LoadObj, AFileOfZerosHasItsErrorSoonAndInALine) {
    const auto errorOf = [&](const std::string& head, std::uintmax_t bytes) {
        const auto path = folder_.write("a.obj", head);
        std::filesystem::resize_file(path, bytes);  // nearly all of it a hole
        return errorText([&] { loadObj(path); }, folder_.path());
    };
    EXPECT_EQ(errorOf(kSquare + "usemtl ", 100'000'000),
              "DIR/a.obj:5: a line of " + std::to_string(100'000'000 - kSquare.size()) +
                  " bytes; at most 67108864 are read");
    const std::string zeros(100, '?');
    EXPECT_EQ(errorOf("v 0 ", 1'000'000),
              "DIR/a.obj:1: '" + zeros + "…' (999996 bytes) is not a finite number");
    EXPECT_EQ(errorOf(kSquare + "f 1 2 3/", 1'000'000),
              "DIR/a.obj:5: '3/" + zeros.substr(2) + "…' (" +
                  std::to_string(1'000'000 - kSquare.size() - 6) +
                  " bytes) is not a corner; v, v/vt, v//vn and v/vt/vn are allowed");
}

TEST_F(LoadObj, RefusesBrokenMaterialFilesAndTextures) {
    folder_.write("a.mtl", "newmtl a\nKd red\n");
    const std::string content = "mtllib a.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n";
    EXPECT_EQ(error(content), "DIR/a.mtl:2: 'red' is not a finite number");
    folder_.write("a.mtl", "newmtl a\nmap_Kd a.tga\n");
    folder_.write("a.tga", "something");
    EXPECT_EQ(error(content), "DIR/a.tga: neither a PNG nor a JPEG image");
}

}  // namespace
}  // namespace gfxrepro::scene
