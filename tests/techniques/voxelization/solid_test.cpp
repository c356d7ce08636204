// Solid voxelization against ray parity, volumes and open meshes.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numbers>

#include "engine/core/random.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/voxelization/combination.h"
#include "tests/support/crossings.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

using SolidTest = VoxelizerTest;

/// Voxels that are not what the rays say: those whose centre is within a lattice step of a
/// crossing, and others.
struct Differences {
    std::size_t onSurface = 0;
    std::size_t elsewhere = 0;
};

/// Counts the voxels whose centre's side disagrees with the parity of Embree's crossings of the
/// snapped mesh (in voxels: exact as floats). The rays pass a sixteenth of a lattice step beside
/// the centres, for Embree may count a ray through a shared edge twice.
Differences countAgainstRays(const DenseGrid& grid, const LatticeMesh& lattice) {
    scene::Mesh mesh;
    mesh.triangles.assign(lattice.triangles.begin(), lattice.triangles.end());
    for (const glm::ivec3& p : lattice.positions) {
        mesh.positions.push_back(glm::vec3(p) / static_cast<float>(kLatticePerVoxel));
    }
    const raycast::RayTracer tracer(scene::sceneOf(mesh));
    const int n = grid.shape().longest();
    Differences result;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const glm::vec3 start(static_cast<float>(x) + 0.5F + 0x1p-12F,
                                  static_cast<float>(y) + 0.5F + 0x1p-15F, -1);
            const auto hits = test::allHits(tracer, start, {0, 0, 1});
            for (int z = 0; z < n; ++z) {
                const float centre = static_cast<float>(z) + 1.5F;
                const auto before = std::ranges::count_if(
                    hits, [&](const auto& hit) { return hit.distance < centre; });
                if (grid.isFull({x, y, z}) == (before % 2 == 1)) continue;
                const bool isOnSurface = std::ranges::any_of(hits, [&](const auto& hit) {
                    return std::abs(hit.distance - centre) * kLatticePerVoxel < 1.0F;
                });
                ++(isOnSurface ? result.onSurface : result.elsewhere);
            }
        }
    }
    return result;
}

TEST_F(SolidTest, EqualsTheParityOfRays) {
    const std::vector<scene::Mesh> meshes = {
        shapes::sphere(glm::vec3(0.013F, 0.017F, 0.019F), 1.0F, 4),
        shapes::torus(glm::vec3(0.0F, 0.011F, 0.0F), 0.71F, 0.29F, 97, 53),
        shapes::joined(shapes::sphere(glm::vec3(0.0F), 1.0F, 4),
                       shapes::sphere(glm::vec3(0.05F, 0.1F, 0.0F), 0.5F, 3))};
    for (const scene::Mesh& mesh : meshes) {
        for (const int n : {64, 128}) {
            const auto s = solid(n);
            const Voxelized result = voxelize(mesh, s);
            EXPECT_GT(result.grid.countFull(), 0U);
            const Differences differences = countAgainstRays(result.grid, lattice(mesh, s));
            EXPECT_EQ(differences.elsewhere, 0U) << n;
            // Of 262,144 and 2,097,152: the rays' distance from the centres, float rounding.
            EXPECT_LE(differences.onSurface, 8U) << n;
            EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"), 0.0);
            EXPECT_EQ(result.metrics.at("disagreeing_voxels"), 0.0);
        }
    }
}

TEST_F(SolidTest, EqualsTheReference) {
    const std::vector<scene::Mesh> meshes = {
        shapes::sphere(glm::vec3(0.0F), 1.0F, 4), shapes::torus(glm::vec3(0), 0.7F, 0.3F, 60, 30),
        shapes::cube(glm::vec3(0.0F), glm::vec3(30.0F)),
        // Every face through voxel centres: ties on every scan line of its boundary.
        shapes::joined(shapes::cube(glm::vec3(0.0F), glm::vec3(30.0F)),
                       shapes::cube(glm::vec3(5.5F), glm::vec3(20.5F)))};
    for (const scene::Mesh& mesh : meshes) {
        for (const int bits : {1, 8, 16, 32}) {
            const Voxelized result = voxelize(mesh, solid(32, bits));
            const reference::SolidVoxels expected = reference::solid(lattice(mesh, solid(32)), 32);
            EXPECT_EQ(occupancyOf(result.grid), expected.grid) << bits;
            EXPECT_EQ(expected.ambiguousScanLines, 0U);
            EXPECT_EQ(expected.disagreeingVoxels, 0U);
            EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"), 0.0);
            EXPECT_EQ(result.metrics.at("disagreeing_voxels"), 0.0);
        }
    }
}

