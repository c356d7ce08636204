#include <fmt/format.h>

#include <cmath>
#include <string>

#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

struct LoadGltf : FolderTest {
    LoadGltf() { folder.write("square.bin", squareBytes()); }

    Scene load(const Document& document) {
        return loadGltf(folder.write("a.gltf", text(document)));
    }
    Scene loadWith(const std::string& key, const std::string& value) {
        Document document = square();
        document[key] = value;
        return load(document);
    }
    std::string error(const std::string& content) {
        const auto path = folder.write("a.gltf", content);
        return errorText([&] { loadGltf(path); }, folder.path());
    }
    std::string errorWith(const std::string& key, const std::string& value) {
        Document document = square();
        document[key] = value;
        return error(text(document));
    }
};

TEST_F(LoadGltf, ReadsASquare) {
    const Scene scene = load(square());
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.name, "m");
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
    EXPECT_TRUE(mesh.isFlat) << "it has no normals";
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(scene.instances.at(0).worldFromMesh, glm::mat4(1.0F));
}

TEST_F(LoadGltf, ReadsBinaryFiles) {
    Document document = square();
    document["buffers"] = R"([{"byteLength":76}])";
    std::string json = text(document);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) {
        const auto word32 = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&word32), 4);
    };
    const std::string data = squareBytes();
    const std::string content = "glTF" + word(2) + word(28 + json.size() + data.size()) +
                                word(json.size()) + "JSON" + json + word(data.size()) +
                                std::string("BIN\0", 4) + data;
    EXPECT_EQ(loadGltf(folder.write("a.glb", content)).triangleCount(), 2U);
    const auto path = folder.write("a.glb", content.substr(0, content.size() - 4));
    EXPECT_EQ(errorText([&] { loadGltf(path); }, folder.path()), "DIR/a.glb: Invalid glTF binary.");
}

TEST_F(LoadGltf, ConvertsNormalizedIntegers) {
    const Scene scene = loadWith(
        "meshes", R"([{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":2,"TEXCOORD_0":3}}]}])");
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.colors[0], glm::vec3(1, 0, 0.2F));
    EXPECT_EQ(mesh.texcoords[1], glm::vec2(1, -1));  // 127 and −127
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{"left out: a corner behind the last triangle",
                                        "left out: a vertex that no triangle uses",
                                        "left out: the alpha of vertex colours"}));
}

TEST_F(LoadGltf, ColoursAreFloatsOrNormalized) {
    Document document = square();
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":2},"indices":1}]}])";
    std::string& accessors = document["accessors"];
    const std::size_t colours = accessors.find(R"("type":"VEC4","normalized":true)");
    accessors.replace(colours + 14, 17, R"("normalized":false)");
    const auto error = [&] { return errorText([&] { load(document); }, folder.path()); };
    const std::string refused =
        "DIR/a.gltf: accessor 2 has colours in integers that are not normalized; floats, or "
        "normalized unsigned bytes or shorts are allowed";
    EXPECT_EQ(error(), refused);
    accessors.replace(colours + 14, 18, R"("normalized":true)");
    EXPECT_EQ(error(), "no error");
    accessors.replace(accessors.find("5121"), 4, "5120");
    EXPECT_EQ(error(), refused) << "signed";
    // Floats above 1 stay, as nothing says what is meant.
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":0},"indices":1}]}])";
    EXPECT_EQ(load(document).warnings, std::vector<std::string>{});
    const float nine = 9.0F;
    std::string bytes = squareBytes();
    bytes.replace(12, sizeof(nine), reinterpret_cast<const char*>(&nine), sizeof(nine));
    folder.write("square.bin", bytes);
    const Scene scene = load(document);
    EXPECT_EQ(scene.meshes.at(0).colors.at(1), glm::vec3(9, 0, 0));
    EXPECT_EQ(scene.warnings,
              std::vector<std::string>{
                  "vertex colours reach 9, above the 1 of glTF; they are taken as they are"});
}

