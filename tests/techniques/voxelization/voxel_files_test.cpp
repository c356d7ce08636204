// Files of voxels, read again by other readers than there are writers of.
#include "techniques/voxelization/voxel_files.h"

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <tuple>

#include "engine/core/files.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::voxelization {
namespace {

using Colour = std::array<std::uint8_t, 3>;
using Place = std::tuple<int, int, int>;
using Colours = std::map<Place, Colour>;  // of the full voxels

using VoxelFiles = FolderTest;

Place placeIn(const glm::ivec3& v) {
    return {v.x, v.y, v.z};
}

/// Every seventh voxel or so, in colours of their own.
VoxelModel sample(const GridShape& shape) {
    VoxelModel model{.shape = shape,
                     .origin = {500000.25, -2, 0.125},
                     .voxelSize = 0.1,
                     .source = "a \"model\""};
    for (const auto [x, y] : test::grid(shape.size.x, shape.size.y)) {
        for (int z = 0; z < shape.size.z; ++z) {
            if ((x * 31 + y * 17 + z * 3) % 7 > 0 && x != 3) continue;
            model.voxels.emplace_back(x, y, z);
            model.normals.push_back(glm::normalize(glm::vec3(x, y, z) + 1.0F));
            model.colors.push_back({static_cast<std::uint8_t>(x % 5 * 50),
                                    static_cast<std::uint8_t>(y % 4 * 60),
                                    static_cast<std::uint8_t>(z % 3 * 90)});
        }
    }
    return model;
}

Colours coloursOf(const VoxelModel& model) {
    Colours colours;
    for (std::size_t i = 0; i < model.voxels.size(); ++i) {
        colours[placeIn(model.voxels[i])] = model.colors[i];
    }
    return colours;
}

template <class T>
T valueAt(const std::string& bytes, std::size_t at) {
    T value{};
    EXPECT_LE(at + sizeof(T), bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

struct Array {
    std::string type;
    std::string shape;
    std::string data;
};

Array readNpy(const fs::path& path) {
    const std::string bytes = readFile(path);
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\1\0", 8));
    const std::size_t begin = 10 + valueAt<std::uint16_t>(bytes, 8);
    EXPECT_EQ(begin % 64, 0U);
    const std::string head = bytes.substr(10, begin - 10);
    std::smatch found;
    const std::regex form(
        R"(\{'descr': '(.*)', 'fortran_order': False, 'shape': \((.*)\), \} *\n)");
    EXPECT_TRUE(std::regex_match(head, found, form)) << head;
    return {found[1], found[2], bytes.substr(begin)};
}

TEST_F(VoxelFiles, NpyIsOfMaskOrder) {
    const VoxelModel model = sample(GridShape(glm::ivec3(20, 7, 11)));
    const auto written = writeVoxels(folder.path() / "m.npy", model);
    EXPECT_EQ(written,
              (std::vector<fs::path>{folder.path() / "m.npy", folder.path() / "m.normals.npy",
                                     folder.path() / "m.colors.npy", folder.path() / "m.json"}));
    const Array mask = readNpy(written[0]);
    const Array normals = readNpy(written[1]);
    const Array colours = readNpy(written[2]);
    EXPECT_EQ(mask.type, "|b1");
    EXPECT_EQ(mask.shape, "20, 7, 11");
    ASSERT_EQ(mask.data.size(), 20U * 7U * 11U);
    EXPECT_EQ(normals.type, "<f4");
    EXPECT_EQ(colours.type, "|u1");
    EXPECT_EQ(normals.shape, std::to_string(model.voxels.size()) + ", 3");
    EXPECT_EQ(colours.shape, normals.shape);
    std::size_t next = 0;
    for (std::size_t i = 0; i < mask.data.size(); ++i) {
        if (mask.data[i] == 0) continue;
        const int at = static_cast<int>(i);
        ASSERT_LT(next, model.voxels.size());
        EXPECT_EQ(model.voxels[next], glm::ivec3(at / 77, at / 11 % 7, at % 11));
        EXPECT_EQ(valueAt<glm::vec3>(normals.data, 12 * next), model.normals[next]);
        EXPECT_EQ(valueAt<Colour>(colours.data, 3 * next), model.colors[next]);
        ++next;
    }
    EXPECT_EQ(next, model.voxels.size());
    EXPECT_EQ(normals.data.size(), 12 * next);
    EXPECT_EQ(colours.data.size(), 3 * next);
}

TEST_F(VoxelFiles, FactsStandBeside) {
    const VoxelModel model = sample(GridShape(glm::ivec3(20, 7, 11)));
    for (const char* name : {"m.npy", "m.vox", "m.binvox"}) {
        const auto written = writeVoxels(folder.path() / name, model);
        EXPECT_EQ(written.back(), folder.path() / "m.json");
        EXPECT_EQ(nlohmann::json::parse(readFile(written.back())),
                  nlohmann::json::parse(R"({"shape": [20, 7, 11], "origin": [500000.25, -2, 0.125],
                      "voxel_size": 0.1, "model": "a \"model\"", "voxels": )" +
                                        std::to_string(model.voxels.size()) + "}"));
    }
}

/// As the format's own page reads it: depth, height and width, then runs; y runs fastest, then z.
std::map<Place, bool> readBinvox(const std::string& bytes, glm::dvec3& origin, double& side) {
    std::istringstream head(bytes);
    std::string line, word;
    std::getline(head, line);
    EXPECT_EQ(line, "#binvox 1");
    int depth = 0, height = 0, width = 0;
    head >> word >> depth >> height >> width;
    EXPECT_EQ(word, "dim");
    head >> word >> origin.x >> origin.y >> origin.z >> word >> side >> word;
    EXPECT_EQ(word, "data");
    head.get();
    std::map<Place, bool> full;
    int index = 0;
    for (int value = head.get(); value >= 0; value = head.get()) {
        for (int count = head.get(); count > 0; --count, ++index) {
            const int y = index % width, z = index / width % height, x = index / width / height;
            if (value == 1) full[{x, y, z}] = true;
        }
    }
    EXPECT_EQ(index, depth * height * width);
    return full;
}

TEST_F(VoxelFiles, BinvoxIsACube) {
    for (const glm::ivec3& size : {glm::ivec3(20, 7, 11), glm::ivec3(5, 40, 9), glm::ivec3(8)}) {
        const VoxelModel model = sample(GridShape(size));
        glm::dvec3 origin(0.0);
        double side = 0.0;
        const std::string bytes = readFile(writeVoxels(folder.path() / "m.binvox", model).front());
        const auto full = readBinvox(bytes, origin, side);
        EXPECT_EQ(full.size(), model.voxels.size());
        for (const glm::ivec3& voxel : model.voxels) EXPECT_TRUE(full.contains(placeIn(voxel)));
        EXPECT_EQ(origin, model.origin);
        EXPECT_DOUBLE_EQ(side, 0.1 * std::max({size.x, size.y, size.z}));
    }
}

/// The chunks of MagicaVoxel's description, in a model of its own axes.
Colours readVox(const std::string& bytes, glm::ivec3& size) {
    EXPECT_EQ(bytes.substr(0, 4), "VOX ");
    EXPECT_EQ(valueAt<std::int32_t>(bytes, 4), 150);
    EXPECT_EQ(bytes.substr(8, 4), "MAIN");
    EXPECT_EQ(valueAt<std::uint32_t>(bytes, 12), 0U);
    EXPECT_EQ(valueAt<std::uint32_t>(bytes, 16), bytes.size() - 20);
    std::map<std::string, std::string> chunks;
    for (std::size_t at = 20; at < bytes.size();) {
        const auto length = valueAt<std::uint32_t>(bytes, at + 4);
        EXPECT_EQ(valueAt<std::uint32_t>(bytes, at + 8), 0U);
        chunks[bytes.substr(at, 4)] = bytes.substr(at + 12, length);
        at += 12 + length;
    }
    size = valueAt<glm::ivec3>(chunks["SIZE"], 0);
    EXPECT_EQ(chunks["RGBA"].size(), 1024U);
    Colours colours;
    const auto count = valueAt<std::uint32_t>(chunks["XYZI"], 0);
    EXPECT_EQ(chunks["XYZI"].size(), 4 + 4 * std::size_t{count});
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto voxel = valueAt<std::array<std::uint8_t, 4>>(chunks["XYZI"], 4 + 4 * i);
        EXPECT_GT(voxel[3], 0);
        const auto colour =
            valueAt<std::array<std::uint8_t, 4>>(chunks["RGBA"], 4 * (voxel[3] - std::size_t{1}));
        EXPECT_EQ(colour[3], 255);
        colours[{voxel[0], voxel[1], voxel[2]}] = {colour[0], colour[1], colour[2]};
    }
    EXPECT_EQ(colours.size(), count);
    return colours;
}

TEST_F(VoxelFiles, VoxStandsAlongZ) {
    for (const glm::ivec3& size : {glm::ivec3(20, 7, 11), glm::ivec3(256, 2, 5)}) {
        const VoxelModel model = sample(GridShape(size));
        glm::ivec3 extent(0);
        const Colours turned =
            readVox(readFile(writeVoxels(folder.path() / "m.vox", model).front()), extent);
        EXPECT_EQ(extent, glm::ivec3(size.x, size.z, size.y));
        Colours colours;
        for (const auto& [at, colour] : turned) {
            const auto [x, y, z] = at;
            colours[{x, z, size.z - 1 - y}] = colour;
        }
        EXPECT_EQ(colours, coloursOf(model)) << "60 colours have places of their own";
    }
}

TEST_F(VoxelFiles, VoxJoinsSimilarColours) {
    VoxelModel model = sample(GridShape(16));
    for (std::size_t i = 0; i < model.colors.size(); ++i) {
        const auto level = static_cast<std::uint8_t>(i % 256);
        model.colors[i] = {level, static_cast<std::uint8_t>(255 - level), 7};
    }
    glm::ivec3 extent(0);
    const Colours turned =
        readVox(readFile(writeVoxels(folder.path() / "m.vox", model).front()), extent);
    const Colours expected = coloursOf(model);
    ASSERT_EQ(turned.size(), expected.size());
    for (const auto& [at, colour] : turned) {
        const auto [x, y, z] = at;
        const Colour& own = expected.at({x, z, 15 - y});
        // 256 levels: one bit less, so that each is as far as 1 from the mean of two.
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], own[c], 1);
    }
}

