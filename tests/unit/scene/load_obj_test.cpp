#include <fmt/format.h>

#include <string>

#include "engine/image/png_io.h"
#include "engine/scene/load.h"
#include "engine/scene/model_files.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

struct LoadObj : FolderTest {
    Scene load(const std::string& content) { return loadObj(folder.write("a.obj", content)); }
    std::string error(const std::string& content) {
        const auto path = folder.write("a.obj", content);
        return errorText([&] { loadObj(path); }, folder.path());
    }
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(LoadObj, KeepsTheVerticesOfPlainFiles) {
    const Scene scene = load(kSquare + "f 4 3 2\nf 1 2 3 4\n");
    ASSERT_EQ(scene.meshes.size(), 1U);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{3, 2, 1}, {0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(scene.warnings.empty());
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

TEST_F(LoadObj, DropsVerticesThatNoFaceUses) {
    for (const char* faces : {"f 2 3 4 5\n", "vn 0 0 1\nf 2//1 3//1 4//1 5//1\n"}) {
        const Scene scene = load("v 9 9 9\n" + kSquare + "v 1000 1000 1000\n" + faces);
        EXPECT_EQ(scene.bounds().max, glm::vec3(1, 1, 0));
        EXPECT_EQ(scene.vertexCount(), 4U);
        EXPECT_EQ(scene.warnings,
                  std::vector<std::string>{"left out: a vertex that no face uses (2 times)"});
    }
}

TEST_F(LoadObj, FillsConcavePolygons) {
    const Mesh mesh = load(
                          "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                          "f 3 4 5 6 1 2\n")
                          .meshes.at(0);
    float area = 0.0F;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 twice = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                           mesh.positions[t.z] - mesh.positions[t.x]);
        EXPECT_GE(twice.z, 0.0F) << "turned";
        area += 0.5F * glm::length(twice);
    }
    EXPECT_FLOAT_EQ(area, 3.0F);
    EXPECT_EQ(load("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n").warnings.size(), 1U);
}

TEST_F(LoadObj, KeepsAttributesOfTheTrianglesThatHaveThem) {
    const Scene scene = load(kSquare +
                             "v 2 0 0\nv 2 1 0\nvt 0 0\nvn 0 0 1\n"
                             "f 1/1/1 2/1/1 3/1/1 4/1/1\nf 2//1 5//1 6//1 3//1\n");
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_EQ(scene.meshes[0].texcoords.size(), 4U);
    EXPECT_EQ(scene.meshes[0].normals.size(), 4U);
    EXPECT_TRUE(scene.meshes[1].texcoords.empty());
    EXPECT_EQ(scene.meshes[1].normals.size(), 4U);
    EXPECT_EQ(scene.triangleCount(), 4U);
}

TEST_F(LoadObj, TakesColoursAsADisplayShowsThem) {
    const auto red = [&](const char* colour) {
        std::string content;
        for (const char* place : {"v 0 0 0 ", "v 1 0 0 ", "v 1 1 0 "}) {
            content += std::string(place) + colour + '\n';
        }
        return load(content + "f 1 2 3\n").meshes.at(0).colors.at(0).r;
    };
    EXPECT_NEAR(red("0.501961 0 0"), 0.2159F, 1e-4F);  // as PLY's byte 128
    EXPECT_NEAR(red("128 0 0"), 0.2159F, 1e-4F);
    EXPECT_EQ(red("255 0 0"), 1.0F);
    EXPECT_EQ(red("1 0 0"), 1.0F);
    EXPECT_NEAR(red("1.001 0.2 0"), 1.00228F, 1e-4F);  // one value that was rounded up
    EXPECT_NEAR(red("0.501961 1.001 0"), 0.2159F, 1e-4F);
    const auto warnings = [&](const std::string& colour) {
        return load("v 0 0 0 " + colour + "\nv 1 0 0 0 0 0\nv 1 1 0 0 0 0\nf 1 2 3\n").warnings;
    };
    using Lines = std::vector<std::string>;
    EXPECT_EQ(warnings("1 0.5 0"), Lines{});
    EXPECT_EQ(warnings("255 128 0"), Lines{});
    EXPECT_EQ(warnings("1.001 0 0"), Lines{"vertex colours up to 1.001 are taken as parts of 1"});
    EXPECT_EQ(warnings("127.5 0 0"), Lines{"vertex colours up to 127.5 are taken as parts of 255"});
}

TEST_F(LoadObj, ReadsNamesWithNumberSignsAndByteOrderMarks) {
    folder.write("a.mtl", "\xEF\xBB\xBFnewmtl skin#1\nKd 1 0 0\nnewmtl skin #2\nKd 0 1 0\n");
    const Scene scene = load("\xEF\xBB\xBFmtllib a.mtl\n" + kSquare +
                             "usemtl skin#1\nf 1 2 3\nusemtl skin #2\nf 1 3 4\n"
                             "usemtl skin#1 # again\nf 2 3 4\n");
    ASSERT_EQ(scene.materials.size(), 3U);
    EXPECT_EQ(scene.materials[0].baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.materials[1].baseColor, glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(scene.materials[2].baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(load("\xEF\xBB\xBF" + kSquare + "f 1 2 3 4\n").bounds().min, glm::vec3(0));
}

TEST_F(LoadObj, FindsSeveralMaterialFiles) {
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    folder.write("b c.mtl", "newmtl green\nKd 0 1 0\n");
    const std::string faces = kSquare + "usemtl red\nf 1 2 3\nusemtl green\nf 1 3 4\n";
    for (const char* lines :
         {"mtllib a.mtl\nmtllib b c.mtl\n", "mtllib a.mtl\nmtllib \"b c.mtl\"\n",
          "mtllib \"a.mtl\" # red\nmtllib b c.mtl # green\n"}) {
        const Scene scene = load(lines + faces);
        EXPECT_EQ(scene.materials.at(0).baseColor.r, 1.0F) << lines;
        EXPECT_EQ(scene.materials.at(1).baseColor.g, 1.0F) << lines;
        EXPECT_TRUE(scene.warnings.empty()) << lines;
    }
    folder.write("b.mtl", "newmtl green\nKd 0 1 0\n");
    EXPECT_EQ(load("mtllib a.mtl b.mtl\n" + faces).materials.at(1).baseColor.g, 1.0F);
    EXPECT_EQ(load("mtllib a.mtl gone.mtl\n" + faces).warnings,
              std::vector<std::string>{
                  "material file 'gone.mtl' is not beside the model: its materials are grey"});
}

TEST_F(LoadObj, SaysWhichTexturesAndMaterialsAreMissing) {
    folder.write("a.mtl",
                 "newmtl a\nmap_Kd C:\\x\\wood.png\nnewmtl b\nmap_Kd a.tga\nmap_d d.png\n");
    folder.write("a.tga", "something");
    EXPECT_EQ(load("mtllib a.mtl\n" + kSquare +
                   "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl c\nf 2 3 4\n")
                  .warnings,
              (std::vector<std::string>{
                  "left out: 'map_d' of a material file",
                  "left out: the material 'c', which no material file has: it is grey",
                  "left out: the texture 'C:\\x\\wood.png', which is not beside the model",
                  "left out: the texture 'a.tga', which is neither PNG nor JPEG"}));
}

/// As programs write them on another machine.
TEST_F(LoadObj, OfAbsolutePathsTheFileBesideTheModelIsTaken) {
    folder.write("wood.png", image::encodePng(image::Image8(1, 1, 3)));
    folder.write("my wood.png", image::encodePng(image::Image8(1, 1, 3)));
    for (const char* name :
         {"C:\\dir\\wood.png", "C:/dir/wood.png", "\\\\host\\dir\\wood.png", "/home/x/wood.png",
          "\"C:\\my dir\\wood.png\"", "\"wood.png\"", "-s 1 1 1 \"my wood.png\""}) {
        folder.write("a.mtl", fmt::format("newmtl a\nmap_Kd {}\n", name));
        for (const char* library :
             {"C:\\dir\\a.mtl", "\"/home/x y/a.mtl\"", "D:\\a.mtl", "a.mtl"}) {
            const Scene scene = load(fmt::format("mtllib {}\n", library) + kSquare +
                                     "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n");
            EXPECT_EQ(scene.textures.size(), 1U) << name << " of " << library;
            EXPECT_EQ(scene.warnings, std::vector<std::string>{}) << name << " of " << library;
            EXPECT_EQ(scene.filesBeside.size(), 2U);
            EXPECT_EQ(filesBeside(folder.path() / "a.obj").size(), 2U);
        }
    }
}

TEST_F(LoadObj, SaysWhichColoursOfTexturesAreNotRead) {
    folder.write("a.mtl", "newmtl a\nmap_Kd a.png\n");
    const auto warnings = [&](const std::string& gamma) {
        std::string png = image::encodePng(image::Image8(1, 1, 3));
        // A chunk before the others: its length, its name, what it holds, a checksum.
        png.insert(33, std::string("\0\0\0\x04", 4) + "gAMA" + gamma + std::string(4, '\0'));
        folder.write("a.png", png);
        return load("mtllib a.mtl\nvt 0 0\n" + kSquare + "usemtl a\nf 1/1 2/1 3/1 4/1\n").warnings;
    };
    EXPECT_EQ(warnings(std::string("\0\0\xB1\x8F", 4)), std::vector<std::string>{});
    EXPECT_EQ(
        warnings(std::string("\0\x01\x86\xA0", 4)),
        std::vector<std::string>{"left out: the gamma, primaries or colour profile of a texture"});
}

TEST_F(LoadObj, SaysWhichTexturesFacesCannotHave) {
    folder.write("a.mtl", "newmtl a\nmap_Kd a.png\n");
    folder.write("a.png", image::encodePng(image::Image8(1, 1, 3)));
    const std::vector<std::string> said{"left out: a texture of faces without texture coordinates"};
    const std::string start = "mtllib a.mtl\nvt 0 0\n" + kSquare + "usemtl a\n";
    EXPECT_EQ(load(start + "f 1 2 3 4\n").warnings, said);
    EXPECT_EQ(load(start + "f 1/1 2/1 3/1\nf 1 3 4\n").warnings, said);
}

TEST_F(LoadObj, ReadsWhatIsUnusual) {
    const float half = 0.5F;
    folder.write("a.mtl", "newmtl a\nKd spectral red.rfl 1.0\nKe xyz 1 1 1\nd -halo 0.5\n");
    const Scene scene = load("mtllib a.mtl\n" + kSquare + "usemtl a\nf 1 2 \\ \n3 4\n");
    EXPECT_EQ(scene.triangleCount(), 2U);
    EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(glm::vec3(0.8F), half));
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{"left out: 'Kd' by a spectrum in a material file",
                                        "left out: 'Ke' by CIE XYZ in a material file",
                                        "left out: 'd -halo' of a material file, taken as 'd'",
                                        "left out: a material's opacity below 1, drawn as solid"}));

    const Scene odd = load("vn nan nan nan\nvn 0 0 1\nvt nan nan\n" + kSquare +
                           "f 1/1/1 2/1/2 3/1/2\nf 1 2\nv 0 0 -0." + std::string(54, '0') +
                           "12\nf 1/1/1 5/1/2 3/1/2\n");
    EXPECT_EQ(odd.meshes.at(0).normals[0], glm::vec3(0));
    EXPECT_EQ(odd.meshes[0].texcoords[0], glm::vec2(0, 1));
    EXPECT_EQ(odd.meshes[0].positions[3], glm::vec3(0));
    EXPECT_EQ(
        odd.warnings,
        (std::vector<std::string>{
            "left out: a face of fewer than 3 corners", "left out: a normal that is not finite",
            "left out: a texture coordinate that is not finite, taken as 0 (2 times)",
            "left out: a vertex that no face uses"}));

    const Scene forward = load(kSquare + "f 1/1/1 2/2/1 3/3/1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n");
    EXPECT_EQ(forward.meshes.at(0).texcoords[1], glm::vec2(1, 1));
    EXPECT_EQ(forward.meshes[0].normals.size(), 3U);
    const Scene absent = load(kSquare + "f 1/1/9 2/2/0 3/3/-7\n");
    EXPECT_TRUE(absent.meshes.at(0).normals.empty());
    EXPECT_EQ(absent.warnings,
              (std::vector<std::string>{"left out: a texture coordinate or a normal of a corner, "
                                        "which is not in the file (6 times)",
                                        "left out: a vertex that no face uses"}));
}

TEST_F(LoadObj, ReadsColoursContinuationsAndComments) {
    const Mesh mesh = load(
                          "# colours\nv 0 0 0 1 0.5 0 # red\nv 1 0 0 \\\n 0 0 1\r\nv 1 1 0 0 0 "
                          "0\nf 1 \\\r\n2 3\n")
                          .meshes.at(0);
    EXPECT_EQ(mesh.colors[1], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.colors[0].r, 1.0F);
    EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(LoadObj, SaysWhichNumbersAndOptionsItLeavesOut) {
    using Lines = std::vector<std::string>;
    EXPECT_EQ(load("v 0 0 0 2\nv 1 0 0 1\nv 1 1 0\nvt 0 0 0\nvt 1 0 0.5\nvt 1 1 0 7\nvn 0 0 1 4\n"
                   "f 1/1/1 2/2/1 3/3/1\n")
                  .warnings,
              (Lines{"left out: further numbers of the line 'v'",
                     "left out: further numbers of the line 'vn'",
                     "left out: further numbers of the line 'vt' (2 times)"}));
    EXPECT_EQ(load("v 0 0 0 1 0 0 1\nv 1 0 0 1 0 0 1\nv 1 1 0 1 0 0 1\nf 1 2 3\n").warnings,
              Lines{"left out: further numbers of the line 'v' (3 times)"});
    image::writePng(folder.path() / "a.png", image::Image8(2, 1, 1, 128));
    const auto warnings = [&](const std::string& options) {
        folder.write("a.mtl", "newmtl a\nmap_Kd " + options + "a.png\n");
        const Scene scene =
            load("mtllib a.mtl\nvt 0 0\n" + kSquare + "usemtl a\nf 1/1 2/1 3/1 4/1\n");
        EXPECT_EQ(scene.materials.at(0).baseColorTexture, 0) << options;
        return scene.warnings;
    };
    EXPECT_EQ(warnings("-s 1 1 1 -o 0 0 -mm 0 1.0 -clamp off -blendu on "), Lines{});
    EXPECT_EQ(warnings("-s 2 2 1 -o -0.5 0 0 -mm 0.1 1 -clamp on -texres 512 "),
              (Lines{"left out: '-clamp' of map_Kd", "left out: '-mm' of map_Kd",
                     "left out: '-o' of map_Kd", "left out: '-s' of map_Kd",
                     "left out: '-texres' of map_Kd"}));
}

TEST_F(LoadObj, SplitsByMaterial) {
    image::writePng(folder.path() / "wood grain.png", image::Image8(2, 1, 1, 128));
    folder.write("a.mtl",
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
    EXPECT_THAT(scene.warnings,
                Contains("left out: a material's opacity below 1, drawn as solid (2 times)"));
}

TEST_F(LoadObj, LivesWithoutItsMaterialFile) {
    const Scene scene = load("mtllib gone.mtl\nmtllib /etc/passwd\nmtllib ../x.mtl\n" + kSquare +
                             "usemtl wood\nf 1 2 3 4\n");
    EXPECT_EQ(scene.materials.at(0).name, "wood");
    EXPECT_EQ(scene.materials.at(0).baseColor, Material{}.baseColor);
    ASSERT_EQ(scene.warnings.size(), 3U);
    EXPECT_EQ(scene.warnings[0],
              "material file 'gone.mtl' is not beside the model: its materials are grey");
}

TEST_F(LoadObj, ReadsVerticesWithoutFacesAsPoints) {
    EXPECT_EQ(load(kSquare).points.positions.size(), 4U);
    EXPECT_EQ(load("mtllib a.mtl\nusemtl a\nvt 0 0\nvn 0 0 1\nvn 0 0 1\n" + kSquare).warnings,
              (std::vector<std::string>{"left out: the line 'mtllib' of a file without faces",
                                        "left out: the line 'vn' of a file without faces (2 times)",
                                        "left out: the line 'vt' of a file without faces"}));
    EXPECT_EQ(error(kSquare + "l 1 2\n"), "DIR/a.obj: lines, but no faces or points");
    const auto isNoText = [](const char* kind) {
        return fmt::format("DIR/a.obj: is {}; allowed: as it is, text in UTF-8", kind);
    };
    EXPECT_EQ(error(std::string("\xFF\xFEv\0 \0", 6)), isNoText("in UTF-16"));
    EXPECT_EQ(error(std::string("\xFE\xFF\0v\0 ", 6)), isNoText("in UTF-16"));
    EXPECT_EQ(error("\x1F\x8B\x08 …"), isNoText("compressed by gzip"));
    EXPECT_EQ(error("PK\x03\x04…"), isNoText("an archive (zip)"));
    EXPECT_EQ(error("o nothing\n"), "DIR/a.obj: no vertices");
}

/// A path is often the last word of one.
TEST_F(LoadObj, CommentsAreNotContinued) {
    folder.write("a.mtl", "# C:\\\nnewmtl red\nKd 1 0 \\\n 0 # D:\\\nNs 96\n");
    const Scene scene = loadObj(folder.write(
        "a.obj",
        "# C:\\models\\\nmtllib a.mtl # D:\\ \r\nv 0 0 0 # first \\\nv 1 0 \\\n0 # \\\nv 0 1 0\n"
        "usemtl red\nf 1 2 3\n"));
    EXPECT_EQ(scene.triangleCount(), 1U);
    EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_LT(scene.materials.at(0).roughness, 0.5F);
    EXPECT_EQ(scene.warnings, std::vector<std::string>{});
}

/// By the format, and as other readers have it, a backslash continues every line of an OBJ file.
TEST_F(LoadObj, NamesThatTakeTheNextLineAreSaid) {
    const std::string head = "mtllib a.mtl\n" + kSquare;
    folder.write("a.mtl", "newmtl a\nmap_Kd C:\\tex\\\nKd 1 0 0\nKs 1 1\\\n 1\n");
    const std::string said = "left out: a line that the one before takes, as that ends in '\\'";
    for (const char* line :
         {"g C:\\part\\", "o part\\ ", "g part\\\r", "g part \\", "s off\\", "lod a\\"}) {
        const Scene scene = load(kSquare + line + "\nf 1 2 3\nf 1 3 4\n");
        EXPECT_EQ(scene.triangleCount(), 1U) << line;
        EXPECT_THAT(scene.warnings, Contains(said)) << line;
    }
    EXPECT_EQ(
        load(head + "usemtl b\\\nf 1 2 3\ng c\\\nf 1 2 3\nusemtl a\nf 1 2 3\nf 1 3 4\n").warnings,
        (std::vector<std::string>{
            "left out: 'Ks' of a material file", said + " (3 times)",
            "left out: the texture 'C:\\tex Kd 1 0 0', which is not beside the model"}));
    folder.write("a.mtl", "newmtl a\nKa 1 1 1\\\nKd 1 0 0\n");
    EXPECT_EQ(load(head + "usemtl a\nf 1 2 3\nf 1 3 4\n").warnings, std::vector{said});
    // Names on two lines, and numbers, are continued as they are meant.
    EXPECT_EQ(load(kSquare + "g a \\\nb\nf 1 2\\\n 3\nf 1 3 4\n").warnings,
              std::vector<std::string>{});
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
    EXPECT_EQ(error(kSquare + "f 1 2 x\n"),
              "DIR/a.obj:5: 'x' is not a corner; v, v/vt, v//vn and v/vt/vn are allowed");
    EXPECT_EQ(error(kSquare + "f 1 2 99999999999999999999\n"),
              "DIR/a.obj:5: '99999999999999999999' is not a corner; v, v/vt, v//vn and v/vt/vn are "
              "allowed");
}

TEST_F(LoadObj, AFileOfZerosHasItsErrorSoonAndInALine) {
    const auto errorOf = [&](const std::string& head, std::uintmax_t bytes) {
        const auto path = folder.write("a.obj", head);
        fs::resize_file(path, bytes);  // nearly all of it a hole
        return errorText([&] { loadObj(path); }, folder.path());
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
    folder.write("a.mtl", "newmtl a\nKd red\n");
    const std::string content = "mtllib a.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n";
    EXPECT_EQ(error(content), "DIR/a.mtl:2: 'red' is not a finite number");
    folder.write("a.mtl", "newmtl a\nmap_Kd a.png\n");
    folder.write("a.png", "\x89PNG, but broken");
    EXPECT_THAT(error(content), StartsWith("DIR/a.png: "));
}

}  // namespace
}  // namespace gfxrepro::scene
