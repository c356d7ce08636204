// Implicit and parametric surfaces against the formulas themselves.

#include <cmath>

#include "techniques/voxelization/formula_surface.h"
#include "tests/techniques/voxelization/voxel_value.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

constexpr const char* kTorusFormula = "(sqrt(x^2 + y^2) - 1)^2 + z^2 - 0.16";

Params surfaceParams(const std::string& yaml) {
    return Params(parseYaml(yaml, "test.yaml"), "test");
}

scene::Box cube(float half) {
    return {glm::vec3(-half), glm::vec3(half)};
}

glm::dvec3 centreOf(const VoxelGrid& grid, const glm::ivec3& voxel) {
    const auto size = static_cast<double>(grid.voxelSize());
    return glm::dvec3(grid.box.min) + (glm::dvec3(voxel) + 0.5) * size;
}

constexpr glm::ivec3 kFaceNeighbours[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                          {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

struct SurfaceTest : GlTest {
    template <class Source>
    Source sourceOf(const std::string& yaml, const GridSettings& settings,
                    const std::optional<scene::Box>& box) {
        Params params = surfaceParams(yaml);
        Source source(params, settings, box);
        params.finish();
        technique::SetupContext context = setupContext();
        source.setup(context);
        source.render(profiler());
        return source;
    }
    ImplicitSource implicitOf(const std::string& yaml, const GridSettings& settings,
                              const std::optional<scene::Box>& box = std::nullopt) {
        return sourceOf<ImplicitSource>(yaml, settings, box);
    }
    ParametricSource parametricOf(const std::string& yaml, const GridSettings& settings,
                                  const std::optional<scene::Box>& box = std::nullopt) {
        return sourceOf<ParametricSource>(yaml, settings, box);
    }
};

class ImplicitLayouts : public SurfaceTest, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(VoxelBits, ImplicitLayouts, testing::Values(1, 8, 16, 32));

TEST_P(ImplicitLayouts, SolidIsTheSignOfTheFormulaAtEachCentre) {
    const GridSettings settings{WorksheetLayout(64, GetParam()), VoxelValue::Occupancy,
                                Fill::Solid};
    const ImplicitSource source = implicitOf("{}", settings);
    const DenseGrid grid = source.grid()->read();
    HostFormula formula(source.formula().formula());
    int wrong = 0;
    forEachVoxel(64, [&](const glm::ivec3& voxel) {
        const double f = formula(centreOf(*source.grid(), voxel));
        // Nearer to 0 the sign in floats is a matter of rounding.
        if (std::abs(f) > 1e-4 && grid.isFull(voxel) != (f < 0)) ++wrong;
    });
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(grid.countFull(), 5000U);
}

TEST_P(ImplicitLayouts, SurfaceSeparatesInsideFromOutside) {
    const GridSettings settings{WorksheetLayout(64, GetParam())};
    const ImplicitSource source = implicitOf("{}", settings);
    const DenseGrid grid = source.grid()->read();
    const DenseGrid outside = outsideOf(grid);
    HostFormula formula(source.formula().formula());
    int leaks = 0;
    int insideVoxels = 0;
    forEachVoxel(64, [&](const glm::ivec3& voxel) {
        const double f = formula(centreOf(*source.grid(), voxel));
        if (f < -1e-4) ++insideVoxels;
        if (f < -1e-4 && outside.isFull(voxel)) ++leaks;
    });
    EXPECT_EQ(leaks, 0);
    EXPECT_GT(insideVoxels, 5000);
}

TEST_F(SurfaceTest, SurfaceVoxelsAreThoseWhoseCrosshairMeetsTheSurface) {
    const GridSettings settings{WorksheetLayout(32, 8)};
    const ImplicitSource source =
        implicitOf("{formula: x^2 + y^2 + z^2 - 1}", settings, cube(1.25F));
    const DenseGrid grid = source.grid()->read();
    const double half = 0.5 * static_cast<double>(source.grid()->voxelSize());
    HostFormula formula(source.formula().formula());
    int wrong = 0;
    forEachVoxel(32, [&](const glm::ivec3& voxel) {
        const glm::dvec3 centre = centreOf(*source.grid(), voxel);
        double lowest = formula(centre);
        double highest = lowest;
        for (const glm::ivec3& step : kFaceNeighbours) {
            const double f = formula(centre + half * glm::dvec3(step));
            lowest = std::min(lowest, f);
            highest = std::max(highest, f);
        }
        const bool isNear = std::min(std::abs(lowest), std::abs(highest)) < 1e-5;
        if (!isNear && grid.isFull(voxel) != (lowest < 0 && highest > 0)) ++wrong;
    });
    EXPECT_EQ(wrong, 0);
}

TEST_F(SurfaceTest, SurfaceThroughVoxelCentresIsKept) {
    // The plane passes through the centres of layer 16 of 32.
    const ImplicitSource source =
        implicitOf("{formula: z - 0.5}", {WorksheetLayout(32, 1)}, cube(16.0F));
    const DenseGrid grid = source.grid()->read();
    EXPECT_EQ(grid.countFull(), 32U * 32U);
    EXPECT_TRUE(grid.isFull({5, 7, 16}));
}

TEST_F(SurfaceTest, NormalsPointOutOfASphere) {
    const GridSettings settings{WorksheetLayout(64, 16), VoxelValue::Normal};
    const ImplicitSource source =
        implicitOf("{formula: x^2 + y^2 + z^2 - 1}", settings, cube(1.25F));
    const DenseGrid grid = source.grid()->read();
    forEachVoxel(64, [&](const glm::ivec3& voxel) {
        if (!grid.isFull(voxel)) return;
        const glm::vec3 normal = decodeNormal(grid.value(voxel), 16);
        const glm::vec3 outwards(glm::normalize(centreOf(*source.grid(), voxel)));
        EXPECT_GT(glm::dot(normal, outwards), 0.9998F);
    });
}

TEST_F(SurfaceTest, SamplesThatAreNotANumberAreNoSurface) {
    const ImplicitSource source =
        implicitOf("{formula: (x - x)/(x - x)}", {WorksheetLayout(32, 8)}, cube(1.0F));
    EXPECT_EQ(source.grid()->read().countFull(), 0U);
}

/// Is there a full voxel of `grid` within one voxel (26 neighbours) of `voxel`?
bool isBeside(const DenseGrid& grid, const glm::ivec3& voxel) {
    for (int i = 0; i < 27; ++i) {
        const glm::ivec3 next = voxel + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        if (grid.shape().has(next) && grid.isFull(next)) return true;
    }
    return false;
}

TEST_F(SurfaceTest, ParametricTorusLiesOnTheImplicitOne) {
    const GridSettings settings{WorksheetLayout(64, 1)};
    const DenseGrid parametric =
        parametricOf("{samples: [700, 400]}", settings, cube(1.5F)).grid()->read();
    const DenseGrid implicit =
        implicitOf(std::string("{formula: ") + kTorusFormula + "}", settings, cube(1.5F))
            .grid()
            ->read();
    int strays = 0;
    int gaps = 0;
    forEachVoxel(64, [&](const glm::ivec3& voxel) {
        if (parametric.isFull(voxel) && !isBeside(implicit, voxel)) ++strays;
        if (implicit.isFull(voxel) && !isBeside(parametric, voxel)) ++gaps;
    });
    EXPECT_EQ(strays, 0);
    EXPECT_EQ(gaps, 0);
    EXPECT_GT(parametric.countFull(), 3000U);
}

TEST_F(SurfaceTest, ParametricVoxelsDoNotDependOnTheLayout) {
    const DenseGrid bits =
        parametricOf("{samples: [300, 200]}", {WorksheetLayout(32, 1)}).grid()->read();
    for (int voxelBits : {8, 16, 32}) {
        for (VoxelValue value : {VoxelValue::Occupancy, VoxelValue::Normal}) {
            const DenseGrid other =
                parametricOf("{samples: [300, 200]}", {WorksheetLayout(32, voxelBits), value})
                    .grid()
                    ->read();
            int differences = 0;
            forEachVoxel(32, [&](const glm::ivec3& voxel) {
                if (bits.isFull(voxel) != other.isFull(voxel)) ++differences;
            });
            EXPECT_EQ(differences, 0) << voxelBits << " bits";
        }
    }
}

TEST_F(SurfaceTest, ParametricNormalsPointOutOfTheTorus) {
    const GridSettings settings{WorksheetLayout(64, 32), VoxelValue::Normal};
    const ParametricSource source = parametricOf("{samples: [700, 400]}", settings);
    const DenseGrid grid = source.grid()->read();
    forEachVoxel(64, [&](const glm::ivec3& voxel) {
        if (!grid.isFull(voxel)) return;
        const glm::dvec3 p = centreOf(*source.grid(), voxel);
        const glm::dvec3 ring(glm::normalize(glm::dvec2(p)), 0.0);
        const glm::vec3 outwards(glm::normalize(p - ring));
        // A voxel is 0.14 of the tube's radius across.
        EXPECT_GT(glm::dot(decodeNormal(grid.value(voxel), 32), outwards), 0.97F);
    });
}

TEST(FiniteBounds, PassesOverWhatIsNoPoint) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec3> points{{0, 0, 0}, {3, 0, 0}, {0, 2.5F, 0}, {nan, 9, 9}, {3, 1, 0}};
    EXPECT_EQ(finiteBounds(points).max, glm::vec3(3, 2.5F, 0));
}

TEST(ParametricSource, RefusesWhatItCannotDo) {
    const auto errorOf = [](const std::string& yaml, const GridSettings& settings) {
        return errorText([&] {
            Params params = surfaceParams(yaml);
            ParametricSource(params, settings, std::nullopt);
        });
    };
    EXPECT_EQ(
        errorOf("{fill: solid}", {WorksheetLayout(32, 1), VoxelValue::Occupancy, Fill::Solid}),
        "test.yaml:1:8: a parametric surface has no inside; allowed with it: surface");
    EXPECT_EQ(errorOf("{samples: [2.5, 4]}", {WorksheetLayout(32, 8)}),
              "test.yaml:1:11: 'samples' must be whole numbers, found 2.5");
}

}  // namespace
}  // namespace gfxrepro::voxelization
