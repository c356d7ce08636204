#include "engine/scene/catalog.h"

#include <fmt/format.h>

#include <cstdlib>

#include "engine/image/png_io.h"
#include "engine/scene/load.h"
#include "scenes/registry.h"
#include "tests/support/support.h"
#include "tests/support/topology.h"

namespace gfxrepro::scene {
namespace {

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

const fs::path kShippedScenes = GFXREPRO_SOURCE_DIR "/configs/scenes";

Node reference(const std::string& name) {
    return Node::scalar(name, {"table.yaml", 5, 8});
}

/// configs with one entry m/x, and an assets folder beside it.
struct Folders {
    TemporaryFolder folder;

    Folders() {
        folder.write("assets/readme", "");
        folder.write("scenes/readme", "");
    }
    void entry(const std::string& yaml) const { folder.write("scenes/m/x.yaml", yaml); }
    Catalog catalog() const {
        return {folder.path() / "scenes", folder.path() / "assets", registeredGenerators()};
    }
    std::string errorOf(const std::string& yaml) const {
        entry(yaml);
        return errorText([&] { catalog(); }, folder.path());
    }
};

TEST(Catalog, TakesAGeneratedSceneAtAnotherSeed) {
    const Folders folders;
    folders.entry(
        "scene: m/x\ndoc: an x\nsources:\n"
        "  - file: x/full.obj\n"
        "  - {generator: grass, params: {triangles: 12000}, seed: 4}\n");
    const Catalog catalog = folders.catalog();
    const Scene own = catalog.load(reference("m/x"));
    const Scene same = catalog.load(reference("m/x@4"));
    const Scene other = catalog.load(reference("m/x@5"));
    EXPECT_EQ(same.meshes.front().positions, own.meshes.front().positions);
    EXPECT_NE(other.meshes.front().positions, own.meshes.front().positions);
    EXPECT_EQ(catalog.load(reference("m/x@5")).meshes.front().positions,
              other.meshes.front().positions);
    EXPECT_EQ(other.name, "m/x@5");
    EXPECT_EQ(other.origin.description, "generator grass, seed 5: {triangles: 12000}");
    EXPECT_EQ(catalog.contentKey(reference("m/x@4")), catalog.contentKey(reference("m/x")));
    EXPECT_NE(catalog.contentKey(reference("m/x@5")), catalog.contentKey(reference("m/x")));

    const auto errorOf = [&](const std::string& name) {
        return errorText([&] { catalog.resolve(reference(name)); });
    };
    EXPECT_EQ(
        errorOf("m/x@-1"),
        "table.yaml:5:8: the seed of scene 'm/x' is '-1'; allowed: a whole number, at least 0");
    EXPECT_EQ(errorOf("m/y@1"),
              "table.yaml:5:8: unknown scene 'm/y'; did you mean 'm/x'? (`gfxrepro list scenes` "
              "prints all)");
    folders.folder.write("assets/x/full.obj", kTriangle);
    EXPECT_EQ(errorOf("m/x@1"),
              "table.yaml:5:8: scene 'm/x' has no seed: it is the file x/full.obj");
}

TEST(Catalog, KeepsResampledHeightsByWhatTheyAreMadeOf) {
    const Folders folders;
    const fs::path cache = folders.folder.path() / "cache";
    ASSERT_EQ(setenv("XDG_CACHE_HOME", cache.c_str(), 1), 0);
    const auto source = [&](int detailM) {
        folders.entry(fmt::format(
            "scene: m/x\ndoc: an x\nsources:\n"
            "  - {{height_map: a.raw, spacing_m: 8, resample_to: 9, detail_m: {}, seed: 1}}\n",
            detailM));
    };
    folders.folder.write("assets/a.raw.yaml", "{width: 2, height: 2, type: u16}");
    folders.folder.write("assets/a.raw", std::string("\0\1\0\2\0\3\0\4", 8));
    source(2);
    const Scene first = folders.catalog().load(reference("m/x"));
    ASSERT_TRUE(first.heights && first.heights->file);
    EXPECT_EQ(first.heights->sizeSamples, glm::ivec2(9));
    EXPECT_EQ(first.heights->heightM(8, 0), 512.0F);
    const auto keyOf = [&](const std::string& name) {
        return folders.catalog().load(reference(name)).heights->file->key();
    };
    EXPECT_EQ(keyOf("m/x"), first.heights->file->key());
    EXPECT_NE(keyOf("m/x@2"), first.heights->file->key());
    source(3);
    EXPECT_NE(keyOf("m/x"), first.heights->file->key());
    source(2);
    folders.folder.write("assets/a.raw", std::string("\0\1\0\2\0\3\0\5", 8));
    EXPECT_NE(keyOf("m/x"), first.heights->file->key());
    unsetenv("XDG_CACHE_HOME");
}

TEST(Catalog, TakesAGeneratedSceneWithOtherParameters) {
    const Folders folders;
    folders.entry(
        "scene: m/x\ndoc: an x\nsources:\n"
        "  - {generator: grass, params: {triangles: 12000}, seed: 4}\n");
    const Catalog catalog = folders.catalog();
    const Scene other = catalog.load(reference("m/x?triangles=11000@5"));
    EXPECT_EQ(other.triangleCount(), 11000U);
    EXPECT_EQ(other.name, "m/x?triangles=11000@5");
    EXPECT_EQ(other.origin.description, "generator grass, seed 5: {triangles: 11000}");
    EXPECT_EQ(catalog.contentKey(reference("m/x?triangles=12000")),
              catalog.contentKey(reference("m/x")));
    EXPECT_NE(catalog.contentKey(reference("m/x?triangles=11000")),
              catalog.contentKey(reference("m/x")));
    EXPECT_EQ(errorText([&] { catalog.resolve(reference("m/x?triangle=1")); }),
              "table.yaml:5:8: generator 'grass': unknown parameter 'triangle'; did you mean "
              "'triangles'?");
}

/// One triangle, `size_m` wide.
Scene oneTriangle(Params& params, std::uint64_t) {
    const auto sizeM = static_cast<float>(params.getDouble("size_m", 1.0, {"width", "m", 0.1, 9}));
    params.finish();
    Mesh mesh{.positions = {{0, 0, 0}, {sizeM, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
    return sceneOf(std::move(mesh));
}

TEST(Catalog, KnowsTheGeneratorsThatItIsGiven) {
    constexpr GeneratorInfo kOwn[] = {{"one_triangle", "a triangle", &oneTriangle, false}};
    const Folders f;
    f.entry(
        "scene: m/x\ndoc: d\ngenerated: true\nsources:\n"
        "  - {generator: one_triangle, params: {size_m: 4}}\n");
    const auto open = [&](std::span<const GeneratorInfo> generators) {
        return Catalog(f.folder.path() / "scenes", f.folder.path() / "assets", generators);
    };
    const Scene scene = open(kOwn).load(reference("m/x"));
    EXPECT_EQ(scene.bounds().max.x, 4.0F);
    EXPECT_EQ(scene.origin.description, "generator one_triangle, seed 1: {size_m: 4}");
    EXPECT_EQ(errorText([&] { open({}); }, f.folder.path()),
              "DIR/scenes/m/x.yaml:5:17: unknown generator 'one_triangle' (there are: )");
}

TEST(Catalog, TakesTheFirstSourceAtHand) {
    const Folders folders;
    folders.entry(
        "scene: m/x\ndoc: an x\nsources:\n"
        "  - file: x/full.obj\n"
        "  - {file: x/small.obj, refine_to: 9}\n"
        "  - {generator: sdf_model, params: {shape: sphere, triangles: 600}, seed: 4}\n");
    const Catalog catalog = folders.catalog();
    EXPECT_EQ(catalog.entries().at("m/x").doc, "an x");

    const Scene last = catalog.load(reference("m/x"));
    EXPECT_EQ(last.name, "m/x");
    EXPECT_EQ(last.triangleCount(), 600U);
    EXPECT_EQ(last.origin.kind, Origin::Kind::StandIn);
    EXPECT_EQ(last.origin.description,
              "generator sdf_model, seed 4: {shape: sphere, triangles: 600}");
    EXPECT_EQ(last.origin.sha256, "");

    folders.folder.write("assets/x/small.obj", kTriangle);
    const Scene middle = catalog.load(reference("m/x"));
    EXPECT_EQ(middle.triangleCount(), 9U);
    EXPECT_EQ(middle.origin.kind, Origin::Kind::StandIn);
    EXPECT_EQ(middle.origin.description, "x/small.obj, refined to 9 triangles");
    EXPECT_EQ(middle.origin.sha256.size(), 64U);

    folders.folder.write("assets/x/full.obj", kTriangle);
    const Scene first = catalog.load(reference("m/x"));
    EXPECT_EQ(first.triangleCount(), 1U);
    EXPECT_EQ(first.origin.kind, Origin::Kind::Real);
    EXPECT_EQ(first.origin.description, "x/full.obj");
}

TEST(Catalog, ContentKeyFollowsTheContent) {
    const Folders folders;
    const auto keyWith = [&](const std::string& source) {
        folders.entry("scene: m/x\ndoc: d\nsources: [" + source + "]\n");
        return folders.catalog().contentKey(reference("m/x"));
    };
    folders.folder.write("assets/a.obj", kTriangle);
    folders.folder.write("assets/b.obj", kTriangle);
    EXPECT_EQ(keyWith("{file: a.obj}"), keyWith("{file: b.obj}"));
    EXPECT_NE(keyWith("{file: a.obj}"), keyWith("{file: a.obj, refine_to: 5}"));
    const std::string one = "{generator: sdf_model, params: {shape: sphere}";
    EXPECT_EQ(keyWith(one + "}"), keyWith(one + ", seed: 1}"));
    EXPECT_NE(keyWith(one + "}"), keyWith(one + ", seed: 2}"));
    EXPECT_NE(keyWith(one + "}"), keyWith("{generator: sdf_model, params: {shape: torus}}"));

    folders.entry("scene: m/x\ndoc: d\nsources: [{file: a.obj}]\n");
    const Catalog catalog = folders.catalog();
    const std::string before = catalog.contentKey(reference("m/x"));
    EXPECT_EQ(catalog.contentKey(reference("m/x")), before);
    folders.folder.write("assets/a.obj", std::string(kTriangle) + "# changed\n");
    EXPECT_NE(catalog.contentKey(reference("m/x")), before);
}

TEST(Catalog, ContentKeyFollowsTheFilesThatAModelDrawsIn) {
    const Folders folders;
    folders.folder.write("assets/a.obj", "mtllib a.mtl\n" + std::string(kTriangle));
    folders.folder.write("assets/c.obj", "o x\n \tmtllib a.mtl\n" + std::string(kTriangle));
    folders.folder.write("assets/a.mtl", "newmtl m\nmap_Kd a.png\n");
    folders.folder.write("assets/b.gltf",
                         R"({"buffers": [{"uri": "b.bin"}], "images": [{"uri": "a.png"}]})");
    for (const char* model : {"a.obj", "b.gltf", "c.obj"}) {
        folders.folder.write("assets/a.png", "one");
        folders.folder.write("assets/b.bin", "one");
        folders.entry("scene: m/x\ndoc: d\nsources: [{file: " + std::string(model) + "}]\n");
        const Catalog catalog = folders.catalog();
        const std::string before = catalog.contentKey(reference("m/x"));
        folders.folder.write("assets/a.png", "other");
        const std::string between = catalog.contentKey(reference("m/x"));
        EXPECT_NE(between, before) << model;
        folders.folder.write("assets/b.bin", "other");
        EXPECT_EQ(catalog.contentKey(reference("m/x")) == between, model[0] != 'b');
    }
    folders.folder.write("assets/b.gltf",
                         R"({"buffers": [{"uri": ")" + std::string(5000, 'b') + R"("}]})");
    EXPECT_NE(folders.catalog().contentKey(reference("m/x")), "") << "no file has such a name";
}

TEST(Catalog, AFileThatNoLoaderTakesIsNotReadThrough) {
    const Folders folders;
    folders.folder.write("assets/a.obj", "mtllib a.mtl\n" + std::string(kTriangle));
    folders.folder.write("assets/a.mtl", "newmtl m\nmap_Kd huge.bin\n");
    folders.folder.write("assets/b.obj", "mtllib huge.bin\n" + std::string(kTriangle));
    folders.folder.write("assets/c.gltf", R"({"asset": {"version": "2.0"},
        "buffers": [{"uri": "huge.bin", "byteLength": 20000000000}]})");
    folders.folder.write("assets/d.gltf", R"({"asset": {"version": "2.0"},
        "images": [{"uri": "huge.bin"}]})");
    for (const auto& [huge, head] : {std::pair{"huge.bin", ""},
                                     {"e.glb", ""},
                                     {"f.ply",
                                      "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
                                      "property float x\nproperty float y\nproperty float z\n"
                                      "end_header\n"},
                                     {"g.obj", kTriangle}}) {
        fs::resize_file(folders.folder.write("assets/" + std::string(huge), head),
                        20'000'000'000);  // of which the disk has the head alone
    }
    const auto refusalOf = [&](const std::string& file) {
        return "DIR/assets/" + file +
               ": has 20000000000 bytes; a file of a scene has less than 4 GiB";
    };
    for (const char* model : {"a.obj", "b.obj", "c.gltf", "d.gltf", "e.glb", "f.ply", "g.obj"}) {
        folders.entry("scene: m/x\ndoc: d\nsources: [{file: " + std::string(model) + "}]\n");
        const Catalog catalog = folders.catalog();
        const std::string refusal = refusalOf(model[0] >= 'e' ? model : "huge.bin");
        EXPECT_EQ(errorText([&] { catalog.contentKey(reference("m/x")); }, folders.folder.path()),
                  refusal)
            << model;
        if (model[0] == 'a') continue;  // its loader looks at the first bytes of a texture
        EXPECT_THAT(errorText([&] { catalog.load(reference("m/x")); }, folders.folder.path()),
                    HasSubstr(refusal))
            << model;
    }
}

TEST(Catalog, AHeightMapHasNoMoreThanItsSamples) {
    const Folders folders;
    const auto file = [&](const char* name) { return folders.folder.path() / "assets" / name; };
    image::writePng(file("a.png"), image::Image16(4, 3, 1));
    folders.folder.write("assets/b.raw", "");
    folders.folder.write("assets/b.raw.yaml", "{width: 4, height: 3, type: f32}\n");
    folders.folder.write("assets/c.hgt", "");
    folders.folder.write("assets/d.tif", "II*");
    for (const char* name : {"a.png", "b.raw", "c.hgt", "d.tif"}) {
        fs::resize_file(file(name), 20'000'000'000);  // nearly all of it a hole
    }
    const auto expectRefused = [&](const std::string& source, const std::string& why) {
        folders.entry("scene: m/x\ndoc: d\nsources: [{spacing_m: 1, height_map: " + source +
                      "}]\n");
        const Catalog catalog = folders.catalog();
        for (const bool isLoaded : {false, true}) {
            EXPECT_THAT(errorText(
                            [&] {
                                isLoaded ? void(catalog.load(reference("m/x")))
                                         : void(catalog.contentKey(reference("m/x")));
                            },
                            folders.folder.path()),
                        StartsWith("DIR/assets/" + why));
        }
    };
    expectRefused("a.png",
                  "a.png: has 20000000000 bytes; a height map of 4 x 3 samples has at most 96");
    expectRefused("b.raw", "b.raw: 20000000000 bytes; 4 x 3 samples of f32 need 48");
    expectRefused("c.hgt", "c.hgt: 20000000000 bytes; an SRTM tile has 2884802 (1201 x 1201)");
    expectRefused("d.tif", "d.tif: ");
    image::writePng(file("e.png"), image::Image16(4, 3, 1));
    expectRefused("e.png, colour_map: a.png",
                  "a.png: has 20000000000 bytes; a file of a scene has less than 4 GiB");
    fs::rename(file("b.raw.yaml"), file("f.raw.yaml"));
    folders.folder.write("assets/f.raw", std::string(48, '\0'));
    fs::resize_file(file("f.raw.yaml"), 20'000'000'000);
    expectRefused("f.raw",
                  "f.raw.yaml: has 20000000000 bytes; a file of a scene has less than 4 GiB");
}

TEST(Catalog, UserFilesAreRelativeToTheFileThatNamesThem) {
    const Folders folders;
    const std::string file = folders.folder.write("mine/my.obj", kTriangle).string();
    const std::string config = (folders.folder.path() / "mine/table.yaml").string();
    const auto my = Node::scalar("my.obj", {config, 2, 3});
    const Catalog catalog = folders.catalog();
    EXPECT_EQ(catalog.resolve(my).file, file);
    const Scene scene = catalog.load(my);
    EXPECT_EQ(scene.name, "my.obj");
    EXPECT_EQ(scene.origin.kind, Origin::Kind::Real);
    const auto missing = Node::scalar("../no.obj", {config, 2, 3});
    EXPECT_EQ(errorText([&] { catalog.load(missing); }, folders.folder.path()),
              "DIR/mine/table.yaml:2:3: scene file '../no.obj' is not there; looked at DIR/no.obj");
    // Known before it is looked for, so that a check without a device finds it.
    const auto unknown = Node::scalar("my.FBX", {config, 2, 3});
    EXPECT_EQ(errorText([&] { catalog.resolve(unknown); }, folders.folder.path()),
              "DIR/mine/table.yaml:2:3: scene file my.FBX: unknown extension '.fbx'; .ply, .obj, "
              ".gltf, .glb, .off, .stl, .xyz and .las are allowed");
    EXPECT_EQ(folders.errorOf("scene: m/x\ndoc: d\nsources: [{file: a.fbx}]\n"),
              "DIR/scenes/m/x.yaml:3:18: file a.fbx: unknown extension '.fbx'; .ply, .obj, .gltf, "
              ".glb, .off, .stl, .xyz and .las are allowed");
}

TEST(Catalog, TurnsAUsersModelUp) {
    const Folders folders;
    const Catalog catalog = folders.catalog();
    Scene tall =
        sceneOf(Mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 5}}, .triangles = {{0, 1, 2}}});
    tall.lights = {{{1, 2, 3}}};
    const Camera camera{.position = {0, -4, 1}, .target = {0, 0, 1}, .up = {0, 0, 1}};
    tall.cameras = {camera};
    tall.paths = {{"round", {camera}}};
    tall.motions = {{0, {1, 2, 3}, {0, 0, 1}, 1.0F, {0, 0, 1}, 1.0F}};
    saveGlb(folders.folder.path() / "tall.glb", tall);
    const std::string file = folders.folder.path() / "tall.glb";
    const auto load = [&](const std::string& params) {
        return catalog.load(Node::scalar(file + params));
    };
    EXPECT_EQ(load("?up=y").bounds().max, glm::vec3(1, 2, 5));
    const Scene turned = load("?up=z");
    const auto expectNear = [](const glm::vec3& a, const glm::vec3& b) {
        EXPECT_LT(glm::length(a - b), 1e-5F);
    };
    expectNear(turned.bounds().max, {1, 5, 0});
    // What is in it turns, too.
    expectNear(turned.cameras.at(0).position, {0, 1, 4});
    expectNear(turned.cameras[0].up, {0, 1, 0});
    expectNear(turned.paths.at(0).keys[0].target, {0, 1, 0});
    expectNear(turned.lights.at(0).position, {1, 3, -2});
    expectNear(turned.motions.at(0).pivot, {1, 3, -2});
    expectNear(turned.motions[0].axis, {0, 1, 0});
    expectNear(turned.motions[0].swing, {0, 1, 0});
    const auto key = [&](const std::string& params) {
        return catalog.contentKey(Node::scalar(file + params));
    };
    EXPECT_NE(key("?up=z"), key("?up=y"));
    EXPECT_EQ(errorText([&] { load("?upp=z"); }, folders.folder.path()),
              "model 'DIR/tall.glb' has no parameter 'upp'; did you mean 'up'?; allowed: up");
    EXPECT_EQ(errorText([&] { load("?up=x"); }), "up is x; allowed: y | z");
}

TEST(Catalog, SaysWhereItLookedAndHowToGetIt) {
    const Folders folders;
    folders.entry(
        "scene: m/x\ndoc: d\ncanonical: http://example.org/x.tar.gz\n"
        "sources: [{file: x/full.ply}, {file: x/small.ply, refine_to: 9}]\n");
    const Catalog catalog = folders.catalog();
    EXPECT_EQ(errorText([&] { catalog.load(reference("m/x")); }, folders.folder.path()),
              "table.yaml:5:8: scene 'm/x' not found; searched:\n"
              "  DIR/assets/x/full.ply\n"
              "  DIR/assets/x/small.ply\n"
              "get it with scripts/fetch-assets or from http://example.org/x.tar.gz");
    EXPECT_EQ(errorText([&] { catalog.resolve(reference("m/y")); }),
              "table.yaml:5:8: unknown scene 'm/y'; did you mean 'm/x'? (`gfxrepro list scenes` "
              "prints all)");
}

TEST(Catalog, TurnsFilesWhoseUpIsZ) {
    const Folders folders;
    folders.entry("scene: m/x\ndoc: d\nsources: [{file: a.obj, up: z}]\n");
    folders.folder.write("assets/a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\n");
    const Mesh mesh = flattened(folders.catalog().load(reference("m/x")));
    ASSERT_EQ(mesh.positions.size(), 3U);
    EXPECT_EQ(mesh.positions[2], glm::vec3(0, 3, -2));

    folders.entry("scene: m/x\ndoc: d\nsources: [{file: a.ply, up: z, points: 1}]\n");
    folders.folder.write("assets/a.ply",
                         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                         "property float y\nproperty float z\nproperty float nx\n"
                         "property float ny\nproperty float nz\nend_header\n1 2 3 0 0 1\n");
    const PointCloud points = folders.catalog().load(reference("m/x")).points;
    ASSERT_EQ(points.positions.size(), 1U);
    EXPECT_EQ(points.positions[0], glm::vec3(1, 3, -2));
    EXPECT_EQ(points.normals[0], glm::vec3(0, 1, 0));
    folders.entry("scene: m/x\ndoc: d\nsources: [{file: a.ply, points: 2}]\n");
    EXPECT_EQ(errorText([&] { folders.catalog().load(reference("m/x")); }, folders.folder.path()),
              "DIR/scenes/m/x.yaml:3:11: 2 points wanted of a.ply, a cloud of 1; allowed: no more "
              "than it has");
    EXPECT_EQ(folders.errorOf("scene: m/x\ndoc: d\nsources: [{file: a.ply, up: x}]\n"),
              "DIR/scenes/m/x.yaml:3:29: up is x; allowed: y | z");
}

TEST(Catalog, RefusesBadEntries) {
    const Folders f;
    EXPECT_EQ(f.errorOf("scene: m/z\ndoc: d\nsources: [{file: a.ply}]\n"),
              "DIR/scenes/m/x.yaml:1:8: scene is 'm/z', but the file's place names it 'm/x'");
    EXPECT_EQ(
        f.errorOf("scene: m/x\nsource: []\n"),
        "DIR/scenes/m/x.yaml:2:1: scene entry: unknown key 'source'; did you mean 'sources'?");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\n"),
              "DIR/scenes/m/x.yaml:1:1: scene entry needs 'sources'");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: []\n"),
              "DIR/scenes/m/x.yaml:3:10: sources is empty; an entry needs at least one");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: [a.ply]\n"),
              "DIR/scenes/m/x.yaml:3:11: source is a.ply; allowed: a map");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: [{file: a.ply, generator: sdf_model}]\n"),
              "DIR/scenes/m/x.yaml:3:11: source: 'file' and 'generator' exclude each other");
    EXPECT_EQ(
        f.errorOf("scene: m/x\ndoc: d\nsources: [{file: /a.ply}]\n"),
        "DIR/scenes/m/x.yaml:3:18: file is '/a.ply', but must be a path within the assets folder");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: [{file: a.ply, refine_to: 0}]\n"),
              "DIR/scenes/m/x.yaml:3:36: refine_to is 0; allowed: at least 1");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: [{generator: sdf_modell}]\n"),
              "DIR/scenes/m/x.yaml:3:23: unknown generator 'sdf_modell'; did you mean 'sdf_model'? "
              "(there are: bathroom, bird_nest, city, cornell_box, four_objects, grass, "
              "living_room, object_on_plane, sdf_model, terrain, town_square, tree)");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: [{generator: sdf_model, seed: -1}]\n"),
              "DIR/scenes/m/x.yaml:3:40: seed is -1; allowed: at least 0");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\nsources: [{height_map: a.png, spacing_m: far}]\n"),
              "DIR/scenes/m/x.yaml:3:42: spacing_m is far; allowed: a number, 1e-09 … 1000000");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\ngenerated: maybe\nsources: [{file: a.ply}]\n"),
              "DIR/scenes/m/x.yaml:3:12: generated is maybe; allowed: true | false");
    EXPECT_EQ(f.errorOf("scene: m/x\ndoc: d\ngenerated: true\nsources: [{file: a.ply}]\n"),
              "DIR/scenes/m/x.yaml:4:11: source: a file cannot be the source of a generated scene");
}

