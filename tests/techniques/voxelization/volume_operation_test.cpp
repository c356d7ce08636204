// Boolean operations and collision on worksheets, against spheres' formulas and bit by bit.

#include <cmath>
#include <numbers>

#include "engine/core/random.h"
#include "techniques/voxelization/combination.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

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