TEST_F(LoadGltf, ReadsStripsAndFansWithTheirOutside) {
    const auto triangles = [this](int mode) {
        return loadWith("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"mode":)" +
                                      std::to_string(mode) + "}]}]")
            .meshes.at(0)
            .triangles;
    };
    EXPECT_EQ(triangles(5), (std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(triangles(6), (std::vector<glm::uvec3>{{1, 2, 0}, {2, 3, 0}}));
}

TEST_F(LoadGltf, ReadsPointsAndRefusesLinesAlone) {
    const std::string points = R"([{"primitives":[{"attributes":{"POSITION":0},"mode":0},
                                                  {"attributes":{"POSITION":0},"mode":1}]}])";
    Document document = square();
    document["meshes"] = points;
    document["nodes"] = R"([{"mesh":0,"translation":[0,0,5]}])";
    EXPECT_EQ(load(document).points.positions.at(1), glm::vec3(1, 0, 5));
    EXPECT_EQ(errorWith("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"mode":1}]}])"),
              "DIR/a.gltf: no triangles or points in the scene");
}

TEST_F(LoadGltf, ReadsThosePointsThatIndicesName) {
    Document document = square();
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":2},"indices":1,"mode":0}]}])";
    document["accessors"] =
        R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
            {"bufferView":1,"byteOffset":2,"componentType":5123,"count":3,"type":"SCALAR"},
            {"bufferView":2,"componentType":5121,"count":4,"type":"VEC4","normalized":true}])";
    const PointCloud points = load(document).points;  // 1 2 0, without the corner (0, 1)
    EXPECT_EQ(points.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
    ASSERT_EQ(points.colors.size(), 3U);
    EXPECT_EQ(points.colors[0], glm::vec3(1, 0, 0.2F));
    document["accessors"].replace(document["accessors"].find("\"byteOffset\":2"), 14,
                                  "\"byteOffset\":6");
    EXPECT_EQ(load(document).points.positions,  // 0 2 3
              (std::vector<glm::vec3>{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    document["accessors"].replace(document["accessors"].find("\"byteOffset\":6"), 14,
                                  "\"byteOffset\":4");
    EXPECT_EQ(load(document).points.positions,  // 2 0 2: each point once
              (std::vector<glm::vec3>{{0, 0, 0}, {1, 1, 0}}));
}

TEST_F(LoadGltf, SaysOfPointsWhatIsTrueOfThem) {
    Document document = square();
    document["accessors"].insert(
        document["accessors"].size() - 1,
        R"(,{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"})");
    const auto warnings = [&](const char* primitives) {
        document["meshes"] = fmt::format(R"([{{"primitives":[{}]}}])", primitives);
        return load(document).warnings;
    };
    using Lines = std::vector<std::string>;
    EXPECT_EQ(warnings(R"({"attributes":{"POSITION":0},"indices":4,"mode":0})"),
              Lines{"left out: a vertex that no point uses"});
    EXPECT_EQ(warnings(R"({"attributes":{"POSITION":0},"indices":4,"mode":0},
                          {"attributes":{"POSITION":0},"indices":4})"),
              Lines{"left out: a vertex that no triangle and no point uses"});
    EXPECT_EQ(warnings(R"({"attributes":{"POSITION":0},"mode":0},
                          {"attributes":{"POSITION":0},"indices":4})"),
              Lines{});
    EXPECT_EQ(warnings(R"({"attributes":{"POSITION":0,"NORMAL":0},"mode":0},
                          {"attributes":{"POSITION":0},"mode":0})"),
              Lines{"left out: normals that not all points have (4 times)"});
}

TEST_F(LoadGltf, PointsHaveTheBaseColourOfTheirMaterial) {
    Document document = square();
    const auto loaded = [&](const char* more) {
        document["materials"] = fmt::format(
            R"([{{"pbrMetallicRoughness":{{"baseColorFactor":[0,0.5,1,1]{}}}}}])", more);
        return load(document);
    };
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0},"mode":0},
            {"attributes":{"POSITION":0,"COLOR_0":2},"mode":0,"material":0},
            {"attributes":{"POSITION":0,"TEXCOORD_0":3},"mode":0,"material":0}]}])";
    const Scene plain = loaded("");
    const std::vector<glm::vec3>& colors = plain.points.colors;
    ASSERT_EQ(colors.size(), 12U);
    EXPECT_EQ(colors[0], glm::vec3(1));
    EXPECT_EQ(colors[4], glm::vec3(0, 0, 0.2F));
    EXPECT_EQ(colors[8], glm::vec3(0, 0.5F, 1));
    EXPECT_EQ(plain.warnings, std::vector<std::string>{"left out: the alpha of vertex colours"});
    EXPECT_EQ(loaded(R"(,"metallicFactor":0)").warnings, plain.warnings);
    EXPECT_EQ(loaded(R"(,"roughnessFactor":0.5)").warnings,
              (std::vector<std::string>{
                  "left out: the alpha of vertex colours",
                  "left out: what a material of points has beside its base colour (2 times)"}));
}

