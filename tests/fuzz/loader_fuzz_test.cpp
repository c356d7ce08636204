#include <malloc.h>
#include <stb/stb_image_write.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/random.h"
#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/scene/load.h"
#include "runner/config/experiment.h"
#include "runner/records/images.h"
#include "runner/records/records.h"
#include "tests/support/support.h"

// operator new has no other place to keep its count.
namespace {
std::atomic<std::size_t> usedBytes = 0;
std::atomic<std::size_t> peakBytes = 0;
std::atomic<std::size_t> startBytes = 0;
}  // namespace

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    void* memory = std::malloc(size);
    if (memory == nullptr) return nullptr;
    const std::size_t used = usedBytes += ::malloc_usable_size(memory);
    std::size_t peak = peakBytes;
    while (used > peak && !peakBytes.compare_exchange_weak(peak, used)) {
    }
    return memory;
}

void* operator new(std::size_t size) {
    if (void* memory = ::operator new(size, std::nothrow)) return memory;
    throw std::bad_alloc();
}

void* operator new[](std::size_t size) {
    return ::operator new(size);
}

void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return ::operator new(size, std::nothrow);
}

void operator delete(void* memory) noexcept {
    if (memory != nullptr) usedBytes -= ::malloc_usable_size(memory);
    std::free(memory);
}

void operator delete[](void* memory) noexcept {
    ::operator delete(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    ::operator delete(memory);
}

void operator delete[](void* memory, std::size_t) noexcept {
    ::operator delete(memory);
}

void operator delete(void* memory, const std::nothrow_t&) noexcept {
    ::operator delete(memory);
}

void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    ::operator delete(memory);
}

