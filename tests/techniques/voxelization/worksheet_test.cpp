#include "techniques/voxelization/worksheet.h"

#include "engine/gl/pass.h"
#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/voxelization.h"
#include "tests/techniques/voxelization/voxel_value.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

constexpr int kVoxelBits[] = {1, 8, 16, 32};
const GridShape kLaidOutShapes[] = {
    32,
    64,
    45,
    GridShape({70, 5, 39}),
    GridShape({3, 90, 64}),
    GridShape({1, 1, 101}),
    GridShape({700, 300, 3}),
};

TEST(WorksheetTest, EveryVoxelHasItsOwnBits) {
    for (const int bits : kVoxelBits) {
        for (const GridShape& shape : kLaidOutShapes) {
            const WorksheetLayout layout(shape, bits);
            std::vector<std::uint32_t> words(layout.wordCount());
            forEachVoxel(shape, [&](const glm::ivec3& local) {
                const std::uint32_t mask = layout.laneMask() << layout.shift(local.z);
                std::uint32_t& word = words.at(layout.wordIndex(local));
                ASSERT_EQ(word & mask, 0U) << local.x << " " << local.y << " " << local.z;
                word |= mask;
            });
            if (shape != GridShape(32) && shape != GridShape(64)) continue;
            for (const std::uint32_t word : words) ASSERT_EQ(word, ~0U);
        }
    }
}

// A quarter is wasted at most, beside the last slab's bits, whatever the shape.
TEST(WorksheetTest, PatchesFillTheirSheets) {
    for (const int bits : kVoxelBits) {
        for (int n = 1; n < 1300; n += 7) {
            for (const GridShape& shape : {GridShape(n), GridShape({n, 40, 300}),
                                           GridShape({900, n, 20}), GridShape({30, 500, n})}) {
                const WorksheetLayout layout(shape, bits);
                const glm::ivec2 size = layout.sheetSizePx();
                ASSERT_LE(std::max(size.x, size.y), 2048) << shape.text();
                const int patches = layout.patchesPerSheet() * layout.layers();
                ASSERT_LE(4 * (patches - layout.slabCount()), layout.slabCount()) << shape.text();
            }
        }
    }
}

// What is longer than the thesis's sheet has a larger one.
TEST(WorksheetTest, PatchesMayBeLargerThanTheThesisSheet) {
    const WorksheetLayout layout(GridShape({5000, 30, 40}), 1);
    EXPECT_EQ(layout.sheetSizePx(), glm::ivec2(5000, 60));
    EXPECT_EQ(layout.layers(), 1);
}

TEST(WorksheetTest, CapacityIsTheNumberOfVoxels) {
    for (const int bits : kVoxelBits) {
        for (int n = 32; n <= 1024; n *= 2) {
            const WorksheetLayout layout(n, bits);
            const glm::ivec2 size = layout.sheetSizePx();
            EXPECT_LE(size.x, 2048);
            EXPECT_LE(size.y, 2048);
            const auto voxels = static_cast<std::size_t>(size.x) * size.y * layout.layers() *
                                layout.voxelsPerTexel();
            EXPECT_EQ(voxels, static_cast<std::size_t>(n) * n * n) << n << " " << bits;
        }
    }
}

// [zju2005] Sec. 2.2.1: one sheet of 2048² texels of 32 bits holds 512³ bits.
TEST(WorksheetTest, TheThesisSheetHolds512CubedBits) {
    const WorksheetLayout layout(512, 1);
    EXPECT_EQ(layout.sheetSizePx(), glm::ivec2(2048));
    EXPECT_EQ(layout.layers(), 1);
    EXPECT_EQ(layout.patchesPerSheet(), 16);
    EXPECT_EQ(layout.sizeBytes(), std::size_t{16} << 20);
    EXPECT_EQ(layout.texel({3, 5, 32 * 6 + 7}), glm::ivec3(2 * 512 + 3, 512 + 5, 0));
    EXPECT_EQ(layout.shift(32 * 6 + 7), 7);
}

