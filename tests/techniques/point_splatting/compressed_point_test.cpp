#include "techniques/point_splatting/compressed_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/techniques/point_splatting/point_clouds.h"

namespace gfxrepro::point_splatting {
namespace {

const scene::Box kBox{{-1.0F, 2.0F, 10.0F}, {3.0F, 2.5F, 11.0F}};

TEST(CompressedPoint, ErrorsStayWithinTheGridsBounds) {
    Random random(3);
    const std::vector<float> table{0.1F, 0.2F, 0.5F};
    const glm::vec3 bound = positionErrorBound(kBox);
    glm::vec3 worst(0.0F);
    float worstAngle = 0.0F;
    for (int trial = 0; trial < 20000; ++trial) {
        const glm::vec3 share{random.uniform(), random.uniform(), random.uniform()};
        const glm::vec3 position = kBox.min + share * kBox.size(), normal = randomUnit(random);
        const DecodedPoint point =
            decoded(compressed(position, normal, 0.19F, kBox, table), kBox, table);
        worst = glm::max(worst, glm::abs(point.position - position));
        worstAngle =
            std::max(worstAngle, std::acos(std::min(glm::dot(point.normal, normal), 1.0F)));
        EXPECT_EQ(point.radius, 0.2F);
        EXPECT_NEAR(glm::dot(point.tangent, point.normal), 0.0F, 1e-6F);
        EXPECT_NEAR(glm::length(point.tangent), 1.0F, 1e-6F);
        EXPECT_NEAR(glm::length(point.bitangent), 1.0F, 1e-6F);
    }
    for (int axis = 0; axis < 3; ++axis) {  // and the bounds are no looser than they must be
        EXPECT_LE(worst[axis], bound[axis] * 1.01F);
        EXPECT_GE(worst[axis], bound[axis] * 0.95F);
    }
    EXPECT_LE(worstAngle, normalErrorBoundRad() * 1.01F);
    EXPECT_GE(worstAngle, normalErrorBoundRad() * 0.9F);
}

TEST(CompressedPoint, TangentsLeaveThePlaneNoMoreThanTheirNormalsDo) {
    // Which two vectors span a disc is free; that they span it is what quantization takes away.
    Random random(8);
    const std::vector<float> table{1.0F};
    double worst = 0.0;
    for (int trial = 0; trial < 20000; ++trial) {
        const glm::vec3 normal = randomUnit(random);
        const DecodedPoint point =
            decoded(compressed(kBox.min, normal, 1.0F, kBox, table), kBox, table);
        for (const glm::vec3& along : {point.tangent, point.bitangent}) {
            const double sine = glm::dot(glm::dvec3(along), glm::dvec3(normal));
            worst = std::max(worst, std::asin(std::abs(sine)));
        }
    }
    EXPECT_LE(worst, static_cast<double>(normalErrorBoundRad()) * 1.01);
    EXPECT_GE(worst, static_cast<double>(normalErrorBoundRad()) * 0.7);
}

TEST(CompressedPoint, RadiiAreHalfAGapOfTheTableOffAtTheMost) {
    Random random(5);
    std::vector<float> radii(5000);
    for (float& radius : radii) radius = std::exp(random.uniform(-3.0F, 1.0F));
    const std::vector<float> table = clusteredRadii(radii);
    float worst = 0.0F;
    for (const float radius : radii) {
        const float found =
            decoded(compressed(kBox.min, {0, 1, 0}, radius, kBox, table), kBox, table).radius;
        const auto above = std::upper_bound(table.begin(), table.end(), radius);
        // Radii beyond the table's ends belong to the end's cluster, whose middle the entry is.
        const float bound = above == table.begin() || above == table.end()
                                ? 0.05F * radius
                                : 0.5F * (*above - *std::prev(above));
        EXPECT_LE(std::abs(found - radius), bound * 1.0001F);
        worst = std::max(worst, std::abs(found - radius) / bound);
    }
    EXPECT_GT(worst, 0.95F);
}

/// Each bit turned on its own changes what it is counted for, and nothing else but what follows.
TEST(CompressedPoint, BitsCarryWhatTheyAreCountedFor) {
    const scene::Box box{{0, 0, 0}, {1, 1, 1}};
    std::vector<float> radii(256);
    for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = static_cast<float>(i + 1);
    const CompressedPoint point =
        compressed({0.3F, 0.6F, 0.8F}, {0.48F, 0.6F, 0.64F}, 77, box, radii);
    const DecodedPoint before = decoded(point, box, radii);
    int position = 0, normal = 0, tangent = 0, radius = 0, none = 0;
    for (int bit = 0; bit < 64; ++bit) {
        CompressedPoint turned = point;
        (bit < 32 ? turned.position : turned.surface) ^= 1U << (bit % 32);
        const DecodedPoint after = decoded(turned, box, radii);
        if (after.position != before.position) ++position;
        if (after.normal != before.normal) {
            ++normal;
        } else if (after.tangent != before.tangent) {
            ++tangent;
        }
        if (after.radius != before.radius) ++radius;
        none += after.position == before.position && after.normal == before.normal &&
                after.tangent == before.tangent && after.radius == before.radius;
    }
    EXPECT_EQ(position, bitsOf(layout::kPosition));
    EXPECT_EQ(normal, layout::kTheta.bits + layout::kPhi.bits);
    EXPECT_EQ(tangent, layout::kTangent.bits);
    EXPECT_EQ(radius, layout::kRadius.bits);
    EXPECT_EQ(none, 6);
}

TEST(CompressedPoint, CornersOfTheBoxAndPolesSurvive) {
    const std::vector<float> table{1.0F};
    for (const glm::vec3& corner : {kBox.min, kBox.max}) {
        for (const glm::vec3& normal :
             {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0),
              glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
            const DecodedPoint point =
                decoded(compressed(corner, normal, 1.0F, kBox, table), kBox, table);
            EXPECT_LE(glm::distance(point.position, corner),
                      glm::length(positionErrorBound(kBox)) * 1.01F);
            EXPECT_GT(glm::dot(point.normal, normal), std::cos(normalErrorBoundRad() * 1.01F));
        }
    }
}

TEST(CompressedPoint, ABoxOfNoSizeKeepsItsPoint) {
    const scene::Box box{{1, 2, 3}, {1, 2, 3}};
    const std::vector<float> table{1.0F};
    EXPECT_EQ(decoded(compressed({1, 2, 3}, {0, 1, 0}, 1.0F, box, table), box, table).position,
              glm::vec3(1, 2, 3));
}

TEST(RadiusTable, FewRadiiAreAllKept) {
    const std::vector<float> radii{0.5F, 0.25F, 0.5F, 1.0F};
    EXPECT_EQ(clusteredRadii(radii), (std::vector<float>{0.25F, 0.5F, 1.0F}));
}

TEST(RadiusTable, ClustersManyRadiiBetterThanEqualSteps) {
    Random random(9);
    std::vector<float> radii(20000);
    for (float& radius : radii) {
        const float exponent = random.uniform(-4.0F, 1.0F);
        radius = std::exp(exponent * random.uniform());
    }
    const std::vector<float> table = clusteredRadii(radii);
    ASSERT_EQ(table.size(), 256U);
    EXPECT_TRUE(std::is_sorted(table.begin(), table.end()));
    const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
    double clustered = 0.0, even = 0.0;
    for (const float radius : radii) {
        clustered += std::abs(std::log(table[nearestRadius(table, radius)] / radius));
        const float step = (*high - *low) / 255.0F;
        const float nearest = *low + std::round((radius - *low) / step) * step;
        even += std::abs(std::log(nearest / radius));
    }
    EXPECT_LT(clustered, 0.7 * even);
    EXPECT_LT(clustered / 20000, 0.01);  // one per cent of a radius on average
}

TEST(RadiusTable, FindsTheNearestAsALinearSearchDoes) {
    Random random(4);
    std::vector<float> table(256);
    for (float& radius : table) radius = random.uniform();
    std::sort(table.begin(), table.end());
    for (int trial = 0; trial < 2000; ++trial) {
        const float radius = random.uniform(-0.1F, 1.1F);
        float best = std::numeric_limits<float>::max();
        for (const float entry : table) best = std::min(best, std::abs(entry - radius));
        EXPECT_EQ(std::abs(table[nearestRadius(table, radius)] - radius), best);
    }
}

}  // namespace
}  // namespace gfxrepro::point_splatting
