// Which files belong to a model, and its textures.
#include "engine/scene/model_files.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/png_io.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

using Lines = std::vector<std::string>;
using ModelFiles = FolderTest;

TEST_F(ModelFiles, AFileWithAnEncodedNameIsPartOfTheIdentity) {
    Document document = square();
    folder.write("two words/a+b c.bin", squareBytes());
    document["buffers"] = R"([{"byteLength":76,"uri":"two%20words/a+b%20c.bin"}])";
    const auto path = folder.write("a.gltf", text(document));
    const auto bin = folder.path() / "two words/a+b c.bin";
    EXPECT_EQ(filesBeside(path), std::vector<fs::path>{bin});
    const Scene scene = loadScene(path);
    EXPECT_EQ(scene.filesBeside, std::vector<fs::path>{bin});
    folder.write("two words/a+b c.bin", squareBytes().replace(0, 4, "\0\0\x80\x3e", 4));
    EXPECT_NE(loadScene(path).origin.sha256, scene.origin.sha256);
}

TEST_F(ModelFiles, AFileThatNobodyHashedIsAnError) {
    folder.write("square.bin", squareBytes());
    const auto path = folder.write("a.gltf", text(square()));
    const auto other = folder.write("other.bin", "x");
    EXPECT_EQ(errorText(
                  [&] {
                      sha256OfModel(path, {folder.path() / "square.bin", other});
                  },
                  folder.path()),
              "DIR/other.bin: belongs to DIR/a.gltf, but is not part of the model's identity");
}

/// A walk that kept the path of each level would take the square of the depth.
TEST_F(ModelFiles, DeepNestingEndsTheSearch) {
    std::string nested;
    for (int i = 0; i < 1'000'000; ++i) nested += "{\"extensions\":";
    EXPECT_TRUE(filesBeside(folder.write("a.gltf", nested)).empty());
    EXPECT_TRUE(filesBeside(folder.write("b.gltf", std::string(10'000'000, '['))).empty());
}

TEST_F(ModelFiles, AnObjFileHasThoseThatItsLoaderOpens) {
    folder.write("a.mtl", "newmtl a\nmap_Kd b.tga # bark\n");
    folder.write("c d.mtl", "newmtl c\n");
    folder.write("b.tga", "x");
    const auto path =
        folder.write("a.obj",
                     "\xEF\xBB\xBFmtllib a.mtl\nmtllib \\\n \"c d.mtl\"\n# mtllib e.mtl\n"
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    folder.write("e.mtl", "newmtl e\n");
    std::vector<fs::path> opened = loadScene(path).filesBeside;
    std::ranges::sort(opened);
    EXPECT_EQ(opened, filesBeside(path));
    EXPECT_EQ(opened.size(), 3U);
}

TEST_F(ModelFiles, TexturesStandBesideTheirMaterialFileOrTheModel) {
    const std::string png = image::encodePng(image::Image8(1, 1, 3));
    for (const char* name : {"m/a.png", "t/b.png", "c.png", "d.png", "m/d.png"}) {
        folder.write(name, png);
    }
    folder.write("m/a.mtl",
                 "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd ..\\t\\b.png\n"
                 "newmtl c\nmap_Kd c.png\nnewmtl d\nmap_Kd d.png # the nearer\n"
                 "newmtl e\nmap_Kd ../../e.png\n");
    std::string content = "mtllib m/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (const char* name : {"a", "b", "c", "d", "e"}) {
        content += std::string("usemtl ") + name + "\nf 1/1 2/1 3/1\n";
    }
    const auto path = folder.write("a.obj", content);
    const Scene scene = loadScene(path);
    EXPECT_EQ(scene.textures.size(), 4U);
    EXPECT_EQ(scene.warnings,
              std::vector<std::string>{
                  "left out: the texture '../../e.png', which is not beside the model"});
    std::vector<std::string> files;
    for (const auto& file : filesBeside(path)) {
        files.push_back(file.lexically_relative(folder.path()));
    }
    EXPECT_EQ(files,
              (std::vector<std::string>{"c.png", "m/a.mtl", "m/a.png", "m/d.png", "t/b.png"}));
}

