// Grids of any resolution, and of L × M × N voxels.
#include "techniques/voxelization/grid_shape.h"

#include <array>

#include "techniques/voxelization/combination.h"
#include "techniques/voxelization/formula_surface.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

// No side divides a texel's voxels or a work group but those of the last.
const GridShape kOddShapes[] = {37, GridShape({53, 11, 38}), GridShape({6, 70, 41}),
                                GridShape({64, 8, 32})};
constexpr int kWidths[] = {1, 8, 32};

/// With voxels of an edge of 1/8.
scene::Box placeOf(const GridShape& shape) {
    return {glm::vec3(0.0F), glm::vec3(shape.size) / 8.0F};
}

/// From end to end of a box, and beyond.
scene::Mesh stretched(scene::Mesh mesh, const scene::Box& from, const scene::Box& to) {
    for (glm::vec3& p : mesh.positions) p = to.min + (p - from.min) / from.size() * to.size();
    mesh.normals = scene::vertexNormals(mesh);
    return mesh;
}
scene::Mesh scattered(const GridShape& shape) {
    const scene::Box part{glm::vec3(0.1F), glm::vec3(0.9F)};
    return stretched(shapes::randomTriangles(300, 7), part, placeOf(shape));
}
scene::Mesh closedMesh(const GridShape& shape) {
    const scene::Box part{glm::vec3(-1.1F, -0.25F, -1.1F), glm::vec3(0.9F, 0.35F, 1.1F)};
    return stretched(shapes::torus(glm::vec3(0.0F), 0.7F, 0.3F, 60, 30), part, placeOf(shape));
}

/// Bits beyond the last slice, and patches without voxels, are empty.
std::size_t countVoxels(const DenseGrid& grid) {
    std::size_t count = 0;
    forEachVoxel(grid.shape(), [&](const glm::ivec3& voxel) { count += grid.isFull(voxel); });
    return count;
}

struct GridShapeTest : VoxelizerTest {
    DenseGrid gridOf(const scene::Mesh& mesh, const MeshVoxelizerSettings& s) {
        const DenseGrid grid = voxelize(mesh, s, placeOf(s.grid.layout.shape())).grid;
        EXPECT_EQ(grid.countFull(), countVoxels(grid));
        EXPECT_GT(grid.countFull(), 0U);
        return grid;
    }
    static LatticeMesh latticeOf(const scene::Mesh& mesh, const GridShape& shape) {
        return snapped(mesh, placeOf(shape), shape);
    }
    static MeshVoxelizerSettings flipped(const GridShape& shape, int voxelBits) {
        MeshVoxelizerSettings s = settings(shape, Rule::Rasterized, voxelBits);
        s.grid.fill = Fill::Solid;
        s.fillRule = FillRule::SurfaceVoxels;
        return s;
    }
};

TEST_F(GridShapeTest, ExactRulesAreAsOnTheCpu) {
    for (const GridShape& shape : kOddShapes) {
        const scene::Mesh mesh = scattered(shape);
        const LatticeMesh lattice = latticeOf(mesh, shape);
        const DenseGrid thin = reference::thin(lattice, shape);
        const DenseGrid conservative = reference::conservative(lattice, shape);
        for (const int bits : kWidths) {
            EXPECT_EQ(occupancyOf(gridOf(mesh, settings(shape, Rule::Thin, bits))), thin)
                << shape.text() << bits;
            EXPECT_EQ(occupancyOf(gridOf(mesh, settings(shape, Rule::Conservative, bits))),
                      conservative)
                << shape.text() << bits;
        }
    }
}

TEST_F(GridShapeTest, SolidsAreAsOnTheCpu) {
    for (const GridShape& shape : kOddShapes) {
        scene::Mesh mesh = closedMesh(shape);
        for (const bool isOpen : {false, true}) {
            if (isOpen) mesh.triangles.resize(mesh.triangles.size() * 9 / 10);
            const reference::SolidVoxels expected = reference::solid(latticeOf(mesh, shape), shape);
            EXPECT_EQ(expected.ambiguousScanLines > 0, isOpen) << shape.text();
            for (const int bits : kWidths) {
                const Voxelized result = voxelize(mesh, solid(shape, bits), placeOf(shape));
                EXPECT_EQ(occupancyOf(result.grid), expected.grid) << shape.text() << bits;
                EXPECT_EQ(result.grid.countFull(), countVoxels(result.grid)) << shape.text();
                EXPECT_EQ(result.metrics.at("ambiguous_scan_lines"),
                          static_cast<double>(expected.ambiguousScanLines));
                EXPECT_EQ(result.metrics.at("disagreeing_voxels"),
                          static_cast<double>(expected.disagreeingVoxels));
            }
        }
    }
}