namespace gfxrepro {
namespace {

/// Begins to measure: the peak becomes what is in use now.
void resetPeakMemory() {
    startBytes = usedBytes.load();
    peakBytes = usedBytes.load();
}

/// The most bytes in use since, above what was in use then.
std::size_t peakMemoryBytes() {
    return peakBytes - startBytes;
}

using Load = std::function<void(const fs::path&)>;

constexpr int kMutations = 5;  // of each seed; GFXREPRO_TEST_MUTATIONS: as many
constexpr std::uintmax_t kMaxMutatedBytes = 200'000;  // larger seeds are loaded as they are only

int mutationCount() {
    const char* count = std::getenv("GFXREPRO_TEST_MUTATIONS");
    return count ? std::atoi(count) : kMutations;
}

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class T>
bool fits(const std::vector<T>& attribute, std::size_t count) {
    return attribute.empty() || attribute.size() == count;
}

/// What every user of a scene relies on.
void expectConsistent(const scene::Scene& scene) {
    const auto inRange = [](int index, std::size_t count) {
        return index >= -1 && index < static_cast<int>(count);
    };
    for (const scene::Mesh& mesh : scene.meshes) {
        const std::size_t count = mesh.positions.size();
        EXPECT_TRUE(std::all_of(mesh.positions.begin(), mesh.positions.end(), isFinite));
        EXPECT_TRUE(fits(mesh.normals, count) && fits(mesh.texcoords, count) &&
                    fits(mesh.colors, count));
        EXPECT_TRUE(inRange(mesh.material, scene.materials.size()));
        for (const glm::uvec3& triangle : mesh.triangles) {
            ASSERT_LT(std::max({triangle.x, triangle.y, triangle.z}), count);
        }
    }
    for (const scene::Material& material : scene.materials) {
        EXPECT_TRUE(inRange(material.baseColorTexture, scene.textures.size()));
    }
    for (const scene::Instance& instance : scene.instances) {
        ASSERT_GE(instance.mesh, 0);
        ASSERT_LT(instance.mesh, static_cast<int>(scene.meshes.size()));
    }
    const std::size_t count = scene.points.positions.size();
    EXPECT_TRUE(
        std::all_of(scene.points.positions.begin(), scene.points.positions.end(), isFinite));
    EXPECT_TRUE(fits(scene.points.normals, count) && fits(scene.points.radii, count) &&
                fits(scene.points.colors, count));
}

const Load kLoadPly = [](const fs::path& path) { expectConsistent(scene::loadPly(path)); };
const Load kLoadObj = [](const fs::path& path) { expectConsistent(scene::loadObj(path)); };
const Load kLoadGltf = [](const fs::path& path) { expectConsistent(scene::loadGltf(path)); };
const Load kReadPng = [](const fs::path& path) { image::readPng16(path); };
const Load kReadPicture = [](const fs::path& path) { image::readPicture(path); };
const Load kReadExr = [](const fs::path& path) {
    const image::ExrImage exr = image::readExr(path);
    for (const auto& channel : exr.channels) {
        EXPECT_EQ(channel.values.width(), exr.width());
        EXPECT_EQ(channel.values.height(), exr.height());
    }
};

const Load kLoadConfig = [](const fs::path& path) {
    const config::Experiment experiment = config::loadExperiment(path, {}, GFXREPRO_CONFIGS);
    config::experimentFromDocument(experiment.document, path);
    config::expandCases(experiment);
};
const Load kParseJson = [](const fs::path& path) {
    nodeFromJson(parseJsonObject(readFile(path), {path.string(), 0, 0}));
};
const Load kReadRecords = [](const fs::path& path) { records::readRecords(path); };
const Load kReadImages = [](const fs::path& path) {
    records::readImages(path.parent_path().parent_path());
};

/// A file may fail, but only by an Error that names it, and within the memory that its size allows:
/// decoders stop at 128 MiB or 500 times the file (and hold it twice where they convert).
int inputCount = 0;  // up to here; the last test's property is of all

void expectRefusedOrLoaded(const Load& load, const fs::path& path, std::uintmax_t folderBytes) {
    SCOPED_TRACE(path.string());
    testing::Test::RecordProperty("inputs", ++inputCount);
    resetPeakMemory();
    try {
        load(path);
    } catch (const Error& error) {
        const std::string what = error.what();
        const bool isNamed = what.find(path.parent_path().string()) != std::string::npos;
        // What a config extends may be at odds with it.
        EXPECT_TRUE(isNamed || what.starts_with(GFXREPRO_CONFIGS)) << what;
    } catch (const std::exception& error) {
        ADD_FAILURE() << "not an Error: " << error.what();
    }
    constexpr std::size_t kAlwaysAllowedBytes = std::size_t{320} << 20;
    EXPECT_LE(peakMemoryBytes(), kAlwaysAllowedBytes + 1000 * folderBytes);
}

std::string mutated(std::string content, Random& random) {
    const auto place = [&] { return random.index(static_cast<std::uint32_t>(content.size())); };
    constexpr std::array<const char*, 8> kNumbers{
        "-1", "4294967295", "1e999", "nan", "99999999999999999999", "0", "65536", "-0.0"};
    if (content.empty()) return "x";
    switch (random.index(5)) {
        case 0:
            content.resize(place());
            break;
        case 1:
            for (int i = 0; i < 4; ++i) content[place()] = static_cast<char>(random.next());
            break;
        case 2: {
            const std::size_t from = place();
            const std::string chunk = content.substr(from, 1 + random.index(64));
            content.insert(place(), chunk);
            break;
        }
        case 3: {  // another number in the text
            const std::size_t at = content.find_first_of("0123456789", place());
            if (at == std::string::npos) break;
            const std::size_t end = content.find_first_not_of("0123456789.", at);
            content.replace(at, std::min(end, content.size()) - at, kNumbers[random.index(8)]);
            break;
        }
        default: {  // a large word in the binary part
            const std::size_t at = place();
            const std::size_t count = std::min<std::size_t>(4, content.size() - at);
            content.replace(at, count, std::string(count, '\xff'));
        }
    }
    return content;
}

/// The neighbours that the seed names, so that a mutated file still finds them.
std::uintmax_t linkNeighbours(const fs::path& seed, const std::string& content,
                              const fs::path& folder) {
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(seed.parent_path())) {
        const bool isNamed = content.find(entry.path().filename().string()) != std::string::npos;
        if (!isNamed || !entry.is_regular_file() || entry.path() == seed) continue;
        fs::remove(folder / entry.path().filename());  // another seed's
        fs::create_symlink(entry.path(), folder / entry.path().filename());
        bytes += entry.file_size();
    }
    return bytes;
}

/// Loads the seed and mutations of it, which are written into `folder`. What fails is kept.
void fuzz(const Load& load, const fs::path& seed, std::uint64_t number, const fs::path& folder) {
    if (testing::Test::HasFailure()) return;  // the first one is enough to look at
    const std::string content = readFile(seed);
    const std::uintmax_t neighbours = linkNeighbours(seed, content, folder);
    expectRefusedOrLoaded(load, seed, content.size() + neighbours);
    if (content.size() > kMaxMutatedBytes) return;
    Random random(number);
    const bool isList = seed.filename() == "index.csv";  // of a folder, which has one name for it
    const fs::path path =
        folder / (isList ? "index.csv" : "mutated" + seed.filename().extension().string());
    for (int i = 0; i < mutationCount(); ++i) {
        const std::string variant = mutated(content, random);
        std::ofstream(path, std::ios::binary) << variant;
        expectRefusedOrLoaded(load, path, variant.size() + neighbours);
        if (testing::Test::HasFailure()) {
            const fs::path kept =
                fs::temp_directory_path() /
                ("gfxrepro-fuzz-" + std::to_string(::getpid()) + path.extension().string());
            fs::copy_file(path, kept, fs::copy_options::overwrite_existing);
            FAIL() << seed << " mutation " << i << " of seed " << number << ", kept as " << kept;
        }
    }
}

/// The seeds of a folder in the assets, sorted, and those of `own`.
std::vector<fs::path> seeds(const std::string& folder, const std::vector<fs::path>& own) {
    std::vector<fs::path> found;
    if (const auto path = test::asset("fuzz_seeds/" + folder)) {
        for (const auto& entry : fs::recursive_directory_iterator(*path)) {
            if (entry.is_regular_file()) found.push_back(entry.path());
        }
    }
    std::sort(found.begin(), found.end());
    found.insert(found.begin(), own.begin(), own.end());
    return found;
}

bool hasExtension(const fs::path& path, std::initializer_list<const char*> extensions) {
    return std::find(extensions.begin(), extensions.end(), path.extension()) != extensions.end();
}

scene::Scene smallScene() {
    const scene::Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}},
                           .normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                           .texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
                           .triangles = {{0, 1, 2}, {2, 1, 3}},
                           .material = 0};
    scene::Scene scene = scene::sceneOf(mesh);
    scene.materials.emplace_back().baseColorTexture = 0;
    scene.textures.emplace_back(4, 4, 3, std::uint8_t{9});
    scene.cameras.emplace_back();
    return scene;
}

