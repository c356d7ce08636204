// Values that a format does not have, that stand twice, or where others are expected: refused or
// said, never passed over.
#include <fmt/format.h>
#include <algorithm>
#include <string>
#include <vector>

#include "engine/image/png_io.h"
#include "engine/scene/load.h"
#include "engine/scene/model_files.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

using Lines = std::vector<std::string>;

struct LoadMeaning : FolderTest {
    LoadMeaning() { folder.write("square.bin", squareBytes()); }

    std::string gltfError(const std::string& key, const std::string& value) {
        Document document = square();
        document[key] = value;
        const auto path = folder.write("a.gltf", text(document));
        const std::string error = errorText([&] { loadGltf(path); }, folder.path());
        const std::string place = "DIR/a.gltf: ";
        return error.starts_with(place) ? error.substr(place.size()) : error;
    }
    std::string nodeError(const std::string& members) {
        return gltfError("nodes", R"([{"mesh":0},{)" + members + "}]");
    }
    std::string materialError(const std::string& members) {
        return gltfError("materials", "[{" + members + "}]");
    }
    Lines warningsOf(const std::string& name, const std::string& content) {
        return loadScene(folder.write(name, content)).warnings;
    }
};

TEST_F(LoadMeaning, NumbersOfGltfAreNumbers) {
    const std::string three = "; allowed: a list of 3 numbers";
    EXPECT_EQ(nodeError(R"("translation":[1,"2",3])"),
              "nodes[1].translation[1] is '2'; allowed: a number");
    EXPECT_EQ(nodeError(R"("translation":[1,null,3])"),
              "nodes[1].translation[1] is null; allowed: a number");
    EXPECT_EQ(nodeError(R"("translation":[1,2])"), "nodes[1].translation is a list of 2" + three);
    EXPECT_EQ(nodeError(R"("scale":[1,2,3,4])"), "nodes[1].scale is a list of 4" + three);
    EXPECT_EQ(nodeError(R"("scale":2)"), "nodes[1].scale is 2" + three);
    EXPECT_EQ(nodeError(R"("scale":3)"), "nodes[1].scale is 3" + three);
    EXPECT_EQ(nodeError(R"("rotation":{})"),
              "nodes[1].rotation is an object; allowed: a list of 4 numbers");
    EXPECT_EQ(nodeError(R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0])"),
              "nodes[1].matrix is a list of 12; allowed: a list of 16 numbers");
    EXPECT_EQ(materialError(R"("pbrMetallicRoughness":{"baseColorFactor":["1",0,0,1]})"),
              "materials[0].pbrMetallicRoughness.baseColorFactor[0] is '1'; allowed: a number");
    EXPECT_EQ(materialError(R"("pbrMetallicRoughness":{"baseColorFactor":[1,0,0]})"),
              "materials[0].pbrMetallicRoughness.baseColorFactor is a list of 3; allowed: a list "
              "of 4 numbers");
    EXPECT_EQ(materialError(R"("pbrMetallicRoughness":{"roughnessFactor":"0.5"})"),
              "materials[0].pbrMetallicRoughness.roughnessFactor is '0.5'; allowed: a number");
    EXPECT_EQ(materialError(R"("normalTexture":{"extensions":{"KHR_texture_transform":
                               {"offset":[1]}}})"),
              "materials[0].normalTexture.extensions.KHR_texture_transform.offset is a list of 1; "
              "allowed: a list of 2 numbers");
    EXPECT_EQ(gltfError("meshes", R"([{"primitives":[],"weights":[true]}])"),
              "meshes[0].weights[0] is true; allowed: a number");
}