TEST_F(VoxelFiles, OtherFilesAreRefused) {
    const auto refusal = [](const char* path, int resolution) {
        return errorText([&] { requireVoxelFile(path, resolution); });
    };
    EXPECT_EQ(refusal("m.stl", 64), "m.stl: .npy, .vox and .binvox are allowed");
    EXPECT_EQ(refusal("m", 64), "m: .npy, .vox and .binvox are allowed");
    EXPECT_EQ(refusal("m.vox", 257),
              "m.vox: a .vox file has up to 256 voxels along an axis, and the grid 257; allowed: "
              ".npy and .binvox");
    for (const char* path : {"m.npy", "m.binvox"}) EXPECT_EQ(refusal(path, 1024), "no error");
    EXPECT_EQ(refusal("m.vox", 256), "no error");
}

/// All voxels of a grid.
DenseGrid full(const GridShape& shape) {
    DenseGrid grid(WorksheetLayout(shape, 1));
    forEachVoxel(shape, [&](const glm::ivec3& voxel) { grid.set(voxel, 1); });
    return grid;
}

TEST(VoxelModel, VoxelsLookAsTheNearestSurface) {
    scene::Scene scene = scene::sceneOf(shapes::sphere({0, 0, 0}, 1, 5));
    scene.offset = {100, 200, 300};
    scene.materials.emplace_back().baseColor = {1, 0, 0, 1};
    scene.meshes[0].material = 0;
    for (const glm::vec3& p : scene.meshes[0].positions) {
        scene.meshes[0].colors.emplace_back(p.y > 0 ? 1.0F : 0.0F);
    }
    const GridShape shape(glm::ivec3(12, 8, 10));
    const scene::Box box{{-1.5F, -1, -1.25F}, {1.5F, 1, 1.25F}};
    const VoxelModel model = voxelModelOf(full(shape), box, scene);
    EXPECT_EQ(model.origin, glm::dvec3(98.5, 199, 298.75));
    EXPECT_DOUBLE_EQ(model.voxelSize, 0.25);
    ASSERT_EQ(model.voxels.size(), shape.voxelCount());
    std::size_t inner = 0;
    for (std::size_t i = 0; i < model.voxels.size(); ++i) {
        const glm::vec3 centre = box.min + (glm::vec3(model.voxels[i]) + 0.5F) * 0.25F;
        if (std::abs(glm::length(centre) - 1.0F) > 0.26F) {
            EXPECT_EQ(model.normals[i], glm::vec3(0)) << "far from the surface";
            EXPECT_EQ(model.colors[i], Colour{});
            ++inner;
            continue;
        }
        EXPECT_GT(glm::dot(model.normals[i], glm::normalize(centre)), 0.999F);
        EXPECT_EQ(model.colors[i],
                  (Colour{static_cast<std::uint8_t>(centre.y > 0 ? 255 : 0), 0, 0}))
            << centre.y;
    }
    EXPECT_EQ(inner, 576U);  // of 960
}