struct LoaderFuzz : testing::Test {
    /// Each with mutations of its own in each round.
    template <class Paths>
    void fuzzAll(const Load& load, const Paths& paths, int rounds = 1) {
        for (const fs::path path : paths) {
            for (int round = 0; round < rounds; ++round) fuzz(load, path, ++number, work.path());
        }
    }
    /// Those of the folder with one of these extensions, too.
    static std::vector<fs::path> withSeeds(const std::string& folder,
                                           const std::vector<fs::path>& own,
                                           std::initializer_list<const char*> extensions) {
        std::vector<fs::path> all = seeds(folder, own);
        std::erase_if(all, [&](const fs::path& path) { return !hasExtension(path, extensions); });
        return all;
    }

    const TemporaryFolder own, work;
    std::uint64_t number = 0;
};

TEST_F(LoaderFuzz, Ply) {
    scene::savePly(own.path() / "binary.ply", smallScene());
    own.write("ascii.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
              "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n");
    // These are small, and the format is our own parser's: more of them.
    fuzzAll(kLoadPly,
            withSeeds("ply", {own.path() / "binary.ply", own.path() / "ascii.ply"}, {".ply"}), 2);
}

TEST_F(LoaderFuzz, Obj) {
    own.write("a.mtl", "newmtl a\nKd 1 0 0\nd 0.5\nNs 10\n");
    const fs::path seed =
        own.write("a.obj",
                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\n"
                  "f 1/1/1 2/1/1 3/1/1\nf -1 -2 \\\n -3\nf 1//1 2//1 3//1\n"
                  "v 1 1 0\nv 0.1 0.1 0\nf 1 2 5 4 3\nf 2 5 3 4\n");
    const fs::path far =
        own.write("far.obj", "v 500000.1 1 2\nv 500000.2 1 2\nv 500000.15 2 2\nv 0 0 0\nf 1 2 3\n");
    fuzzAll(kLoadObj, withSeeds("obj", {seed, far}, {".obj"}), 2);
}