TEST_F(LoadGltf, KeepsNormalsOfPointsInAFlattenedNode) {
    Document document = square();
    document["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"mode":0}]}])";
    document["nodes"] = R"([{"mesh":0,"scale":[0,1,1]}])";
    EXPECT_EQ(load(document).points.normals.at(1), glm::vec3(1, 0, 0));
}

TEST_F(LoadGltf, AppliesTheNodeTree) {
    const Scene scene = loadWith("nodes",
                                 R"([{"children":[1],"translation":[1,0,0]},
                {"mesh":0,"rotation":[0,0,0.70710678,0.70710678],"scale":[2,2,2]}])");
    const glm::vec4 corner = scene.instances.at(0).worldFromMesh * glm::vec4(1, 0, 0, 1);
    EXPECT_LT(glm::length(corner - glm::vec4(1, 2, 0, 1)), 1e-6F);
}

TEST_F(LoadGltf, TurnsByRotationsOfAnyLength) {
    const Scene scene = loadWith("nodes", R"([{"mesh":0,"rotation":[0,0,1,1]}])");
    const glm::vec4 corner = scene.instances.at(0).worldFromMesh * glm::vec4(1, 0, 0, 1);
    EXPECT_LT(glm::length(corner - glm::vec4(0, 1, 0, 1)), 1e-6F);
    EXPECT_EQ(scene.warnings, std::vector<std::string>{
                                  "left out: the length of a node's rotation, which is not 1"});
}

TEST_F(LoadGltf, SaysThatATextureHasNoCoordinates) {
    Document document = square();
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_1":3},"material":0}]}])";
    document["materials"] = R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    document["images"] =
        R"([{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="}])";
    document["textures"] = R"([{"source":0}])";
    EXPECT_THAT(load(document).warnings,
                Contains("left out: a texture of a mesh without TEXCOORD_0"));
}

TEST_F(LoadGltf, SaysWhatItsSceneDoesNotHave) {
    Document document = square();
    document["nodes"] = R"([{"mesh":0},{"mesh":0,"children":[2]},{"mesh":0}])";
    document["scenes"] = R"([{"nodes":[0]},{"nodes":[1]}])";
    EXPECT_EQ(load(document).warnings,
              std::vector<std::string>{"left out: a node that is not in the scene (2 times)"});
    document["scene"] = "1";
    EXPECT_EQ(load(document).warnings,
              std::vector<std::string>{"left out: a node that is not in the scene"});
}

TEST_F(LoadGltf, ReadsSparseAccessors) {
    // Index 1 (of the index list's second entry) of an accessor without data gets corner 2.
    const Mesh mesh =
        loadWith("accessors",
                 R"([{"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,
                "indices":{"bufferView":1,"byteOffset":2,"componentType":5123},
                "values":{"bufferView":0,"byteOffset":24}}},
               {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}])")
            .meshes.at(0);
    EXPECT_EQ(mesh.positions[0], glm::vec3(0));
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 1, 0));
}

TEST_F(LoadGltf, RefusesOffsetsBelowZero) {
    const auto accessors = [](const std::string& offset) {
        return R"([{"bufferView":0,"byteOffset" : )" + offset +
               R"(,"componentType":5126,"count":4,"type":"VEC3"},
               {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}])";
    };
    EXPECT_EQ(errorWith("accessors", accessors("0")), "no error");
    for (const std::string offset : {"-4", "1.5"}) {
        EXPECT_EQ(errorWith("accessors", accessors(offset)),
                  "DIR/a.gltf: accessors[0].byteOffset is " + offset +
                      "; allowed: a whole number from 0");
    }
}