TEST_F(LoadMeaning, OtherValuesOfGltfAreThoseThatItHas) {
    EXPECT_EQ(nodeError(R"("mesh":0.0)"),
              "nodes[1].mesh is 0.0; allowed: a whole number from 0 to 2147483647");
    EXPECT_EQ(nodeError(R"("mesh":4294967296)"),
              "nodes[1].mesh is 4294967296; allowed: a whole number from 0 to 2147483647");
    EXPECT_EQ(nodeError(R"("mesh":-1)"),
              "nodes[1].mesh is -1; allowed: a whole number from 0 to 2147483647");
    EXPECT_EQ(nodeError(R"("children":0)"),
              "nodes[1].children is 0; allowed: a list of whole numbers");
    EXPECT_EQ(nodeError(R"("extensions":{"KHR_node_visibility":{"visible":"false"}})"),
              "nodes[1].extensions.KHR_node_visibility.visible is 'false'; allowed: true or false");
    EXPECT_EQ(materialError(R"("alphaMode":"FOO")"),
              "materials[0].alphaMode is 'FOO'; allowed: OPAQUE, MASK, BLEND");
    EXPECT_EQ(materialError(R"("alphaMode":1)"),
              "materials[0].alphaMode is 1; allowed: OPAQUE, MASK, BLEND");
    EXPECT_EQ(materialError(R"("doubleSided":1)"),
              "materials[0].doubleSided is 1; allowed: true or false");
    EXPECT_EQ(materialError(R"("pbrMetallicRoughness":[])"),
              "materials[0].pbrMetallicRoughness is a list; allowed: an object");
    const std::string modes = "; allowed: 0, 1, 2, 3, 4, 5, 6";
    EXPECT_EQ(gltfError("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"mode":7}]}])"),
              "meshes[0].primitives[0].mode is 7" + modes);
    EXPECT_EQ(gltfError("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"mode":"4"}]}])"),
              "meshes[0].primitives[0].mode is '4'" + modes);
    EXPECT_EQ(gltfError("samplers", R"([{"wrapS":1}])"),
              "samplers[0].wrapS is 1; allowed: 10497, 33071, 33648");
    EXPECT_EQ(gltfError("scene", R"("0")"),
              "scene is '0'; allowed: a whole number from 0 to 2147483647");
    EXPECT_EQ(gltfError("images", R"({"a":{"uri":"a.png"}})"),
              "images is an object; allowed: a list of objects");
    // null, as some write what is not there, and what nobody reads.
    EXPECT_EQ(nodeError(R"("mesh":null,"extras":{"mesh":"0"},"name":1)"), "no error");
    EXPECT_EQ(gltfError("asset", R"({"version":"1.0"})"), "glTF version '1.0'; 2.0 is read");
    EXPECT_EQ(gltfError("asset", R"({"version":2.0})"), "asset.version is 2.0; allowed: a text");
}

TEST_F(LoadMeaning, OfGltfNothingStandsTwice) {
    EXPECT_EQ(nodeError(R"("scale":[1,1,1],"scale":[2,2,2])"),
              "nodes[1].scale is there twice; allowed: once");
    for (const char* twice :
         {R"("scale":null,"scale":[2,2,2])", R"("scale":[2,2,2],"scale":null)"}) {
        EXPECT_EQ(nodeError(twice), "nodes[1].scale is there twice; allowed: once");
    }
    // glTF 2.0, Sec. 2.7: wherever it stands. Extras have paths of cameras, and motions.
    EXPECT_EQ(gltfError("scenes", R"([{"nodes":[0],"extras":{"a":1,"a":2}}])"),
              "scenes[0].extras has 'a' twice; allowed: once");
    EXPECT_EQ(materialError(R"("unknown":[{"a":1},{"a":1,"b":{"c":1,"a":1,"c":2}}])"),
              "materials[0].unknown has 'c' twice; allowed: once");
    const std::string both = R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],)";
    for (const char* part : {R"("translation":[1,0,0])", R"("scale":[1,1,1])"}) {
        EXPECT_EQ(gltfError("nodes", "[" + both + part + "}]"),
                  "nodes[0].matrix is beside a translation, rotation or scale; allowed: one or the "
                  "other");
    }
    EXPECT_EQ(gltfError("nodes", "[" + both + R"("scale":null}])"), "no error");
}

TEST_F(LoadMeaning, OfGltfWhatIsNullIsSaid) {
    Document document = square();
    document["nodes"] = R"([{"mesh":0,"scale":null}])";
    EXPECT_EQ(warningsOf("a.gltf", text(document)),
              Lines{"left out: the key 'nodes.scale', as it is null"});
}