TEST_F(LoaderFuzz, OffAndStl) {
    std::string binary(80, ' ');
    binary += std::string("\2\0\0\0", 4);
    const float facet[] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (int i = 0; i < 2; ++i) {
        binary.append(reinterpret_cast<const char*>(facet), sizeof(facet));
        binary += std::string(2, '\0');
    }
    const std::vector<fs::path> all = {
        own.write("a.off",
                  "STCNOFF\n4 2 0\n0 0 0 0 0 1 9 9 9 0 0\n1 0 0 0 0 1 9 9 9 0 1\n"
                  "1 1 0 0 0 1 9 9 9 1 1\n0.2 0.2 0 0 0 1 9 9 9 0 1\n4 0 1 2 3 1 0 0\n3 0 1 2\n"),
        own.write("text.stl",
                  "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                  "vertex 0 1e0 0\nendloop\nendfacet\nendsolid a\n"),
        own.write("binary.stl", binary)};
    fuzzAll([](const fs::path& path) { expectConsistent(scene::loadScene(path)); }, all, 2);
}

TEST_F(LoaderFuzz, Clouds) {
    // LAS 1.4: a record before two points of format 8, far from the origin.
    std::string las(375 + 60 + 2 * 38, '\0');
    const auto put = [&](std::size_t at, auto value) {
        std::memcpy(las.data() + at, &value, sizeof(value));
    };
    las.replace(0, 4, "LASF");
    put(24, std::uint16_t{0x0401});
    put(94, std::uint16_t{375});
    put(96, std::uint32_t{435});
    put(100, std::uint32_t{1});
    put(104, std::uint8_t{8});
    put(105, std::uint16_t{38});
    for (const std::size_t at : {131U, 139U, 147U}) put(at, 0.01);
    put(155, 500000.0);
    put(247, std::uint64_t{2});
    put(375 + 20, std::uint16_t{6});
    put(435 + 38, std::uint32_t{77});
    put(435 + 30, std::uint64_t{0x0102030405060708});
    const std::vector<fs::path> all = {
        own.write("a.las", las),
        own.write("named.xyz",
                  "//X Y Z Intensity R G B Nx Ny Nz\n500000.1 1 2 7 255 0 9 0 0 1\n"
                  "500000.2 2 2 7 255 0 9 0 0.6 0.8\n"),
        own.write("plain.xyz", "2\n# of\n0.5,1,2,255,128,0\n1,nan,2,0,0,1\n")};
    for (const fs::path& seed : all) EXPECT_FALSE(scene::loadScene(seed).points.colors.empty());
    fuzzAll([](const fs::path& path) { expectConsistent(scene::loadScene(path)); }, all, 2);
}

/// A triangle with a joint for each corner and a morph target.
constexpr std::string_view kPosedGltf = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1,2]}],
"buffers":[{"byteLength":96,"uri":"posed%20triangle.bin"}],"bufferViews":[
 {"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12},
 {"buffer":0,"byteOffset":48,"byteLength":48}],"accessors":[
 {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
 {"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"},
 {"bufferView":2,"componentType":5126,"count":3,"type":"VEC4"}],
"meshes":[{"weights":[0.5],"primitives":[{"attributes":{"POSITION":0,"NORMAL":0,"JOINTS_0":1,
 "WEIGHTS_0":2},"targets":[{"POSITION":0,"NORMAL":0}]}]}],"skins":[{"joints":[1,2]}],
"nodes":[{"mesh":0,"skin":0},{"translation":[500000,0,4e6]},{"children":[3]},{"scale":[2,2,2]}]})";

TEST_F(LoaderFuzz, Gltf) {
    scene::saveGlb(own.path() / "a.glb", smallScene());
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint8_t joints[] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    const float weights[] = {1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0};
    const auto bytes = [](const auto& values) {
        return std::string(reinterpret_cast<const char*>(values), sizeof(values));
    };
    own.write("posed triangle.bin", bytes(positions) + bytes(joints) + bytes(weights));
    const fs::path posed = own.write("posed.gltf", kPosedGltf);
    EXPECT_EQ(scene::loadGltf(posed).triangleCount(), 1U);
    const std::vector<fs::path> both = {own.path() / "a.glb", posed};
    fuzzAll(kLoadGltf, withSeeds("gltf", both, {".gltf", ".glb"}));
    fs::create_symlink(own.path() / "posed triangle.bin", work.path() / "posed triangle.bin");
    fuzzAll(kLoadGltf, both, 100);
}

TEST_F(LoaderFuzz, Png) {
    image::writePng(own.path() / "a.png", image::Image16(9, 5, 3, 1234));
    fuzzAll(kReadPng, seeds("png", {own.path() / "a.png"}));
}

TEST_F(LoaderFuzz, Exr) {
    image::ExrImage exr;
    exr.add(image::ImageF(9, 5, 3, 0.5F), {"R", "G", "B"});
    image::writeExr(own.path() / "a.exr", exr);
    fuzzAll(kReadExr, seeds("exr", {own.path() / "a.exr"}));
}

/// 9 × 5 pixels of RGB, in one strip behind the tags.
std::string smallTiff(const std::string& bytes) {
    const auto word = [](std::uint32_t value, int count) {
        return std::string(reinterpret_cast<const char*>(&value), static_cast<std::size_t>(count));
    };
    constexpr std::uint32_t kTags[][2] = {{256, 9}, {257, 5}, {258, 8}, {259, 1},   {262, 2},
                                          {273, 0}, {277, 3}, {278, 5}, {279, 135}, {339, 1}};
    const auto count = static_cast<std::uint32_t>(std::size(kTags));
    std::string file = "II*" + std::string(1, '\0') + word(8, 4) + word(count, 2);
    for (const auto& [tag, value] : kTags) {
        file += word(tag, 2) + word(4, 2) + word(1, 4);
        file += word(tag == 273 ? 14 + 12 * count : value, 4);
    }
    return file + word(0, 4) + bytes;
}