TEST_F(LoadGltf, ReadsInstancesOfNodes) {
    Document document = square();
    document["extensionsRequired"] = R"(["EXT_mesh_gpu_instancing"])";
    document["nodes"] = R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":
                            {"attributes":{"TRANSLATION":0}}}}])";
    const Scene scene = load(document);
    ASSERT_EQ(scene.instances.size(), 4U);
    EXPECT_EQ(scene.instances[2].worldFromMesh[3], glm::vec4(1, 1, 0, 1));
}

TEST_F(LoadGltf, ReadsMaterialsAndCameras) {
    Document document = square();
    document["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_1":3},"material":0}]}])";
    document["materials"] = R"([{"name":"lamp","emissiveFactor":[1,0.5,0],"alphaMode":"MASK",
        "alphaCutoff":0.25,"doubleSided":true,
        "pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,
            "baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
                {"texCoord":1,"offset":[10,20],"rotation":1.5707963267948966,"scale":[2,3]}}}},
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":8},
            "KHR_materials_unlit":{},"KHR_materials_ior":{"ior":1.25},
            "KHR_materials_transmission":{"transmissionFactor":0.75}}}])";
    // A single white pixel.
    document["images"] =
        R"([{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="}])";
    document["textures"] = R"([{"source":0}])";
    document["cameras"] =
        R"([{"name":"eye","type":"perspective","perspective":{"yfov":0.5,"znear":0.125,"zfar":50}}])";
    document["nodes"] = R"([{"mesh":0,"camera":0,"translation":[1,2,3]}])";
    const Scene scene = load(document);
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.name, "lamp");
    EXPECT_EQ(material.baseColor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(material.metallic, 0.5F);
    EXPECT_EQ(material.roughness, 1.0F);
    EXPECT_EQ(material.emissive, glm::vec3(8, 4, 0));
    EXPECT_EQ(material.alphaCutoff, 0.25F);
    EXPECT_TRUE(material.isDoubleSided);
    EXPECT_TRUE(material.isUnlit);
    EXPECT_EQ(material.indexOfRefraction, 1.25F);
    EXPECT_EQ(material.transmission, 0.75F);
    EXPECT_EQ(material.baseColorTexture, 0);
    EXPECT_EQ(scene.textures.at(0).channels(), 3);
    EXPECT_EQ(scene.textures.at(0).at(0, 0), 255);
    // (1, −1) · (2, 3) = (2, −3), turned by a quarter: (−3, −2).
    EXPECT_LT(glm::length(scene.meshes.at(0).texcoords[1] - glm::vec2(7, 18)), 1e-5F);
    const Camera& camera = scene.cameras.at(0);
    EXPECT_EQ(camera.name, "eye");
    EXPECT_EQ(camera.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(camera.target, glm::vec3(1, 2, 2));
    EXPECT_EQ(camera.verticalFovRad, 0.5F);
    EXPECT_EQ(camera.nearM, 0.125F);
    EXPECT_EQ(camera.farM, 50.0F);
}

constexpr const char* kWhitePixel =
    R"([{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="}])";

TEST_F(LoadGltf, ReadsTexturesOfMaterials) {
    Document document = square();
    document["materials"] = R"([{"name":"metal","normalTexture":{"index":1,"scale":0.5},
        "emissiveTexture":{"index":0},"occlusionTexture":{"index":7},
        "pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}}},
        {"name":"two sets","pbrMetallicRoughness":{"baseColorTexture":{"index":0},
            "metallicRoughnessTexture":{"index":0,"texCoord":1}},
            "normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[1,0]}}},
            "emissiveTexture":{"index":0}}])";
    document["images"] = kWhitePixel;
    document["textures"] = R"([{"source":0},{"source":0}])";
    const Scene scene = load(document);
    ASSERT_EQ(scene.textures.size(), 1U);  // an image is decoded once
    const Material& metal = scene.materials.at(0);
    EXPECT_EQ(metal.baseColorTexture, -1);
    EXPECT_EQ(metal.metallicRoughnessTexture, 0);
    EXPECT_EQ(metal.normalTexture, 0);
    EXPECT_EQ(metal.normalScale, 0.5F);
    EXPECT_EQ(metal.emissiveTexture, 0);
    const Material& twoSets = scene.materials.at(1);
    EXPECT_EQ(twoSets.baseColorTexture, 0);
    EXPECT_EQ(twoSets.metallicRoughnessTexture, -1);
    EXPECT_EQ(twoSets.normalTexture, -1);
    EXPECT_EQ(twoSets.emissiveTexture, 0);
    EXPECT_EQ(scene.warnings, (std::vector<std::string>{
                                  "material 'two sets': its metallic-roughness texture is left "
                                  "out, as it reads other texture coordinates than those before it",
                                  "material 'two sets': its normal texture is left out, as it "
                                  "reads other texture coordinates than those before it",
                                  "left out: the key 'materials.occlusionTexture'"}));
}