/// As programs of old Macintoshes end lines.
TEST_F(ModelFiles, CarriageReturnsEndLinesWhereNothingElseDoes) {
    const auto written = [&](const char* name, std::string content) {
        std::ranges::replace(content, '\n', '\r');
        return folder.write(name, content);
    };
    const auto error = [&](const char* name, const std::string& content) {
        return errorText([&] { loadScene(written(name, content)); }, folder.path());
    };
    written("a.mtl", "# a comment\nnewmtl a\nKd 1 0 0\n");
    const auto obj = written("a.obj",
                             "# a comment\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                             "usemtl a\nf 1 2 3\n");
    EXPECT_EQ(filesBeside(obj), std::vector<fs::path>{folder.path() / "a.mtl"});
    EXPECT_EQ(loadScene(obj).materials.at(0).baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(error("b.obj", "v 0 0 0\nv x 0 0\n"), "DIR/b.obj:2: 'x' is not a finite number");
    const std::string ply =
        "ply\nformat ascii 1.0\ncomment a\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    EXPECT_EQ(loadScene(written("a.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).triangleCount(),
              1U);
    EXPECT_EQ(error("a.ply", ply + "0 0 0\nx 0 0\n0 1 0\n3 0 1 2\n"),
              "DIR/a.ply:12: vertex 1: 'x' is not a number of type float");
    EXPECT_EQ(loadScene(written("a.off", "OFF # 1\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"))
                  .triangleCount(),
              1U);
    EXPECT_EQ(loadScene(written("a.stl",
                                "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"))
                  .triangleCount(),
              1U);
}

