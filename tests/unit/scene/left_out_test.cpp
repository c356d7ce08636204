// Files with all that their formats have: what is not used is said, once for each kind.
#include "engine/scene/left_out.h"

#include <algorithm>
#include <string>

#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

using Lines = std::vector<std::string>;

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