TEST_F(LoadGltf, ReadsSamplers) {
    Document document = square();
    document["images"] = kWhitePixel;
    document["samplers"] =
        R"([{"wrapS":33071,"magFilter":9728,"minFilter":9728},{"wrapT":33648,"minFilter":9987},{}])";
    document["textures"] = R"([{"source":0},{"source":0,"sampler":0},{"source":0,"sampler":1},
        {"source":0,"sampler":2}])";
    document["materials"] = R"([{"normalTexture":{"index":0},"emissiveTexture":{"index":1}},
        {"normalTexture":{"index":2},"emissiveTexture":{"index":3}}])";
    const Scene scene = load(document);
    EXPECT_EQ(scene.textures.size(), 3U) << "one for each way to read the image";
    EXPECT_EQ(scene.materials.at(1).emissiveTexture, scene.materials.at(0).normalTexture);
    const Sampling clamped{Sampling::Wrap::Clamp, Sampling::Wrap::Repeat, true};
    EXPECT_EQ(samplingOf(scene, scene.materials[0].emissiveTexture), clamped);
    const Sampling mirrored{Sampling::Wrap::Repeat, Sampling::Wrap::Mirror, false};
    EXPECT_EQ(samplingOf(scene, scene.materials[1].normalTexture), mirrored);
    EXPECT_EQ(samplingOf(scene, scene.materials[0].normalTexture), Sampling{});
    EXPECT_EQ(scene.warnings,
              std::vector<std::string>{
                  "left out: a sampler's minFilter other than LINEAR_MIPMAP_LINEAR"});
}

TEST_F(LoadGltf, TakesPointLightsWithTheirShareOfWhatAllGive) {
    Document document = square();
    document["extensionsRequired"] = R"(["KHR_lights_punctual"])";
    document["extensions"] = R"({"KHR_lights_punctual":{"lights":[
        {"type":"point","color":[1,0.5,0],"intensity":200},{"type":"spot","intensity":100,"spot":{}},
        {"type":"directional","intensity":3}]}})";
    const auto lamp = [](const char* light, const char* place) {
        return fmt::format(
            R"({{"translation":{},"extensions":{{"KHR_lights_punctual":{{"light":{}}}}}}})", place,
            light);
    };
    document["nodes"] = "[{\"mesh\":0}," + lamp("0", "[1,2,3]") + "," + lamp("1", "[0,0,1]") + "," +
                        lamp("2", "[0,0,0]") + "]";
    document["scenes"] = R"([{"nodes":[0,1,2,3]}])";
    const Scene scene = load(document);
    ASSERT_EQ(scene.lights.size(), 2U);
    EXPECT_EQ(scene.lights[0].position, glm::vec3(1, 2, 3));
    EXPECT_LT(glm::distance(scene.lights[0].intensity, glm::vec3(0.6F, 0.3F, 0)), 1e-6F);
    EXPECT_LT(glm::distance(scene.lights[1].intensity, glm::vec3(0.3F)), 1e-6F);
    EXPECT_FLOAT_EQ(scene.lights[1].radiusM, std::sqrt(0.5F));
    EXPECT_EQ(scene.warnings, (std::vector<std::string>{"1 spot light shines in all directions",
                                                        "1 directional light is left out"}));

    document["nodes"] = "[{\"mesh\":0}," + lamp("7", "[0,0,0]") + "]";
    document["scenes"] = R"([{"nodes":[0,1]}])";
    EXPECT_EQ(error(text(document)), "DIR/a.gltf: node 1: light 7 does not exist; there are 3");
    document["extensions"] =
        R"({"KHR_lights_punctual":{"lights":[{"type":"point","intensity":-1}]}})";
    document["nodes"] = "[{\"mesh\":0}," + lamp("0", "[0,0,0]") + "]";
    EXPECT_EQ(error(text(document)),
              "DIR/a.gltf: light 0: intensity -1 of a channel; 0 and more is allowed");
}