// By worksheets, whose three sheets have three layouts, and each other way.
TEST_F(GridShapeTest, RasterizedIsOneGridByAllMethods) {
    for (const GridShape& shape : kOddShapes) {
        const scene::Mesh mesh = scattered(shape);
        const DenseGrid along = reference::thinAlongDominantAxes(latticeOf(mesh, shape), shape);
        for (const int bits : kWidths) {
            for (const VoxelValue value : {VoxelValue::Occupancy, VoxelValue::Normal}) {
                if (bits == 1 && value == VoxelValue::Normal) continue;
                MeshVoxelizerSettings s = settings(shape, Rule::Rasterized, bits);
                s.grid.value = value;
                const DenseGrid grid = gridOf(mesh, s);
                // What the hardware rounds, of slivers, too, and where it clips.
                const std::size_t few = along.countFull() / 20;
                EXPECT_LE(reference::countMissing(along, grid), few) << shape.text();
                EXPECT_LE(reference::countMissing(grid, along), few) << shape.text();
                s.addressing = Addressing::Tables;
                EXPECT_EQ(gridOf(mesh, s), grid) << shape.text() << bits;
                s.addressing = Addressing::Instructions;
                for (const Method method : {Method::Direct, Method::Slices}) {
                    s.method = method;
                    const DenseGrid other = gridOf(mesh, s);
                    EXPECT_EQ(other, grid)
                        << shape.text() << ", " << bits
                        << " bits: " << (method == Method::Direct ? "direct" : "slices")
                        << " lacks " << reference::countMissing(grid, other)
                        << " voxels, and has more: " << reference::countMissing(other, grid);
                }
            }
        }
    }
}

// The voxels of a cube that lie in it, by occupancy and by value.
TEST_F(GridShapeTest, ABoxIsPartOfACube) {
    const GridShape shape({53, 11, 38});
    const scene::Mesh mesh = scattered(shape);
    for (const Rule rule : {Rule::Thin, Rule::Conservative}) {
        for (const int bits : {8, 16, 32}) {
            MeshVoxelizerSettings s = settings(shape, rule, bits);
            s.grid.value = VoxelValue::Normal;
            const DenseGrid box = gridOf(mesh, s);
            s.grid.layout = WorksheetLayout(53, bits);
            const DenseGrid cube = gridOf(mesh, s);
            int different = 0;
            forEachVoxel(shape, [&](const glm::ivec3& voxel) {
                if (box.value(voxel) != cube.value(voxel)) ++different;
            });
            EXPECT_EQ(different, 0) << bits;
        }
    }
}

// Where a line does not come out, the thesis's flag stays on to the grid's end and no farther.
TEST_F(GridShapeTest, FlippingAtVoxelsEndsWithTheGrid) {
    const GridShape shape({30, 20, 37});
    const scene::Mesh cube = shapes::cube(glm::vec3(1.2F), glm::vec3(17.8F));
    const scene::Mesh plate = shapes::cube(glm::vec3(4, 4, 10.2F), glm::vec3(14, 14, 10.4F));
    const scene::Box box{glm::vec3(0.0F), glm::vec3(shape.size)};
    for (const int bits : kWidths) {
        auto s = flipped(shape, bits);
        for (const Addressing addressing : {Addressing::Instructions, Addressing::Tables}) {
            s.addressing = addressing;
            EXPECT_EQ(voxelize(cube, s, box).grid.countFull(), 17U * 17 * 17) << bits;
            const Voxelized streaked = voxelize(plate, s, box);
            EXPECT_EQ(streaked.metrics.at("ambiguous_scan_lines"), 100.0) << bits;
            EXPECT_EQ(streaked.grid.countFull(), 100U * 27) << bits;  // from z = 10 to 36
            EXPECT_EQ(countVoxels(streaked.grid), 100U * 27) << bits;
        }
    }
    EXPECT_EQ(reference::countOddScanLines(snapped(plate, box, shape), shape), 100U);
}

