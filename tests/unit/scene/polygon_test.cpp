#include "engine/scene/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/random.h"

namespace gfxrepro::scene {
namespace {

using Corners = std::vector<glm::vec3>;

/// Of all triangles together; those that overlap count twice.
double filledArea(PolygonFiller& filler, const Corners& corners) {
    double area = 0.0;
    for (const glm::uvec3& t : filler.fill(corners)) {
        const glm::dvec3 a(corners[t.x]);
        area += 0.5 *
                glm::length(glm::cross(glm::dvec3(corners[t.y]) - a, glm::dvec3(corners[t.z]) - a));
    }
    return area;
}

/// From each corner on, in both directions, and with each axis upwards.
void expectArea(const Corners& corners, double area) {
    for (std::size_t first = 0; first < corners.size(); ++first) {
        for (const bool isTurned : {false, true}) {
            for (int axis = 0; axis < 3; ++axis) {
                Corners variant;
                for (const glm::vec3& c : corners) {
                    variant.push_back({c[axis], c[(axis + 1) % 3], c[(axis + 2) % 3]});
                }
                std::rotate(variant.begin(), variant.begin() + static_cast<long>(first),
                            variant.end());
                if (isTurned) std::reverse(variant.begin(), variant.end());
                PolygonFiller filler;
                EXPECT_NEAR(filledArea(filler, variant), area, 1e-5 * area)
                    << first << ' ' << isTurned << ' ' << axis;
                EXPECT_EQ(filler.fill(variant).size(), corners.size() - 2);
                EXPECT_EQ(filler.overlappingCount(), 0U);
            }
        }
    }
}

TEST(PolygonFiller, FillsConcavePolygons) {
    expectArea({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3.0);
    expectArea({{2, 0, 0}, {1, 0.5F, 0}, {0, 0, 0}, {1, 2, 0}}, 1.5);
    // Its inner corner, and then each corner, several times.
    expectArea({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3.0);
    Corners often;
    for (const glm::vec3& corner :
         Corners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}) {
        often.insert(often.end(), 3, corner);
    }
    expectArea(often, 3.0);
    // Corners on a straight edge.
    expectArea({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}}, 3.0);
}

TEST(PolygonFiller, LeavesAFanWhereItFills) {
    PolygonFiller filler;
    const std::vector<glm::uvec3> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    const Corners convex{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    EXPECT_TRUE(std::ranges::equal(filler.fill(convex), fan));
    const Corners dent{{1, 1, 0}, {0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};  // all from (1, 1)
    EXPECT_TRUE(std::ranges::equal(filler.fill(dent), fan));
}

/// A hole is written as two edges on each other that join it to the border.
TEST(PolygonFiller, LeavesAHoleThatIsJoinedToTheBorder) {
    const Corners ring{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                       {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    PolygonFiller filler;
    EXPECT_NEAR(filledArea(filler, ring), 12.0, 1e-9);
    EXPECT_EQ(filler.overlappingCount(), 0U);
}

TEST(PolygonFiller, CountsWhatCrossesItself) {
    PolygonFiller filler;
    filler.fill(Corners{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(filler.overlappingCount(), 1U);
    filler.fill(Corners{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, -1, 0}, {0, 4, 0}});
    EXPECT_EQ(filler.overlappingCount(), 2U);
    filler.fill(Corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    EXPECT_EQ(filler.overlappingCount(), 2U);
}

/// Stars about the origin, with as many reflex corners as others, in any plane.
TEST(PolygonFiller, FillsRandomPolygons) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        const int count = 4 + static_cast<int>(random.index(60));
        const glm::vec3 u = glm::normalize(
            glm::vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const glm::vec3 v = glm::normalize(glm::cross(u, glm::vec3(0.3F, 0.5F, 0.8F)));
        Corners corners;
        double area = 0.0;
        double before = 0.0, first = 0.0;
        const double step = 2.0 * 3.14159265358979 / count;
        for (int i = 0; i < count; ++i) {
            const double radius{random.uniform(0.2F, 3.0F)};
            const double angle = step * i;
            corners.push_back(static_cast<float>(radius * std::cos(angle)) * u +
                              static_cast<float>(radius * std::sin(angle)) * v);
            if (i == 0) first = radius;
            area += 0.5 * std::sin(step) * radius * before;
            before = radius;
        }
        area += 0.5 * std::sin(step) * before * first;
        PolygonFiller filler;
        EXPECT_NEAR(filledArea(filler, corners), area, 1e-4 * area) << round;
        EXPECT_EQ(filler.overlappingCount(), 0U) << round;
    }
}

/// A spiral has two ears; a comb of teeth too many is a fan, and counted.
TEST(PolygonFiller, FillsLongPolygonsUpToItsLimit) {
    Corners spiral;
    const auto at = [](double turns, double radius) {
        return glm::vec3(radius * std::cos(6.2831853 * turns), radius * std::sin(6.2831853 * turns),
                         0.0);
    };
    for (int i = 0; i < 2000; ++i) spiral.push_back(at(i / 100.0, 10.0 + i / 100.0));
    for (int i = 1999; i >= 0; --i) spiral.push_back(at(i / 100.0, 9.6 + i / 100.0));
    PolygonFiller filler;
    filler.fill(spiral);
    EXPECT_EQ(filler.overlappingCount(), 0U);

    Corners comb{{0, -1, 0}};
    for (int i = 0; i < 5000; ++i) comb.emplace_back(i, i % 2, 0);
    std::reverse(comb.begin() + 1, comb.end());
    EXPECT_EQ(filler.fill(comb).size(), comb.size() - 2);
    EXPECT_EQ(filler.overlappingCount(), 1U);
}

}  // namespace
}  // namespace gfxrepro::scene