TEST_F(LoadMeaning, RestsOfGltfAreSaid) {
    Document document = square();
    document["accessors"].replace(document["accessors"].find("\"count\":6"), 9, "\"count\":5");
    EXPECT_EQ(warningsOf("a.gltf", text(document)),
              (Lines{"left out: a corner behind the last triangle (2 times)",
                     "left out: a vertex that no triangle uses"}));
    document = square();
    document["nodes"] = R"([{"mesh":0,"camera":0}])";
    document["cameras"] =
        R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.5,"zfar":0.25}}])";
    const auto path = folder.write("a.gltf", text(document));
    EXPECT_EQ(
        errorText([&] { loadGltf(path); }, folder.path()),
        "DIR/a.gltf: camera 0: zfar 0.25 and znear 0.5; a zfar above znear, or none, is allowed");
    std::string json = text(square());
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) {
        const auto word32 = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&word32), 4);
    };
    const std::string glb =
        "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
    EXPECT_EQ(warningsOf("a.glb", glb), Lines{});
    EXPECT_EQ(warningsOf("a.glb", glb + "behind"),
              Lines{"left out: a byte behind the file's length (6 times)"});
}

/// As programs write them: image/jpg is no media type, and some have none.
TEST_F(LoadMeaning, DataOfAnyMediaTypeIsRead) {
    Document document = square();
    const std::string png =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg"
        "==";
    document["textures"] = R"([{"source":0}])";
    document["materials"] = R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    const auto load = [&](const std::string& uri) {
        document["images"] = R"([{"uri":")" + uri + R"("}])";
        return loadGltf(folder.write("a.gltf", text(document)));
    };
    for (const char* type : {"image/png", "image/jpg", "image/x-png;charset=utf8", ""}) {
        EXPECT_EQ(load(fmt::format("data:{};base64,{}", type, png)).textures.size(), 1U) << type;
    }
    EXPECT_EQ(errorText([&] { load("data:image/jpg," + std::string(200, 'a')); }, folder.path()),
              "DIR/a.gltf: image 0: 'data:image/jpg," + std::string(85, 'a') +
                  "…' (215 bytes) cannot be read");
    document.erase("images");
    document.erase("textures");
    document.erase("materials");
    document["accessors"] = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])";
    document["bufferViews"] = R"([{"buffer":0,"byteLength":36}])";
    document["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0}}]}])";
    document["buffers"] =
        R"([{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAA+"}])";
    const Scene scene = loadGltf(folder.write("a.gltf", text(document)));
    EXPECT_EQ(scene.bounds().max, glm::vec3(1, 1, 0.125F)) << "'+' is a digit";
}

TEST_F(LoadMeaning, ColoursThatNoSurfaceHasAreSaid) {
    Document document = square();
    document["materials"] = R"([{"pbrMetallicRoughness":{"baseColorFactor":[2,0,0,1],
        "metallicFactor":-0.5,"roughnessFactor":3}},
        {"emissiveFactor":[-1,0,0],"pbrMetallicRoughness":{"baseColorFactor":[1,-1,1,1]}}])";
    EXPECT_EQ(warningsOf("a.gltf", text(document)),
              (Lines{"taken as it is: a base colour or opacity outside of 0 to 1 (2 times)",
                     "taken as it is: a metallic factor outside of 0 to 1",
                     "taken as it is: a roughness outside of 0 to 1",
                     "taken as it is: an emissive colour below 0"}));
    folder.write("a.mtl", "newmtl a\nKd 255 0 0\nKe 5 5 5\nnewmtl b\nKd 1 1 1\nd 1\n");
    EXPECT_EQ(
        warningsOf("a.obj",
                   "mtllib a.mtl\nv 0 0 0 -1 0 0\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nusemtl a\nf 1 2 3\n"
                   "usemtl b\nf 1 2 3\n"),
        (Lines{"taken as it is: a base colour or opacity outside of 0 to 1",
               "taken as it is: a vertex colour below 0 (2 times)"}));
    EXPECT_EQ(warningsOf("a.ply",
                         "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                         "property float y\nproperty float z\nproperty float red\n"
                         "property float green\nproperty float blue\nend_header\n"
                         "0 0 0 0.5 -0.25 0\n1 0 0 1 1 1\n"),
              Lines{"taken as it is: a vertex colour below 0"});
}