TEST_F(LoadGltf, LeavesOutExtrasThatItCannotRead) {
    for (const char* paths :
         {"[1]", R"([{"name":"a"}])", R"([{"name":"a","keys":[]}])", R"([{"name":1,"keys":[{}]}])",
          R"([{"name":"a","keys":[{"position":[0,0,0],"target":[0,0,0],"up":[0,1,0],"yfov":1,
              "znear":1,"zfar":2}]}])",
          R"([{"name":"a","keys":[{"position":[0,0,1e99],"target":[0,0,0],"up":[0,1,0],"yfov":1,
              "znear":1,"zfar":2}]}])"}) {
        Document document = square();
        document["nodes"] = R"([{"mesh":0,"extras":{"motion":{"pivot":[0,0]}}}])";
        document["scenes"] =
            fmt::format(R"([{{"nodes":[0],"extras":{{"camera_paths":{}}}}}])", paths);
        const Scene scene = load(document);
        EXPECT_TRUE(scene.paths.empty() && scene.motions.empty()) << paths;
        EXPECT_EQ(scene.warnings, (std::vector<std::string>{
                                      "left out: a camera path among extras that cannot be read",
                                      "left out: a motion among extras that cannot be read"}))
            << paths;
    }
    // Those of others, of any form.
    EXPECT_EQ(loadWith("scenes", R"([{"nodes":[0],"extras":[1]}])").warnings.size(), 0U);
    EXPECT_EQ(loadWith("scenes", R"([{"nodes":[0],"extras":{"camera_paths":1}}])").paths.size(),
              0U);
}

TEST_F(LoadGltf, RefusesTexturesThatAreNotThere) {
    Document document = square();
    document["images"] = kWhitePixel;
    document["textures"] = R"([{"source":0}])";
    for (const char* texture :
         {R"("pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":3}})",
          R"("normalTexture":{"index":3})", R"("emissiveTexture":{"index":3})"}) {
        document["materials"] = std::string("[{") + texture + "}]";
        EXPECT_EQ(error(text(document)), "DIR/a.gltf: texture 3 does not exist; there are 1");
    }
}

TEST_F(LoadGltf, AimsCamerasAtTheMiddleOfTheScene) {
    Document document = square();  // from (0, 0, 0) to (1, 1, 0)
    document["cameras"] = R"([{"type":"perspective","perspective":{"yfov":0.5,"znear":0.125}}])";
    document["nodes"] = R"([{"mesh":0},{"camera":0,"translation":[0.25,2,5]},
        {"camera":0,"translation":[0.25,2,5],"rotation":[0,1,0,0]},
        {"camera":0,"translation":[0.25,2,5],"extras":{"target_m":3}}])";
    document["scenes"] = R"([{"nodes":[0,1,2,3]}])";
    const Scene scene = load(document);
    ASSERT_EQ(scene.cameras.size(), 3U);
    EXPECT_EQ(scene.cameras[0].target, glm::vec3(0.25F, 2, 0)) << "nearest to (0.5, 0.5, 0)";
    EXPECT_LT(glm::length(scene.cameras[1].target - glm::vec3(0.25F, 2, 6)), 1e-6F)
        << "the middle lies behind the eye";
    EXPECT_EQ(scene.cameras[2].target, glm::vec3(0.25F, 2, 2)) << "as the file says";
}

TEST_F(LoadGltf, DecodesPercentSignsAndStaysInItsFolder) {
    folder.write("sub/the square.bin", squareBytes());
    EXPECT_EQ(loadWith("buffers", R"([{"byteLength":76,"uri":"sub/../sub/the%20square.bin"}])")
                  .triangleCount(),
              2U);
    EXPECT_EQ(errorWith("buffers", R"([{"byteLength":76,"uri":"../square.bin"}])"),
              "DIR/a.gltf: the URI '../square.bin' leaves the file's folder");
    EXPECT_EQ(errorWith("buffers", R"([{"byteLength":76,"uri":"/etc/passwd"}])"),
              "DIR/a.gltf: the URI '/etc/passwd' leaves the file's folder");
    EXPECT_EQ(errorWith("buffers", R"([{"byteLength":76,"uri":"sub/%2e%2e/%2e%2e/x"}])"),
              "DIR/a.gltf: the URI 'sub/../../x' leaves the file's folder");
    EXPECT_EQ(errorWith("buffers", R"([{"byteLength":76,"uri":"gone.bin"}])"),
              "DIR/a.gltf: the file 'gone.bin' is not beside it");
}