TEST_F(GridShapeTest, FormulasFillABoxAsACube) {
    const GridShape shape({40, 21, 35});
    for (const int bits : kWidths) {
        for (const Fill fill : {Fill::Surface, Fill::Solid}) {
            const auto gridOfFormula = [&](const GridShape& of) {
                Params params(parseYaml("{formula: x^2 + y^2 + z^2 - 9}", "test.yaml"), "test");
                ImplicitSource source(params, {.layout = WorksheetLayout(of, bits), .fill = fill},
                                      placeOf(of));
                technique::SetupContext context = setupContext();
                source.setup(context);
                source.render(profiler());
                return source.grid()->read();
            };
            const DenseGrid box = gridOfFormula(shape);
            const DenseGrid cube = gridOfFormula(40);
            EXPECT_EQ(box.countFull(), countVoxels(box));
            int different = 0;
            forEachVoxel(shape, [&](const glm::ivec3& voxel) {
                if (box.isFull(voxel) != cube.isFull(voxel)) ++different;
            });
            EXPECT_EQ(different, 0) << bits;
            EXPECT_GT(box.countFull(), 100U);
        }
        Params params(parseYaml("{samples: [300, 200]}", "test.yaml"), "test");
        ParametricSource source(
            params, {.layout = WorksheetLayout(45, bits), .extent = Extent::Box}, std::nullopt);
        technique::SetupContext context = setupContext();
        source.setup(context);
        source.render(profiler());
        EXPECT_EQ(source.grid()->layout.shape(), GridShape({45, 45, 15}));
        const DenseGrid torus = source.grid()->read();
        EXPECT_EQ(torus.countFull(), countVoxels(torus));
        // A voxel to spare, and the surface beside it.
        std::array<std::size_t, 2> first{};
        forEachVoxel(GridShape({45, 45, 2}), [&](const glm::ivec3& voxel) {
            if (torus.isFull(voxel)) ++first[static_cast<std::size_t>(voxel.z)];
        });
        EXPECT_EQ(first[0], 0U);
        EXPECT_GT(first[1], 50U);
    }
}

TEST_F(GridShapeTest, CombinedVoxelByVoxel) {
    for (const GridShape& shape : kOddShapes) {
        for (const int bits : kWidths) {
            const WorksheetLayout layout(shape, bits);
            Random random(5);
            DenseGrid a(layout), b(layout);
            forEachVoxel(shape, [&](const glm::ivec3& voxel) {
                if (random.index(3) == 0) a.set(voxel, 1);
                if (random.index(3) == 0) b.set(voxel, 1);
            });
            const gl::Texture left = uploaded(a), right = uploaded(b), result = makeSheets(layout);
            for (const CsgOperation operation :
                 {CsgOperation::Union, CsgOperation::Intersection, CsgOperation::Difference}) {
                CsgPass(shaders(), layout, operation).run(left, right, result);
                const DenseGrid grid(layout, readSheets(result));
                int wrong = 0;
                forEachVoxel(shape, [&](const glm::ivec3& voxel) {
                    const bool inA = a.isFull(voxel), inB = b.isFull(voxel);
                    const bool expected = operation == CsgOperation::Union          ? inA || inB
                                          : operation == CsgOperation::Intersection ? inA && inB
                                                                                    : inA && !inB;
                    if (grid.isFull(voxel) != expected) ++wrong;
                });
                EXPECT_EQ(wrong, 0) << shape.text() << bits;
                CountPass count(shaders(), layout);
                count.run(result);
                EXPECT_EQ(count.read(), countVoxels(grid)) << shape.text() << bits;
            }
        }
    }
}

TEST(GridShape, FitsWhatItHolds) {
    GridSettings settings{.layout = WorksheetLayout(300, 1)};
    const scene::Box flat{{0.0F, 5.0F, -1.0F}, {526.0F, 22.0F, 328.0F}};
    settings.fitTo(flat, 1);
    EXPECT_EQ(settings.layout.shape(), GridShape(300));
    settings.extent = Extent::Box;
    settings.fitTo(flat, 1);
    // A voxel of 526 / 298 m; 9.6 and 186.4 of them, and two to spare.
    EXPECT_EQ(settings.layout.shape(), GridShape({300, 12, 189}));
    EXPECT_EQ(settings.layout.shape().text(), "300 × 12 × 189");
    const scene::Box box = gridBox(flat, settings.layout.shape(), 1);
    const float edge = 526.0F / 298.0F;
    EXPECT_NEAR(voxelSizeOf(box, settings.layout.shape()), edge, 1e-5F);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(box.size()[axis], edge * static_cast<float>(settings.layout.shape().size[axis]),
                    1e-3F);
        EXPECT_LE(box.min[axis], flat.min[axis] - 0.99F * edge);
        EXPECT_GE(box.max[axis], flat.max[axis] + 0.99F * edge);
    }
    // A line takes a voxel across.
    settings.layout = WorksheetLayout(20, 1);
    settings.fitTo({glm::vec3(0.0F), glm::vec3(0.0F, 0.0F, 3.0F)}, 0);
    EXPECT_EQ(settings.layout.shape(), GridShape({1, 1, 20}));
    EXPECT_EQ(GridShape(20).text(), "20³");
}

}  // namespace
}  // namespace gfxrepro::voxelization