TEST(VoxelModel, TexturesAreReadAsTheyAreDrawn) {
    scene::Mesh mesh{.positions = {{0, 0, 0}, {4, 0, 0}, {4, 0, 1}, {0, 0, 1}}};
    mesh.normals.assign(4, {0, 1, 0});  // against the winding: the file's own counts
    mesh.texcoords = {{-1, 0}, {3, 0}, {3, 1}, {-1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = 0;
    scene::Scene scene = scene::sceneOf(mesh);
    scene.materials.emplace_back().baseColor = {1, 1, 1, 1};
    scene.materials[0].baseColorTexture = 0;
    image::Image8& texture = scene.textures.emplace_back(2, 1, 3, std::uint8_t{10});
    texture.at(1, 0, 1) = 200;
    const GridShape shape(glm::ivec3(8, 1, 2));
    const scene::Box box{{0, -0.25F, 0}, {4, 0.25F, 1}};
    using Wrap = scene::Sampling::Wrap;
    const std::pair<Wrap, std::string> wraps[] = {
        {Wrap::Repeat, "01010101"}, {Wrap::Mirror, "10011001"}, {Wrap::Clamp, "00011111"}};
    for (const auto& [wrap, expected] : wraps) {
        scene.samplings = {{wrap, wrap, false}};
        const VoxelModel model = voxelModelOf(full(shape), box, scene);
        for (std::size_t i = 0; i < model.voxels.size(); ++i) {
            const bool isBright = expected[static_cast<std::size_t>(model.voxels[i].x)] == '1';
            EXPECT_EQ(model.colors[i],
                      (Colour{10, static_cast<std::uint8_t>(isBright ? 200 : 10), 10}))
                << expected << ' ' << model.voxels[i].x;
            EXPECT_EQ(model.normals[i], glm::vec3(0, 1, 0));
        }
    }
}

}  // namespace
}  // namespace gfxrepro::voxelization