TEST_F(LoadGltf, FindsFilesByAnyName) {
    const auto named = [](const std::string& uri) {
        return R"([{"byteLength":76,"uri":")" + uri + R"("}])";
    };
    EXPECT_EQ(errorWith("buffers", named("100%.bin")),
              "DIR/a.gltf: the file '100%.bin' is not beside it");
    EXPECT_EQ(errorWith("buffers", named("%FC.bin")),
              "DIR/a.gltf: the file '\u00FC.bin' is not beside it");
    EXPECT_EQ(errorWith("buffers", named("%41+%zz.bin")),
              "DIR/a.gltf: the file 'A+%zz.bin' is not beside it");
    for (const char* name : {"100%.bin", "\u00FC.bin", "A+%zz.bin"}) {
        folder.write(name, squareBytes());
    }
    for (const char* uri : {"100%.bin", "%FC.bin", "%C3%BC.bin", "\u00FC.bin", "%41+%zz.bin"}) {
        EXPECT_EQ(loadWith("buffers", named(uri)).triangleCount(), 2U) << uri;
    }
}

// What lies outside is there and would serve: it is not looked at by the parser's own means either.
TEST_F(LoadGltf, ReadsNothingOutsideOfItsFolder) {
    folder.write("outside.bin", squareBytes());
    const auto refusal = [&](const std::string& key, const std::string& value) {
        Document document = square();
        document["buffers"] = R"([{"byteLength":76,"uri":"inside.bin"}])";
        document[key] = value;
        folder.write("model/inside.bin", squareBytes());
        const auto path = folder.write("model/a.gltf", text(document));
        return errorText([&] { loadGltf(path); }, folder.path());
    };
    const std::string absolute = (folder.path() / "outside.bin").string();
    const std::string outside =
        "DIR/model/a.gltf: the URI '../outside.bin' leaves the file's folder";
    EXPECT_EQ(refusal("buffers", R"([{"byteLength":76,"uri":"../outside.bin"}])"), outside);
    EXPECT_EQ(refusal("images", R"([{"uri":"../outside.bin"}])"), outside);
    EXPECT_EQ(refusal("buffers", R"([{"byteLength":76,"uri":")" + absolute + R"("}])"),
              "DIR/model/a.gltf: the URI 'DIR/outside.bin' leaves the file's folder");
    EXPECT_EQ(refusal("asset", R"({"version":"2.0"})"), "no error") << "what lies inside is read";
}

TEST_F(LoadGltf, RefusesWhatItCannotRead) {
    EXPECT_EQ(errorWith("asset", R"({"version":"1.0"})"),
              "DIR/a.gltf: glTF version '1.0'; 2.0 is read");
    EXPECT_EQ(errorWith("asset", R"({"version":"2.0","minVersion":"2.1"})"),
              "DIR/a.gltf: needs glTF version '2.1' at least; 2.0 is read");
    EXPECT_EQ(errorWith("extensionsRequired", R"(["KHR_draco_mesh_compression","X"])"),
              "DIR/a.gltf: requires the extension KHR_draco_mesh_compression, X; supported are "
              "EXT_mesh_gpu_instancing, KHR_lights_punctual, KHR_materials_emissive_strength, "
              "KHR_materials_ior, KHR_materials_transmission, KHR_materials_unlit, "
              "KHR_mesh_quantization, KHR_node_visibility, KHR_texture_transform");
    EXPECT_EQ(errorWith("extras", std::string(300, '[') + std::string(300, ']')),
              "DIR/a.gltf: is nested deeper than 200 levels");
    EXPECT_EQ(error("{\"asset\": {\"version\": \"2.0\""),
              "DIR/a.gltf:1:28: syntax error while parsing object - unexpected end of input; "
              "expected '}'");
    EXPECT_EQ(error("{\"asset\":{\"version\":\"2.0\"},\n \"nodes\":[{\"mesh\":0,}]}"),
              "DIR/a.gltf:2:21: syntax error while parsing object key - unexpected '}'; expected "
              "string literal");
    const std::string rule = "; a .gltf file is a JSON object, a .glb file begins with 'glTF'";
    EXPECT_EQ(error("[1, 2, 3]"), "DIR/a.gltf: is no glTF" + rule);
    EXPECT_EQ(error("{"), "DIR/a.gltf: is no glTF" + rule);
    EXPECT_EQ(error("v/1\x01 an EXR"), "DIR/a.gltf: is no glTF" + rule);
    EXPECT_EQ(error(""), "DIR/a.gltf: is empty" + rule);
}