TEST_F(LoaderFuzz, OtherPictures) {
    const std::string bytes(4 * 9 * 5 * 3, '\x40');
    stbi_write_jpg((own.path() / "a.jpg").c_str(), 9, 5, 3, bytes.data(), 90);
    const std::string seeds[] = {
        own.path() / "a.jpg",
        own.write("a.tif", smallTiff(bytes)),
        own.write("a.pfm", "PF\n9 5\n-1\n" + bytes),
        own.write("a.ppm", "P6 9 5 255\n" + bytes),
        own.write("a.hdr", "#?RADIANCE\nEXPOSURE=2\n\n-Y 5 +X 9\n" + bytes),
        own.write("rle.hdr",
                  std::string("#?RADIANCE\n\n-Y 1 +X 9\n\2\2\0\x09\x89\1\x89\2\x89\3\x89\4", 35)),
        own.write("a.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\x09\0\5\0\x18\0", 18) + bytes),
        own.write("rle.tga", std::string("\0\0\x0b\0\0\0\0\0\0\0\0\0\x09\0\1\0\x08\0\x88\7", 20)),
    };
    for (const std::string& seed : seeds) EXPECT_EQ(image::readPicture(seed).width, 9) << seed;
    fuzzAll(kReadPicture, seeds, 20);
}

TEST_F(LoaderFuzz, Configs) {
    std::vector<fs::path> all;
    for (const char* folder : {"smoke", "sweeps", "zju2005"}) {
        for (const auto& entry : fs::directory_iterator(fs::path(GFXREPRO_CONFIGS) / folder)) {
            if (hasExtension(entry.path(), {".yaml"})) all.push_back(entry.path());
        }
    }
    std::sort(all.begin(), all.end());
    fuzzAll(kLoadConfig, all);
}

TEST_F(LoaderFuzz, FilesOfRuns) {
    const fs::path records = own.path() / "records.csv";
    const records::Record row{.caseId = "0123456789ab",
                              .table = "zju2005/2.1",
                              .method = R"(a, "b")",
                              .metric = "psnr_db"};
    std::vector<records::Record> rows(3, row);
    rows[1].frame = 1;
    rows[2].process = 1;
    rows[2].status = records::Status::Crash;
    rows[2].message = "about\nto crash";
    records::RecordWriter(records).append(rows);
    records::ImageWriter(own.path())
        .append({{"0123456789ab", "zju2005/2.1", 0, "flat", "images/a/b.png", "images/a/b.exr",
                  "a, \"title\"", ""}});
    const fs::path plan =
        own.write("plan.json", R"({"a": [1, 2.5e3, "x\u00e9"], "b": {"c": null}})");
    fs::create_directories(work.path() / "images");
    for (int round = 0; round < 20; ++round) {
        fuzz(kReadRecords, records, ++number, work.path());
        fuzz(kReadImages, own.path() / "images/index.csv", ++number, work.path() / "images");
        fuzz(kParseJson, plan, ++number, work.path());
    }
}

/// Files of quite another kind, given to every loader.
TEST_F(LoaderFuzz, AnythingToAnyLoader) {
    const fs::path text = own.write("notes.txt", "v f usemtl ply glTF \x89PNG 1 2 3\n");
    std::vector<fs::path> all = seeds("invalid_misc", {text, own.write("empty", "")});
    const std::vector<fs::path> others = seeds("stl", {});
    all.insert(all.end(), others.begin(), others.end());
    for (const Load& load : {kLoadPly, kLoadObj, kLoadGltf, kReadPng, kReadExr}) fuzzAll(load, all);
}

/// In a file of zeros each byte is a face: memory for as many triangles would be twelve times it.
TEST_F(LoaderFuzz, FacesWithoutCornersTakeNoMemory) {
    constexpr std::size_t kBytes = 20'000'000;
    const auto path =
        own.write("a.ply",
                  "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                  "property float y\nproperty float z\nelement face 19000000\n"
                  "property list uchar int vertex_indices\nend_header\n");
    fs::resize_file(path, kBytes);  // nearly all of it a hole
    resetPeakMemory();
    EXPECT_TRUE(scene::loadPly(path).meshes.empty());
    EXPECT_LE(peakMemoryBytes(), kBytes);
}

}  // namespace
}  // namespace gfxrepro