TEST_F(LoadMeaning, OfMaterialFilesEachLineIsReadOrSaid) {
    const auto warnings = [&](const std::string& mtl) {
        folder.write("a.mtl", mtl);
        return warningsOf("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    };
    EXPECT_EQ(warnings("newmtl a\nKd 0.5\nKe 0 0 0 # none\nd -halo 1\nNs 9\n").size(), 1U);
    EXPECT_EQ(warnings("newmtl a\nKd 0.5 0.25\n"),
              Lines{"left out: the second of a colour's two numbers in a material file"});
    EXPECT_EQ(warnings("newmtl a\nKd 1 1 1 0.5\nNs 9 9\n"),
              (Lines{"left out: further words of the line 'Kd' of a material file",
                     "left out: further words of the line 'Ns' of a material file"}));
    EXPECT_EQ(warnings("# a file\n\nKd 1 0 0\nnewmtl a\nnewmtl a\nKd 0 1 0\nNs 1\n"),
              (Lines{"left out: a line of a material file that is of no material (3 times)",
                     "left out: a material of the name of one before it"}));
    folder.write("b.mtl", "newmtl a\nKd 0 1 0\n");
    folder.write("a.mtl", "newmtl a\nKd 1 0 0\n");
    const Scene scene = loadObj(folder.write(
        "a.obj",
        "mtllib a.mtl b.mtl\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"));
    EXPECT_EQ(scene.materials.at(0).baseColor.r, 1.0F);
    EXPECT_EQ(scene.warnings, Lines{"left out: a material of the name of one before it"});
}

TEST_F(LoadMeaning, MatricesOfNodesArePlacesAndNoProjections) {
    const auto error = [&](const char* numbers) {
        return gltfError("nodes", fmt::format(R"([{{"mesh":0,"matrix":[{}]}}])", numbers));
    };
    EXPECT_EQ(error("1,0,0,0,0,1,0,0,0,0,1,0.5,0,0,0,1"),
              "node 0: the last row of its matrix is 0, 0, 0.5, 1; 0, 0, 0, 1 is allowed");
    EXPECT_EQ(error("1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2"),
              "node 0: the last row of its matrix is 0, 0, 0, 2; 0, 0, 0, 1 is allowed");
    Document document = square();
    document["nodes"] = R"([{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,0.9999999]}])";
    const Scene scene = loadGltf(folder.write("a.gltf", text(document)));
    EXPECT_EQ(scene.instances.at(0).worldFromMesh, glm::mat4(1.0F));
}

/// Files are found by their bytes, else by what these are in UTF-8; materials by the latter.
TEST_F(LoadMeaning, NamesOfLatin1AreThoseOfUtf8) {
    folder.write("\u00FC.mtl", "newmtl \xFC\nmap_Kd \xE4.png\n");
    folder.write("\u00E4.png", image::encodePng(image::Image8(1, 1, 3)));
    const auto path = folder.write("a.obj",
                                   "mtllib \xFC.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                   "usemtl \u00FC\nf 1/1 2/1 3/1\n");
    const Scene scene = loadScene(path);
    EXPECT_EQ(scene.warnings, std::vector<std::string>{});
    EXPECT_EQ(scene.materials.at(0).name, "\u00FC");
    EXPECT_EQ(scene.materials.at(0).baseColorTexture, 0);
    std::vector<fs::path> opened = scene.filesBeside;
    std::ranges::sort(opened);
    EXPECT_EQ(opened, filesBeside(path));
    // That of its own bytes goes first.
    folder.write("\xFC.mtl", "newmtl \u00FC\nKd 0 1 0\n");
    EXPECT_EQ(loadScene(path).materials.at(0).baseColor, glm::vec4(0, 1, 0, 1));
}

TEST_F(LoadMeaning, NamesOfLatin1AreMadeUtf8) {
    folder.write("a.mtl", "newmtl gr\xFCn\nKd 0 1 0\nnewmtl \u00FC\nKd 1 0 0\nK\xFC 1\n");
    const Scene scene = loadScene(folder.write("\xFC.obj",
                                               "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                               "usemtl gr\xFCn\nf 1 2 3\nusemtl \u00FC\n"
                                               "f 1 2 3\n"));
    EXPECT_EQ(scene.materials.at(0).name, "gr\u00FCn");
    EXPECT_EQ(scene.materials.at(1).name, "\u00FC");
    EXPECT_EQ(scene.warnings, Lines{"left out: 'K\u00FC' of a material file"});
    saveGlb(folder.path() / "a.glb", scene);
    const Scene saved = loadScene(folder.path() / "a.glb");
    EXPECT_EQ(saved.materials.at(0).name, "gr\u00FCn");
    EXPECT_EQ(saved.meshes.at(0).name, scene.meshes.at(0).name);
}

struct PlyMeaning : LoadMeaning {
    static std::string ply(const std::string& properties, const std::string& rows) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\n" +
               properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
               rows;
    }
};

TEST_F(PlyMeaning, PropertiesAreDeclaredOnce) {
    const auto path = folder.write("a.ply", ply("property float x\n", ""));
    EXPECT_EQ(errorText([&] { loadPly(path); }, folder.path()),
              "DIR/a.ply:7: property 'x' of element 'vertex' is declared twice");
    // What nobody reads fills rows up; under two names, and of faces, the first is taken.
    const std::string gaps = ply("property uchar gap\nproperty uchar gap\n",
                                 "0 0 0 9 9\n1 0 0 9 9\n0 1 0 9 9\n3 0 1 2\n");
    EXPECT_EQ(warningsOf("a.ply", gaps),
              Lines{"left out: the property 'gap' of vertices (2 times)"});
    const Scene scene = loadPly(
        folder.write("a.ply", ply("property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                  "property uchar diffuse_red\n",
                                  "0 0 0 255 0 0 9\n1 0 0 255 0 0 9\n0 1 0 255 0 0 9\n3 0 1 2\n")));
    EXPECT_EQ(scene.meshes.at(0).colors.at(0), glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.warnings, Lines{"left out: the property 'diffuse_red' of vertices"});
    std::string twice = ply("", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 1 2\n");
    twice.insert(twice.find("end_header"), "property list uchar int vertex_index\n");
    const Scene faces = loadPly(folder.write("a.ply", twice));
    EXPECT_EQ(faces.triangleCount(), 1U);
    EXPECT_EQ(faces.warnings, Lines{"left out: the property 'vertex_index' of faces"});
}

/// A number too many, and one too few, shift all that follow.
TEST_F(PlyMeaning, RowsAreLines) {
    EXPECT_EQ(warningsOf("a.ply", ply("", "0 0 0 \r\n1 0 0\n\n0 1 0\n3 0 1 2")), Lines{});
    const std::string told =
        " within a line: numbers are read in their order, whichever line has them";
    EXPECT_EQ(warningsOf("a.ply", ply("", "0 0 0 1 0 0\n0 1 0\n3 0 1 2\n")),
              Lines{"1 row ends" + told});
    EXPECT_EQ(warningsOf("a.ply", ply("", "0 0\n0 1 0\n0 0 1 0\n3 0 1 2\n")),
              Lines{"2 rows end" + told});
}

// Real models: what other programs counted in them, less the vertices that no triangle uses (1,113
// of the bunny, 2 of the small dragon).

struct Known {
    const char* file;
    std::size_t vertices;  // that triangles use
    std::size_t triangles;
    glm::vec3 min;  // to three decimals
    glm::vec3 max;
};

void PrintTo(const Known& known, std::ostream* out) {
    *out << known.file;
}

/// All that the file holds, as it stands there (bounds before the node matrices).
struct Measured {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    Box box;
};

Measured measured(const Scene& scene) {
    Measured result{scene.points.positions.size(), 0, scene.points.bounds()};
    for (const Mesh& mesh : scene.meshes) {
        result.vertices += mesh.positions.size();
        result.triangles += mesh.triangles.size();
        result.box.add(mesh.bounds());
        const auto isInside = [&](const glm::uvec3& triangle) {
            return std::max({triangle.x, triangle.y, triangle.z}) < mesh.positions.size();
        };
        EXPECT_TRUE(std::all_of(mesh.triangles.begin(), mesh.triangles.end(), isInside));
    }
    return result;
}

class LoadAssets : public testing::TestWithParam<Known> {};

TEST_P(LoadAssets, HaveTheirKnownCounts) {
    const Known& known = GetParam();
    const auto path = test::asset(known.file);
    if (!path) GTEST_SKIP() << "the asset " << known.file << " is missing";
    const Scene scene = loadScene(*path);
    const Measured found = measured(scene);
    EXPECT_EQ(found.vertices, known.vertices);
    EXPECT_EQ(found.triangles, known.triangles);
    if (known.min != known.max) {
        const float tolerance = 0.0005F * 1.01F;  // half of the last decimal printed
        EXPECT_TRUE(glm::all(
            glm::lessThanEqual(glm::abs(found.box.min - known.min), glm::vec3(tolerance))));
        EXPECT_TRUE(glm::all(
            glm::lessThanEqual(glm::abs(found.box.max - known.max), glm::vec3(tolerance))));
    }
    EXPECT_EQ(scene.origin.sha256.size(), 64U);
}

INSTANTIATE_TEST_SUITE_P(
    Files, LoadAssets,
    testing::Values(
        Known{"bunny/bun_zipper.ply", 34834, 69451, {-0.095, 0.033, -0.062}, {0.061, 0.187, 0.059}},
        Known{"dragon/dragon_vrip.ply",
              437645,
              871414,
              {-0.108, 0.053, -0.05},
              {0.097, 0.197, 0.041}},
        Known{"dragon/dragon_vrip_res4.ply",
              5203,
              11102,
              {-0.108, 0.053, -0.05},
              {0.095, 0.196, 0.041}},
        Known{"buddha/buddha_100k.obj",
              49950,
              100000,
              {-0.461, -1.002, -0.324},
              {0.352, 0.978, 0.49}},
        Known{"blade/turbineblade.ply",
              99519,
              199034,
              {-10.929, -5.967, 106.086},
              {11.588, 9.066, 148.86}},
        Known{"lion/lion_takanawa_points.ply",
              341989,
              0,
              {-4.985, 1.039, -3.445},
              {-0.789, 6.723, 1.123}},
        Known{"living-room/grey_white_room.glb",
              119519,
              143163,
              {-0.513, -0.003, -3.635},
              {5.123, 2.879, 0.593}},
        Known{"bathroom/salle_de_bain.glb",
              437356,
              653694,
              {-13.75, -6.413, -11.639},
              {12.642, 16.11, 17.62}},
        Known{"dining-room/breakfast_room.glb",
              142720,
              269538,
              {-6.353, -1.521, -4.542},
              {5.263, 7.903, 9.888}},
        Known{"city/delft.ply", 18262, 36267, {0.468, 0.999, 0.548}, {524.839, 328.636, 17.846}},
        Known{"living-room/obj/Mesh012.obj", 6485, 12708, {}, {}},
        Known{"gltf/gltf_transform_core/BoxTextured_glTF/BoxTextured.gltf", 24, 12, {}, {}},
        Known{"gltf/gltf_transform_core/Box_glTF-Binary/Box.glb", 24, 12, {}, {}},
        Known{"gltf/gltf_transform_core/Box_glTF-Embedded/Box.gltf", 24, 12, {}, {}},
        Known{"gltf/gltf_transform_functions/TwoCubes.glb", 48, 24, {}, {}}));

TEST(LoadRoom, HasTexturesMaterialsAndACamera) {
    const auto path = test::asset("living-room/grey_white_room.glb");
    if (!path) GTEST_SKIP() << "the asset living-room/grey_white_room.glb is missing";
    const Scene scene = loadGltf(*path);
    EXPECT_EQ(scene.materials.size(), 19U);
    EXPECT_EQ(scene.textures.size(), 4U);
    EXPECT_EQ(scene.cameras.size(), 1U);
}

}  // namespace
}  // namespace gfxrepro::scene