MeshVoxelizerSettings byVoxels(int resolution, int voxelBits = 1) {
    MeshVoxelizerSettings result;
    result.grid.layout = WorksheetLayout(resolution, voxelBits);
    result.grid.fill = Fill::Solid;
    result.method = Method::Worksheet;
    result.rule = Rule::Rasterized;
    result.fillRule = FillRule::SurfaceVoxels;
    return result;
}

// [zju2005] Sec. 2.2.3. Every line through a cube of whole voxels enters and leaves in a voxel of
// its own: the flag that flips at voxels is right, and the voxels of the surface are full.
TEST_F(SolidTest, FlippingAtVoxelsFillsACube) {
    const scene::Mesh cube = shapes::cube(glm::vec3(1.2F), glm::vec3(28.8F));
    const scene::Box box{glm::vec3(0.0F), glm::vec3(32.0F)};
    for (const int bits : {1, 8, 16, 32}) {
        auto s = byVoxels(32, bits);
        const Voxelized result = voxelize(cube, s, box);
        EXPECT_EQ(result.grid.countFull(), 28U * 28 * 28) << bits;
        EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"), 0.0);
        EXPECT_FALSE(result.metrics.contains("disagreeing_voxels"));
        s.addressing = Addressing::Tables;
        EXPECT_EQ(voxelize(cube, s, box).grid, result.grid) << bits;
    }
}

// A plate that is thinner than a voxel: lines across it meet one voxel, and the flag stays on to
// the grid's end, where the exact crossings come out.
TEST_F(SolidTest, FlippingAtVoxelsLeavesStreaks) {
    const scene::Mesh plate = shapes::cube(glm::vec3(4, 4, 10.2F), glm::vec3(14, 14, 10.4F));
    const scene::Box box{glm::vec3(0.0F), glm::vec3(32.0F)};
    const Voxelized streaked = voxelize(plate, byVoxels(32), box);
    EXPECT_EQ(streaked.metrics.at("ambiguous_scan_lines"), 100.0);
    EXPECT_EQ(streaked.grid.countFull(), 100U * 22);  // from z = 10 to 31
    EXPECT_EQ(reference::countOddScanLines(snapped(plate, box, 32), 32), 100U);
    const scene::Mesh cube = shapes::cube(glm::vec3(1.2F), glm::vec3(28.8F));
    EXPECT_EQ(reference::countOddScanLines(snapped(cube, box, 32), 32), 0U);
    const Voxelized exact = voxelize(plate, solid(32), box);
    EXPECT_EQ(exact.metrics.at("ambiguous_scan_lines"), 0.0);
    EXPECT_EQ(exact.grid.countFull(), 0U);  // no voxel has its centre inside
}

TEST_F(SolidTest, VolumesAreRight) {
    const auto s = solid(128);
    const scene::Mesh sphere = shapes::sphere(glm::vec3(0.0F), 1.0F, 5);
    const double edge = boxOf(sphere, s).size().x / 128.0;
    const double volume =
        static_cast<double>(voxelize(sphere, s).grid.countFull()) * edge * edge * edge;
    EXPECT_NEAR(volume, 4.0 / 3.0 * glm::pi<double>(), 0.01 * 4.0 / 3.0 * glm::pi<double>());
    // 30 voxels' edge, faces on voxel faces: exactly the cube.
    const scene::Mesh cube = shapes::cube(glm::vec3(0.0F), glm::vec3(30.0F));
    EXPECT_EQ(voxelize(cube, solid(32)).grid.countFull(), 27'000U);
}

TEST_F(SolidTest, GeometryBeyondTheBoxCounts) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0.0F), 1.0F, 4);
    const scene::Box box{glm::vec3(-0.3F), glm::vec3(0.5F)};
    const Voxelized result = voxelize(mesh, solid(64), box);
    EXPECT_EQ(
        result.grid.countFull(), 64U * 64U * 64U - [&] {
            const reference::SolidVoxels expected = reference::solid(snapped(mesh, box, 64), 64);
            return 64U * 64U * 64U - expected.grid.countFull();
        }());
    EXPECT_TRUE(result.grid.isFull({0, 0, 0}));
    EXPECT_TRUE(result.grid.isFull({63, 20, 20}));
    EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"), 0.0);
    EXPECT_EQ(result.metrics.at("disagreeing_voxels"), 0.0);
}