TEST_F(LoadGltf, RefusesRangesThatAreNotThere) {
    EXPECT_EQ(errorWith("bufferViews", R"([{"buffer":0,"byteOffset":40,"byteLength":48},
                                           {"buffer":0,"byteLength":12}])"),
              "DIR/a.gltf: buffer view 0 reaches beyond its buffer of 76 bytes");
    EXPECT_EQ(
        errorWith("bufferViews", R"([{"buffer":7,"byteLength":48},{"buffer":0,"byteLength":12}])"),
        "DIR/a.gltf: buffer view 0: buffer 7 does not exist; there are 1");
    const std::string indices =
        R"(,{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}])";
    EXPECT_EQ(
        errorWith("accessors",
                  R"([{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"})" + indices),
        "DIR/a.gltf: accessor 0 reaches beyond its buffer view of 48 bytes");
    EXPECT_EQ(
        errorWith("accessors",
                  R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC2"})" + indices),
        "DIR/a.gltf: accessor 0 has 2 components; 3 are needed");
    EXPECT_EQ(
        errorWith("accessors",
                  R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})" + indices),
        "DIR/a.gltf: mesh 0 primitive 0: index 3 is not one of the 3 vertices");
    Document huge = square();
    huge["accessors"] = R"([{"componentType":5126,"count":900000000,"type":"VEC3"})" + indices;
    EXPECT_EQ(error(text(huge)), "DIR/a.gltf: the scene is too large for a file of " +
                                     std::to_string(76 + text(huge).size()) + " bytes");
    EXPECT_EQ(errorWith("meshes", R"([{"primitives":[{"attributes":{"POSITION":9}}]}])"),
              "DIR/a.gltf: accessor 9 does not exist; there are 4");
    EXPECT_EQ(
        errorWith("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"material":2}]}])"),
        "DIR/a.gltf: mesh 0 primitive 0: material 2 does not exist; there are 0");
}

TEST_F(LoadGltf, RefusesCoordinatesTooFarAway) {
    const float x = 3e38F;  // of vertex 2
    folder.write("square.bin", squareBytes().replace(24, 4, reinterpret_cast<const char*>(&x), 4));
    EXPECT_EQ(error(text(square())),
              "DIR/a.gltf: mesh 0 primitive 0: its box reaches to (3e+38, 0, 0); -1e+09 to 1e+09 "
              "are allowed");
}

TEST_F(LoadGltf, RefusesNodesThatAreNoTree) {
    EXPECT_EQ(errorWith("nodes", R"([{"mesh":0,"children":[1]},{"children":[0]}])"),
              "DIR/a.gltf: node 0 has two parents or is its own ancestor");
    EXPECT_EQ(errorWith("nodes", R"([{"mesh":0,"children":[5]}])"),
              "DIR/a.gltf: node 5 does not exist; there are 1");
    EXPECT_EQ(errorWith("nodes", R"([{"mesh":3}])"),
              "DIR/a.gltf: node 0: mesh 3 does not exist; there are 1");
    EXPECT_EQ(errorWith("nodes", R"([{"mesh":0,"scale":[1e30,1e30,1e300]}])"),
              "DIR/a.gltf: node 0: the transform is not finite");
    EXPECT_EQ(
        errorWith("nodes", R"([{"mesh":0,"translation":[0,-2e9,0]}])"),
        "DIR/a.gltf: node 0: its box reaches to (0, -2000000000, 0); -1e+09 to 1e+09 are allowed");
    EXPECT_EQ(errorWith("scene", "4"), "DIR/a.gltf: scene 4 does not exist; there are 1");
}

}  // namespace
}  // namespace gfxrepro::scene