/// As clouds of depth cameras have where nothing was seen.
TEST_F(ModelFiles, PlacesThatAreNoNumbersAreLeftOutOfPointsOrRefused) {
    const auto error = [&](const char* name, const std::string& content) {
        return errorText([&] { loadScene(folder.write(name, content)); }, folder.path());
    };
    const auto cloud = [](const std::string& rows, int faceCount = 0) {
        return fmt::format(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face {}\nproperty list uchar int vertex_indices\nend_header\n{}",
            faceCount, rows);
    };
    const std::string rows = "nan nan nan 1 2 3\n1 2 3 255 0 0\n1 2 nan 1 2 3\n4 5 6 0 255 0\n";
    const Scene seen = loadScene(folder.write("a.ply", cloud(rows)));
    EXPECT_EQ(seen.points.positions, (std::vector<glm::vec3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(seen.points.colors, (std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(seen.warnings,
              std::vector<std::string>{"left out: a point whose place is no number (2 times)"});
    EXPECT_EQ(error("a.ply", cloud(rows + "3 0 1 3\n", 1)),
              "DIR/a.ply:13: vertex 0: x is nan; finite numbers in the range of float are allowed");
    const std::string none = "nan nan nan 1 2 3\n";
    EXPECT_EQ(error("a.ply", cloud(none + none + none + none)),
              "DIR/a.ply:3: element 'vertex': x, y or z is no number in each of 4 rows");
    EXPECT_EQ(error("a.obj", "v 0 0 0\nv nan 0 0\n"), "DIR/a.obj:2: 'nan' is not a finite number");
}

/// A progressive JPEG of 16 x 16 texels with FF 00 between its first scan and the next marker.
constexpr std::string_view kStuffedJpeg =
    "ffd8ffe000104a46494600010100000100010000ffdb0043000302020302020303030304030304050805050404050a"
    "070706080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f171816141812141514ffdb004301"
    "03040405040509050509140d0b0d141414141414141414141414141414141414141414141414141414141414141414"
    "1414141414141414141414141414141414ffc20011080010001003012200021101031101ffc4001500010100000000"
    "000000000000000000000607ffc4001501010100000000000000000000000000000103ffda000c0301000210031000"
    "0001953362cea75a5a5a5a5a5a5a5a5a5a5a5aff00ffc400161000030000000000000000000000000000000405ffda"
    "00080101000105025650a4a14942b28fffc4001811000203000000000000000000000000000005062131ffda000801"
    "0301013f018dbecb3fffc40017110003010000000000000000000000000000040561ffda0008010201013f0172c69f"
    "ffc4001510010100000000000000000000000000000031ffda0008010100063f028888ffc400151001010000000000"
    "0000000000000000000031ffda0008010100013f219b162cdfffda000c030100020003000000100bffc40015110101"
    "000000000000000000000000000000a1ffda0008010301013f109effc4001511010100000000000000000000000000"
    "000031ffda0008010201013f10b1ffc40015100101000000000000000000000000000000f1ffda0008010100013f10"
    "94848494ffd9";

std::vector<std::byte> bytesOf(std::string_view hex) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        const std::string digits(hex.substr(i, 2));
        bytes.push_back(static_cast<std::byte>(std::stoi(digits, nullptr, 16)));
    }
    return bytes;
}

TEST_F(ModelFiles, ColoursThatAPaletteOfATextureHasNotAreSaid) {
    // Pixels 0, 1, 5, 2 of a red and a green.
    const std::vector<std::byte> png = bytesOf(
        "89504e470d0a1a0a0000000d4948445200000004000000010803000000cee2ffff00000006504c5445ff000000"
        "ff00d287ef710000000d4944415478da6360606465020000140009f22d96730000000049454e44ae426082");
    folder.write("a.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    folder.write("a.mtl", "newmtl a\nmap_Kd a.png\n");
    const Scene obj = loadScene(folder.write(
        "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"));
    const std::vector<std::string> said{
        "left out: a colour that a texture's palette has not: its pixel is black (2 times)"};
    EXPECT_EQ(obj.textures.at(0).at(1, 0, 1), 255);
    EXPECT_EQ(obj.textures[0].at(2, 0, 1), 0);
    EXPECT_EQ(obj.warnings, said);
    folder.write("square.bin", squareBytes());
    Document document = square();
    document["images"] = R"([{"uri":"a.png"}])";
    document["textures"] = R"([{"source":0}])";
    document["materials"] = R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":3},"indices":1,"material":0}]}])";
    EXPECT_EQ(loadScene(folder.write("a.gltf", text(document))).warnings, said);
}

TEST(DecodeTexture, SkipsStuffedBytesBehindAScan) {
    std::vector<std::byte> bytes = bytesOf(kStuffedJpeg);
    LeftOut leftOut;
    const image::Image8 texture = decodeTexture(bytes, "a.jpg", leftOut);
    EXPECT_EQ(texture.width(), 16);
    const auto stuffed = kStuffedJpeg.find("5aff00ffc4") / 2 + 1;
    bytes.erase(bytes.begin() + static_cast<long>(stuffed),
                bytes.begin() + static_cast<long>(stuffed) + 2);
    EXPECT_EQ(texture, decodeTexture(bytes, "a.jpg", leftOut)) << "as without them";
}

// Files with all that their formats have: what is not used is said, once for each kind.

TEST(LeftOut, CountsEachKindAndStopsAtTooManyKinds) {
    LeftOut leftOut;
    leftOut.add("a");
    leftOut.add("b", 0);
    for (int i = 0; i < 3; ++i) leftOut.add("c");
    Lines warnings;
    leftOut.tell(warnings);
    EXPECT_EQ(warnings, (Lines{"left out: a", "left out: c (3 times)"}));
    for (int i = 0; i < 1000; ++i) leftOut.add(std::to_string(i));
    warnings.clear();
    leftOut.tell(warnings);
    EXPECT_EQ(warnings.size(), 101U);
    EXPECT_EQ(warnings.back(), "left out: more of other kinds (902 times)");
}

/// Every line of the OBJ and MTL specifications (version 3.0), and usual additions.
TEST(LeftOut, OfObj) {
    const TemporaryFolder folder;
    folder.write("a.mtl",
                 "newmtl a\nKa 0 0 0\nKd 1 1 1\nKs 1 1 1\nKe 0 0 0\nTf 1 1 1\nillum 2\nd 1\nTr 0\n"
                 "Ns 10\nsharpness 60\nNi 1.5\nmap_Ka a.png\nmap_Ks a.png\nmap_Ns a.png\n"
                 "map_d a.png\nmap_Ke a.png\ndisp a.png\ndecal a.png\nbump a.png\n"
                 "map_Bump a.png\nnorm a.png\nrefl -type sphere a.png\nmap_aat on\nPr 1\nPm 1\n");
    const Scene scene = loadObj(folder.write(
        "a.obj",
        "mtllib a.mtl\no a\ng a b\ns 1\nmg 1 1\nv 0 0 0 1\nv 1 0 0\nv 0 1 0\nvt 0 0 0\nvp 0 0 1\n"
        "cstype bezier\ndeg 3\nbmat u 1\nstep 1\ncurv 0 1 1 2\ncurv2 1 2\nsurf 0 1 0 1 1\n"
        "parm u 0 1\ntrim 0 1 1\nhole 0 1 1\nscrv 0 1 1\nsp 1\nend\ncon 1 0 1 1 2 0 1 1\n"
        "usemtl a\nusemap off\nmaplib a\nf 1/1 2/1 3/1\nfo 1 2 3\nl 1 2\np 1\nlod 1\nbevel off\n"
        "c_interp off\nd_interp off\nshadow_obj a\ntrace_obj a\nctech cparm 1\nstech cparma 1 "
        "1\n#MRGB ff808080ff808080ff808080\n"));
    Lines expected{"left out: the line '#MRGB' (vertex colours)"};
    for (const char* line :
         {"bevel",  "bmat",     "c_interp", "con",       "cstype", "ctech",      "curv",
          "curv2",  "d_interp", "deg",      "end",       "hole",   "l",          "lod",
          "maplib", "mg",       "p",        "parm",      "scrv",   "shadow_obj", "sp",
          "stech",  "step",     "surf",     "trace_obj", "trim",   "usemap",     "vp"}) {
        expected.push_back("left out: the line '" + std::string(line) + '\'');
    }
    expected.push_back("left out: the line 's' (smoothing)");
    for (const char* key : {"Ks", "Pm", "Pr", "Tf", "bump", "decal", "disp", "map_Bump", "map_Ke",
                            "map_Ks", "map_Ns", "map_aat", "map_d", "norm", "refl", "sharpness"}) {
        expected.push_back("left out: '" + std::string(key) + "' of a material file");
    }
    std::ranges::sort(expected);
    EXPECT_EQ(scene.warnings, expected);
}

TEST(LeftOut, OfPly) {
    const TemporaryFolder folder;
    const Scene scene = loadPly(folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile wood.png\ncomment any\nobj_info any\n"
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty uchar red\n"
        "property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float s\n"
        "property float t\nproperty float confidence\nproperty float intensity\n"
        "property float quality\nproperty int flags\nproperty float radius\n"
        "property float curvature\nproperty list uchar int neighbours\n"
        "element face 1\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nproperty uchar red\nproperty int flags\n"
        "element edge 2\nproperty int vertex1\nproperty int vertex2\n"
        "element material 1\nproperty float shininess\nend_header\n"
        "0 0 0 0 9 9 9 9 0 0 1 1 1 0 1 5 0\n1 0 0 0 9 9 9 9 0 0 1 1 1 0 1 5 0\n"
        "0 1 0 0 9 9 9 9 0 0 1 1 1 0 1 5 0\n3 0 1 2 2 0 0 7 0\n0 1\n1 2\n3\n"));
    EXPECT_EQ(
        scene.warnings,
        (Lines{"left out: a comment TextureFile", "left out: a row of element 'edge' (2 times)",
               "left out: a row of element 'material'",
               "left out: the property 'alpha' of vertices",
               "left out: the property 'curvature' of vertices",
               "left out: the property 'neighbours' of vertices",
               "left out: the property 'nx' of vertices", "left out: the property 'red' of faces",
               "left out: the property 'texcoord' of faces",
               "left out: the radius of a vertex with faces (3 times)"}));
}

/// A header that counts too few rows, or a file that is two.
TEST(LeftOut, OfWhatStandsBehindTheLastRow) {
    const TemporaryFolder folder;
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const auto ofOff = [&](const std::string& behind) {
        return loadOff(folder.write("a.off", off + behind)).warnings;
    };
    EXPECT_EQ(ofOff("\n# the end\n"), Lines{});
    EXPECT_EQ(ofOff("3 0 2 1\n\n3 1 2 0"),
              Lines{"left out: a line behind the last face (2 times)"});
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n";
    const auto ofPly = [&](const std::string& text) {
        return loadPly(folder.write("a.ply", text)).warnings;
    };
    EXPECT_EQ(ofPly(head + "0 0 0\n1 0 0\n \r\n"), Lines{});
    EXPECT_EQ(ofPly(head + "0 0 0\n1 0 0\n2 0 0\n\n3 0 0"),
              Lines{"left out: a line behind the last row (2 times)"});
    std::string binary = head;
    binary.replace(binary.find("ascii"), 5, "binary_little_endian");
    EXPECT_EQ(ofPly(binary + std::string(24, '\0')), Lines{});
    EXPECT_EQ(ofPly(binary + std::string(26, '\0')),
              Lines{"left out: a byte behind the last row (2 times)"});
}

/// Every key of glTF 2.0, and some extensions.
TEST(LeftOut, OfGltf) {
    const TemporaryFolder folder;
    folder.write("square.bin", squareBytes());
    Document document = square();
    document["asset"] =
        R"({"version":"2.0","minVersion":"2.0","generator":"g","copyright":"c","extras":{"a":1}})";
    document["extensionsUsed"] = R"(["KHR_materials_sheen","VENDOR_x"])";
    document["accessors"].insert(1, R"({"name":"a","min":[0,0,0],"max":[1,1,0],"bufferView":0,
        "byteOffset":0,"componentType":5126,"normalized":false,"count":4,"type":"VEC3",
        "sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":0,"componentType":5123},
                  "values":{"bufferView":0,"byteOffset":0}}},
       {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"},)");
    document["bufferViews"].insert(1, R"({"name":"v","target":34962,"byteStride":12,"buffer":0,
        "byteOffset":0,"byteLength":48,"extensions":{"EXT_meshopt_compression":{"buffer":0}}},
       {"buffer":0,"byteOffset":48,"byteLength":12},)");
    document["meshes"] = R"([{"name":"m","weights":[0],"primitives":[
        {"mode":4,"material":0,"indices":1,"attributes":{"POSITION":0,"NORMAL":0,"TANGENT":0,
            "_MINE":0,"COLOR_1":0,"TEXCOORD_7":0},"targets":[{"POSITION":0,"TANGENT":0}],
            "extensions":{"KHR_materials_variants":{"mappings":[{"material":0}]}}},
        {"mode":1,"attributes":{"POSITION":0}}]}])";
    document["images"] =
        R"([{"name":"i","mimeType":"image/png","uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="}])";
    document["samplers"] =
        R"([{"name":"s","magFilter":9729,"minFilter":9987,"wrapS":10497,"wrapT":10497}])";
    document["textures"] = R"([{"name":"t","source":0,"sampler":0},
        {"extensions":{"KHR_texture_basisu":{"source":0}}}])";
    const std::string texture = R"({"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":
        {"offset":[0,0],"rotation":0,"scale":[1,1],"texCoord":0}}})";
    document["materials"] =
        R"([{"name":"a","alphaMode":"BLEND","alphaCutoff":0.5,"doubleSided":true,
        "emissiveFactor":[0,0,0],"emissiveTexture":)" +
        texture + R"(,"normalTexture":)" + texture +
        R"(,"occlusionTexture":{"index":0,"strength":1},
        "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],"metallicFactor":1,
            "roughnessFactor":1,"baseColorTexture":{"index":1},"metallicRoughnessTexture":)" +
        texture + R"(},"extensions":{"KHR_materials_ior":{"ior":1.5},
            "KHR_materials_transmission":{"transmissionFactor":0,"transmissionTexture":{"index":0}},
            "KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0,1,0,1]},
            "KHR_materials_sheen":{"sheenRoughnessFactor":1}}}])";
    document["cameras"] = R"([{"name":"p","type":"perspective","perspective":{"aspectRatio":1,
        "yfov":1,"zfar":9,"znear":1}},{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,
        "zfar":9,"znear":1}}])";
    document["skins"] = R"([{"name":"k","joints":[0],"skeleton":0}])";
    document["nodes"] = R"([{"name":"n","mesh":0,"camera":0,"children":[1],"translation":[0,0,0],
        "rotation":[0,0,0,1],"scale":[1,1,1],"extras":{"any":[{"thing":1}]}},
        {"camera":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"extensions":{"VENDOR_x":{}}}])";
    document["animations"] = R"([{"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}],
        "samplers":[{"input":0,"output":0,"interpolation":"LINEAR"}]}])";
    document["scenes"] = R"([{"name":"s","nodes":[0],"extras":{}}])";
    document["scene"] = "0";
    const Scene scene = loadGltf(folder.write("a.gltf", text(document)));
    const auto keyLine = [](const char* key) {
        return std::string("left out: the key '") + key + '\'';
    };
    EXPECT_EQ(
        scene.warnings,
        (Lines{"left out: a material's alphaMode BLEND, drawn as solid",
               "left out: a primitive of lines",
               "left out: a texture of a mesh without TEXCOORD_0 (3 times)",
               "left out: a texture that only an extension gives", keyLine("animations"),
               keyLine("bufferViews.extensions.EXT_meshopt_compression"),
               keyLine("cameras.orthographic"),
               keyLine("materials.extensions.KHR_materials_pbrSpecularGlossiness"),
               keyLine("materials.extensions.KHR_materials_sheen"),
               keyLine("materials.extensions.KHR_materials_transmission.transmissionTexture"),
               keyLine("materials.occlusionTexture"),
               keyLine("meshes.primitives.attributes.COLOR_1"),
               keyLine("meshes.primitives.attributes.TANGENT"),
               keyLine("meshes.primitives.extensions.KHR_materials_variants"),
               keyLine("meshes.primitives.targets.TANGENT"), keyLine("nodes.extensions.VENDOR_x"),
               keyLine("textures.extensions.KHR_texture_basisu")}));
}

}  // namespace
}  // namespace gfxrepro::scene