TEST(WorksheetTest, AxesPermuteCyclically) {
    const glm::ivec3 p(1, 2, 3);
    EXPECT_EQ(localFromVolume(Axis::X, p), glm::ivec3(2, 3, 1));
    EXPECT_EQ(localFromVolume(Axis::Y, p), glm::ivec3(3, 1, 2));
    EXPECT_EQ(localFromVolume(Axis::Z, p), p);
    for (Axis axis : kAxes) EXPECT_EQ(volumeFromLocal(axis, localFromVolume(axis, p)), p);
}

TEST(WorksheetTest, DenseGridHoldsValues) {
    for (const int bits : kVoxelBits) {
        DenseGrid grid(WorksheetLayout(32, bits));
        const std::uint32_t value = grid.layout().laneMask();
        grid.set({1, 2, 3}, value);
        grid.set({31, 31, 31}, 1);
        EXPECT_EQ(grid.value({1, 2, 3}), value);
        EXPECT_EQ(grid.value({31, 31, 31}), 1U);
        EXPECT_EQ(grid.value({1, 2, 4}), 0U);
        EXPECT_EQ(grid.countFull(), 2U);
        grid.set({1, 2, 3}, 0);
        EXPECT_EQ(grid.countFull(), 1U);
    }
}

TEST(WorksheetTest, RefusesWhatTheDeviceCannotHold) {
    gl::DeviceLimits limits{.maxTextureSizePx = 16384, .maxArrayLayers = 2048};
    EXPECT_NO_THROW(checkFitsDevice(WorksheetLayout(512, 32), limits));
    EXPECT_NO_THROW(checkFitsDevice(WorksheetLayout(1024, 1), limits));
    EXPECT_NO_THROW(checkFitsDevice(WorksheetLayout(1024, 8), limits));
    EXPECT_EQ(errorText([&] { checkFitsDevice(WorksheetLayout(1024, 16), limits); }),
              "1024³ voxels of 16 bits take 2147483648 bytes an axis; allowed: 1073741824");
    limits.maxArrayLayers = 16;
    EXPECT_EQ(errorText([&] { checkFitsDevice(WorksheetLayout(512, 32), limits); }),
              "512³ voxels of 32 bits take 32 worksheets of 2048 × 2048 texels; the device holds "
              "16 of 16384 × 16384");
    EXPECT_THROW(checkFitsDevice(WorksheetLayout(512, 32), limits), UnsupportedError);
}

using WorksheetGlTest = VoxelizerTest;

TEST_F(WorksheetGlTest, ShaderAddressesEqualTheCpus) {
    const ShaderFolder folder(R"(#version 450 core
#include "voxelization/worksheet.glsl"
layout(local_size_x = 64) in;
layout(std430) buffer Out { ivec4 address[]; };
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= SIZE.x * SIZE.y * SIZE.z) return;
    ivec3 local = ivec3(i % SIZE.x, i / SIZE.x % SIZE.y, i / SIZE.x / SIZE.y);
    address[i] = ivec4(worksheetTexel(local), worksheetShift(local.z));
}
)");
    for (const int bits : kVoxelBits) {
        for (const GridShape& shape : kLaidOutShapes) {
            const WorksheetLayout layout(shape, bits);
            const std::size_t count = shape.voxelCount();
            gl::Buffer buffer(count * sizeof(glm::ivec4));
            folder.pass(layout.defines()).dispatch({count / 64 + 1, 1, 1}, {{"Out", buffer}});
            const auto addresses = buffer.read<glm::ivec4>(count);
            std::size_t i = 0;
            forEachVoxel(shape, [&](const glm::ivec3& local) {
                ASSERT_EQ(addresses[i++], glm::ivec4(layout.texel(local), layout.shift(local.z)));
            });
        }
    }
}