TEST(Catalog, RefiningBelowTheFileIsLocated) {
    const Folders folders;
    folders.folder.write("assets/two.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    folders.entry("scene: m/x\ndoc: d\nsources: [{file: two.obj, refine_to: 1}]\n");
    const Catalog catalog = folders.catalog();
    EXPECT_EQ(errorText([&] { catalog.load(reference("m/x")); }, folders.folder.path()),
              "DIR/scenes/m/x.yaml:3:11: two.obj: cannot refine a mesh of 2 triangles to 1: it has "
              "more already");
}

/// The triangles and vertices that the thesis prints, from generators alone.
TEST(ShippedCatalog, StandInsHaveThePrintedCounts) {
    const TemporaryFolder noAssets;
    const Catalog catalog(kShippedScenes, noAssets.path(), registeredGenerators());
    const struct {
        const char* name;
        std::size_t triangles, vertices;
    } kPrinted[] = {{"models/duck", 1254, 947},         {"models/hugo", 16928, 8634},
                    {"models/bunny", 69450, 34834},     {"models/dragon", 871326, 439370},
                    {"models/buddha", 1087514, 550868}, {"models/blade", 1765388, 898796},
                    {"models/wagner", 60246, 30215},    {"models/brain", 36758, 29371}};
    for (const auto& printed : kPrinted) {
        const Scene scene = catalog.load(reference(printed.name));
        EXPECT_EQ(scene.triangleCount(), printed.triangles) << printed.name;
        EXPECT_EQ(scene.vertexCount(), printed.vertices) << printed.name;
        EXPECT_EQ(scene.origin.kind, Origin::Kind::StandIn);
        const Topology topology = topologyOf(scene.meshes[0]);
        EXPECT_TRUE(topology.isClosed()) << printed.name;
        EXPECT_EQ(topology.degenerateTriangles, 0U) << printed.name;
        EXPECT_TRUE(topology.isManifold()) << printed.name;
        EXPECT_TRUE(topology.isOriented()) << printed.name;
    }
    for (const auto& [name, entry] : catalog.entries()) {
        if (!name.starts_with("shapes/")) continue;
        const Scene scene = catalog.load(reference(name));
        EXPECT_EQ(scene.origin.kind, Origin::Kind::Generated) << name;
        EXPECT_TRUE(topologyOf(scene.meshes[0]).isClosed()) << name;
    }
}

TEST(ShippedCatalog, RealModelsAreRecognized) {
    const auto bunny = test::asset("bunny/bun_zipper.ply");
    if (!bunny) GTEST_SKIP() << "bunny/bun_zipper.ply";
    const Catalog catalog(kShippedScenes, bunny->parent_path().parent_path(),
                          registeredGenerators());
    const Scene scene = catalog.load(reference("models/bunny"));
    EXPECT_EQ(scene.origin.kind, Origin::Kind::Real);
    EXPECT_EQ(scene.origin.description, "bunny/bun_zipper.ply");
    EXPECT_EQ(scene.triangleCount(), 69451U);
    EXPECT_EQ(scene.vertexCount(), 34834U);
}

TEST(ShippedCatalog, DecimatedScansAreRefinedToThePrintedCount) {
    const auto blade = test::asset("blade/turbineblade.ply");
    if (!blade) GTEST_SKIP() << "blade/turbineblade.ply";
    const Catalog catalog(kShippedScenes, blade->parent_path().parent_path(),
                          registeredGenerators());
    const Scene scene = catalog.load(reference("models/blade"));
    EXPECT_EQ(scene.triangleCount(), 1765388U);
    EXPECT_EQ(scene.origin.kind, Origin::Kind::StandIn);
    EXPECT_EQ(scene.origin.description, "blade/turbineblade.ply, refined to 1765388 triangles");
}

}  // namespace
}  // namespace gfxrepro::scene