/// A cube of 30 voxels without its top (+y): 30² lines along y do not come out, and x and z agree.
scene::Mesh openCube() {
    scene::Mesh mesh = shapes::cube(glm::vec3(0.0F), glm::vec3(30.0F));
    mesh.triangles.erase(mesh.triangles.begin() + 6, mesh.triangles.begin() + 8);
    return mesh;
}

/// The scene turned by whole axes: (x, y, z) becomes (z, x, y).
scene::Mesh turned(scene::Mesh mesh) {
    for (glm::vec3& p : mesh.positions) p = glm::vec3(p.z, p.x, p.y);
    return mesh;
}

// Along each axis in turn: lines that do not come out are counted in words of many and of one.
TEST_F(SolidTest, ReportsOpenMeshes) {
    scene::Mesh mesh = openCube();
    for (const char* open : {"y", "z", "x"}) {
        for (const int bits : {1, 8, 32}) {
            const Voxelized result = voxelize(mesh, solid(32, bits));
            EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"), 900.0) << open << bits;
            // The axis goes on filling to the grid's end: one layer of 30² voxels.
            EXPECT_EQ(result.metrics.at("disagreeing_voxels"), 900.0) << open << bits;
            EXPECT_EQ(result.grid.countFull(), 27'000U);
        }
        mesh = turned(std::move(mesh));
    }
}

// The same without its top beyond the box: crossings behind the grid are missed as well.
TEST_F(SolidTest, ReportsMeshesThatAreOpenBehindTheBox) {
    scene::Mesh mesh = openCube();
    const scene::Box box{glm::vec3(-1.0F), glm::vec3(15.0F)};
    for (const char* open : {"y", "z", "x"}) {
        const Voxelized result = voxelize(mesh, solid(32), box);
        EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"), 900.0) << open;
        EXPECT_EQ(result.metrics.at("disagreeing_voxels"), 0.0);
        EXPECT_EQ(result.grid.countFull(), 27'000U);
        mesh = turned(std::move(mesh));
    }
}

// Boolean operations and collision on worksheets, against spheres' formulas and bit by bit.

/// Solid; the grid's box is [-1, 1]³.
DenseGrid sphere(const WorksheetLayout& layout, const glm::vec3& centre, float radius) {
    DenseGrid grid(layout);
    const float size = 2.0F / static_cast<float>(layout.shape().longest());
    forEachVoxel(layout.shape(), [&](const glm::ivec3& voxel) {
        const glm::vec3 p = (glm::vec3(voxel) + 0.5F) * size - 1.0F;
        if (glm::distance(p, centre) <= radius) grid.set(voxel, 1);
    });
    return grid;
}

DenseGrid randomGrid(const WorksheetLayout& layout, std::uint64_t seed) {
    Random random(seed);
    DenseGrid grid(layout);
    forEachVoxel(layout.shape(), [&](const glm::ivec3& voxel) {
        if (random.index(3) == 0) grid.set(voxel, std::max(random.next() & layout.laneMask(), 1U));
    });
    return grid;
}

struct VolumeOperation : GlTest, testing::WithParamInterface<int> {
    DenseGrid combined(const DenseGrid& left, const DenseGrid& right, CsgOperation operation) {
        const gl::Texture a = uploaded(left);
        const gl::Texture b = uploaded(right);
        const gl::Texture result = makeSheets(left.layout());
        CsgPass(shaders(), left.layout(), operation).run(a, b, result);
        return DenseGrid(left.layout(), readSheets(result));
    }
    std::uint32_t countOf(const DenseGrid& grid) {
        CountPass pass(shaders(), grid.layout());
        pass.run(uploaded(grid));
        return pass.read();
    }
};
INSTANTIATE_TEST_SUITE_P(VoxelBits, VolumeOperation, testing::Values(1, 8, 16, 32));

double sphereVolume(double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// Of two spheres of one radius at a distance below two radii.
double lensVolume(double radius, double distance) {
    return std::numbers::pi * (4 * radius + distance) * std::pow(2 * radius - distance, 2) / 12;
}

TEST_P(VolumeOperation, VolumesOfTwoSpheresAreThoseOfTheFormula) {
    const WorksheetLayout layout(64, GetParam());
    const DenseGrid a = sphere(layout, {-0.2F, 0.0F, 0.0F}, 0.6F);
    const DenseGrid b = sphere(layout, {0.2F, 0.0F, 0.0F}, 0.6F);
    const double voxelVolume = std::pow(2.0 / 64, 3);
    const double lens = lensVolume(0.6, 0.4);
    const auto volume = [&](CsgOperation operation) {
        return static_cast<double>(combined(a, b, operation).countFull()) * voxelVolume;
    };
    const double both = volume(CsgOperation::Intersection);
    EXPECT_NEAR(both / lens, 1, 0.02);
    EXPECT_NEAR(volume(CsgOperation::Union) / (2 * sphereVolume(0.6) - lens), 1, 0.01);
    EXPECT_NEAR(volume(CsgOperation::Difference) / (sphereVolume(0.6) - lens), 1, 0.02);
}

TEST_P(VolumeOperation, EachVoxelFollowsItsOwnValues) {
    const WorksheetLayout layout(32, GetParam());
    const DenseGrid a = randomGrid(layout, 1);
    const DenseGrid b = randomGrid(layout, 2);
    const DenseGrid unionGrid = combined(a, b, CsgOperation::Union);
    const DenseGrid common = combined(a, b, CsgOperation::Intersection);
    const DenseGrid rest = combined(a, b, CsgOperation::Difference);
    int wrong = 0;
    forEachVoxel(32, [&](const glm::ivec3& v) {
        if (unionGrid.value(v) != (a.isFull(v) ? a.value(v) : b.value(v))) ++wrong;
        if (common.value(v) != (b.isFull(v) ? a.value(v) : 0U)) ++wrong;
        if (rest.value(v) != (b.isFull(v) ? 0U : a.value(v))) ++wrong;
    });
    EXPECT_EQ(wrong, 0);
}

TEST_P(VolumeOperation, DeMorgansLawsHoldExactly) {
    const WorksheetLayout layout(32, GetParam());
    DenseGrid full(layout);
    forEachVoxel(32, [&](const glm::ivec3& voxel) { full.set(voxel, 1); });
    const DenseGrid a = randomGrid(layout, 3);
    const DenseGrid b = randomGrid(layout, 4);
    const auto without = [&](const DenseGrid& left, const DenseGrid& right) {
        return combined(left, right, CsgOperation::Difference);
    };
    EXPECT_EQ(without(full, combined(a, b, CsgOperation::Union)),
              combined(without(full, a), without(full, b), CsgOperation::Intersection));
    EXPECT_EQ(without(full, combined(a, b, CsgOperation::Intersection)),
              combined(without(full, a), without(full, b), CsgOperation::Union));
}

TEST_P(VolumeOperation, ResultMayReplaceAnOperand) {
    const WorksheetLayout layout(32, GetParam());
    const DenseGrid a = randomGrid(layout, 5);
    const DenseGrid b = randomGrid(layout, 6);
    const gl::Texture left = uploaded(a);
    CsgPass(shaders(), layout, CsgOperation::Difference).run(left, uploaded(b), left);
    EXPECT_EQ(DenseGrid(layout, readSheets(left)), combined(a, b, CsgOperation::Difference));
}

TEST_P(VolumeOperation, CollisionOfSpheresIsTheirLens) {
    const WorksheetLayout layout(64, GetParam());
    const DenseGrid a = sphere(layout, {-0.25F, 0.0F, 0.0F}, 0.5F);
    const DenseGrid b = sphere(layout, {0.25F, 0.0F, 0.0F}, 0.5F);
    const DenseGrid common = combined(a, b, CsgOperation::Intersection);
    EXPECT_EQ(countOf(common), common.countFull());
    EXPECT_NEAR(countOf(common) * std::pow(2.0 / 64, 3) / lensVolume(0.5, 0.5), 1, 0.02);
}

TEST_P(VolumeOperation, ModelsApartDoNotCollide) {
    const WorksheetLayout layout(32, GetParam());
    const DenseGrid common =
        combined(sphere(layout, {-0.5F, 0.0F, 0.0F}, 0.4F),
                 sphere(layout, {0.5F, 0.0F, 0.0F}, 0.4F), CsgOperation::Intersection);
    EXPECT_EQ(countOf(common), 0U);
}

}  // namespace
}  // namespace gfxrepro::voxelization
