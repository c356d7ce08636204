#include "techniques/reflection_reuse/reflection_reuse.h"

#include <gtest/gtest.h>

#include <vector>

namespace gfxrepro::reflection_reuse {
namespace {

TEST(LinearFitTest, FindsALine) {
    const std::vector<glm::dvec2> points = {{0, 7}, {10, 12}, {1e6, 7 + 5e5}};
    const auto fit = linearFit(points);
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(fit->slope, 0.5, 1e-12);
    EXPECT_NEAR(fit->intercept, 7.0, 1e-6);
    EXPECT_NEAR(fit->rSquared, 1.0, 1e-12);
}

TEST(LinearFitTest, KnowsHowMuchIsExplained) {
    // Anscombe 1973, first set: y = 3.00 + 0.500 x, R² = 0.667.
    const std::vector<glm::dvec2> points = {{10, 8.04},  {8, 6.95},  {13, 7.58}, {9, 8.81},
                                            {11, 8.33},  {14, 9.96}, {6, 7.24},  {4, 4.26},
                                            {12, 10.84}, {7, 4.82},  {5, 5.68}};
    const auto fit = linearFit(points);
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(fit->slope, 0.500, 5e-4);
    EXPECT_NEAR(fit->intercept, 3.00, 5e-3);
    EXPECT_NEAR(fit->rSquared, 0.667, 5e-4);
    // Neither rising nor falling.
    const auto flat = linearFit(std::vector<glm::dvec2>{{0, 1}, {1, 2}, {2, 1}});
    ASSERT_TRUE(flat.has_value());
    EXPECT_NEAR(flat->slope, 0.0, 1e-12);
    EXPECT_NEAR(flat->rSquared, 0.0, 1e-12);
}

TEST(LinearFitTest, FallsAsWellAsItRises) {
    const auto fit = linearFit(std::vector<glm::dvec2>{{0, 4}, {1, 2}, {2, 0}});
    ASSERT_TRUE(fit.has_value());
    EXPECT_DOUBLE_EQ(fit->slope, -2.0);
    EXPECT_DOUBLE_EQ(fit->rSquared, 1.0);
}

TEST(LinearFitTest, SaysNothingOfTooFewPointsAndOfConstants) {
    EXPECT_FALSE(linearFit({}).has_value());
    EXPECT_FALSE(linearFit(std::vector<glm::dvec2>{{1, 1}, {2, 2}}).has_value());
    EXPECT_FALSE(linearFit(std::vector<glm::dvec2>{{1, 1}, {1, 2}, {1, 3}}).has_value());
    EXPECT_FALSE(linearFit(std::vector<glm::dvec2>{{1, 5}, {2, 5}, {3, 5}}).has_value());
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