TEST_F(WorksheetGlTest, ShaderValuesEqualTheCpus) {
    const ShaderFolder folder(R"(#version 450 core
#include "voxelization/voxel_value.glsl"
layout(local_size_x = 1) in;
layout(std430) readonly buffer In { float data[]; };
layout(std430) buffer Out { uint codes[]; };
layout(std430) buffer Decoded { float decoded[]; };
void put(uint i, vec3 v) { for (int k = 0; k < 3; ++k) decoded[3u * i + k] = v[k]; }
void main() {
    uint i = gl_GlobalInvocationID.x;
    vec3 v = vec3(data[3u * i], data[3u * i + 1u], data[3u * i + 2u]);
    codes[i] = encodeNormal(v);
    put(i, decodeNormal(codes[i]));
}
)");
    std::vector<glm::vec3> vectors = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {-1, 0, 0},
                                      {0, -1, 0}, {0, 0, -1}, {0, 0, 0}};
    Random random(3);
    while (vectors.size() < 200) {
        const float x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
        vectors.push_back(glm::normalize(glm::vec3(x, y, z)));
    }
    for (const int bits : {8, 16, 32}) {
        const gl::Buffer in = gl::Buffer::of(vectors);
        const gl::Buffer out(vectors.size() * 4);
        const gl::Buffer back(vectors.size() * 12);
        folder.pass(WorksheetLayout(32, bits).defines())
            .dispatch({vectors.size(), 1, 1}, {{"In", in}, {"Out", out}, {"Decoded", back}});
        const auto codes = out.read<std::uint32_t>(vectors.size());
        const auto decoded = back.read<glm::vec3>(vectors.size());
        // Half a level h moves the point of the octahedron by up to (h, h, 2h), which normalizing,
        // by at least 1/√3, makes √18 h.
        const float levels = bits == 8 ? 14.0F : bits == 16 ? 254.0F : 32766.0F;
        const float tolerance = std::sqrt(18.0F) / levels;
        int differing = 0;
        for (std::size_t i = 0; i < vectors.size(); ++i) {
            ASSERT_NE(codes[i], 0U);
            // Dividing and rounding may differ by one level between device and CPU at 32 bits.
            if (codes[i] != encodeNormal(vectors[i], bits)) ++differing;
            const glm::vec3 normal = decodeNormal(codes[i], bits);
            EXPECT_LT(glm::length(decoded[i] - normal), 1e-5F);
            if (i < 6) EXPECT_LT(glm::length(normal - vectors[i]), 1e-6F);
            if (i != 6) EXPECT_LT(glm::length(normal - vectors[i]), tolerance);
        }
        EXPECT_LE(differing, bits == 32 ? 40 : 0);
    }
}

TEST(AxisSplitTest, TakesTheLargestProjection) {
    const glm::vec3 o(0.0F), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    EXPECT_EQ(dominantAxis(o, y, z), Axis::X);
    EXPECT_EQ(dominantAxis(o, x, z), Axis::Y);
    EXPECT_EQ(dominantAxis(o, y, x), Axis::Z);
    EXPECT_EQ(dominantAxis(o, x, x), Axis::Z);
    EXPECT_EQ(dominantAxis(o, x + 0.9F * y, z), Axis::Y);
    EXPECT_EQ(dominantAxis(o, 0.9F * x + y, z), Axis::X);
}

TEST(AxisSplitTest, KeepsEveryTriangleOnce) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0), 1.0F, 6);  // more than one chunk
    AxisSplit split;
    splitByAxis(mesh.positions, mesh.triangles, split);
    std::size_t next = 0;
    for (Axis axis : kAxes) {
        const TriangleRange range = split.range(axis);
        EXPECT_EQ(static_cast<std::size_t>(range.first), next);
        next += static_cast<std::size_t>(range.count);
        // In the mesh's order: the subsequence of the axis's triangles.
        auto at = split.triangles.begin() + range.first;
        for (const glm::uvec3& t : mesh.triangles) {
            const Axis own =
                dominantAxis(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
            if (own == axis) ASSERT_EQ(*at++, t);
        }
        EXPECT_EQ(at, split.triangles.begin() + range.first + range.count);
    }
    EXPECT_EQ(next, mesh.triangles.size());
}

}  // namespace
}  // namespace gfxrepro::voxelization
