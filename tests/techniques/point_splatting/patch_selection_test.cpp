#include "techniques/point_splatting/patch_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <sstream>
#include <string>

#include "engine/core/files.h"
#include "tests/techniques/point_splatting/point_clouds.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr double kSilhouetteDeg = 15.0;

PointModel sphereModel(int count) {
    return buildModel(sphere(count), {});
}

scene::Camera cameraAt(const glm::vec3& position, const glm::vec3& target) {
    return scene::Camera{.position = position, .target = target, .nearM = 0.05F, .farM = 100.0F};
}

/// Of the nearest of the box's eight corners.
float nearestCorner(const scene::Box& box, const glm::vec3& eye) {
    float nearest = std::numeric_limits<float>::max();
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1) != 0 ? box.max.x : box.min.x,
                               (i & 2) != 0 ? box.max.y : box.min.y,
                               (i & 4) != 0 ? box.max.z : box.min.z);
        nearest = std::min(nearest, glm::distance(corner, eye));
    }
    return nearest;
}

/// Between the view ray to the middle of the patch and its mean normal, 0 … 90°.
double angleToNormalDeg(const Patch& patch, const glm::vec3& eye) {
    const glm::dvec3 ray = glm::normalize(glm::dvec3(patch.bounds.centre() - eye));
    const double angle = std::acos(std::abs(glm::dot(ray, glm::dvec3(patch.meanNormal))));
    return glm::degrees(angle);
}

/// Whether the point faces the eye and its disc's centre is inside of the frustum.
bool isSeen(const PointModel& model, std::uint32_t point, const PatchView& view) {
    const glm::vec3& p = model.positions[point];
    if (glm::dot(model.normals[point], view.eyeWorld - p) <= 0.0F) return false;
    const glm::vec4 clip = view.clipFromWorld() * glm::vec4(p, 1.0F);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && std::abs(clip.z) <= clip.w;
}

TEST(PatchSelection, CullsNothingThatIsSeen) {
    const PointModel model = sphereModel(30000);
    Random random(6);
    std::vector<DrawnPatch> drawn;
    std::uint32_t outside = 0, turnedAway = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const auto coordinate = [&] { return random.uniform(-3.0F, 3.0F); };
        const glm::vec3 eye{coordinate(), coordinate(), coordinate()};
        const glm::vec3 target{coordinate() / 3, coordinate() / 3, coordinate() / 3};
        const PatchView view = patchViewOf(cameraAt(eye, target), {320, 200});
        const SelectionCounts counts = selectPatches(model.patches, model.levels, view, {}, drawn);
        outside += counts.outside;
        turnedAway += counts.turnedAway;
        std::vector<bool> isDrawn(model.patches.size());
        for (const DrawnPatch& item : drawn) isDrawn[item.patch] = true;
        for (std::size_t p = 0; p < model.patches.size(); ++p) {
            if (isDrawn[p]) continue;
            const Patch& patch = model.patches[p];
            for (std::uint32_t i = 0; i < patch.pointCount; ++i) {
                EXPECT_FALSE(isSeen(model, patch.firstPoint + i, view)) << "trial " << trial;
            }
        }
    }
    EXPECT_GT(outside, 0U);
    EXPECT_GT(turnedAway, 0U);
}

TEST(PatchSelection, LevelsProjectSmallEnoughAndNoFinerThanNeeded) {
    const PointModel model = sphereModel(30000);
    std::vector<DrawnPatch> drawn;
    SelectionSettings settings{.silhouetteRad = static_cast<float>(glm::radians(kSilhouetteDeg))};
    int fine = 0, coarse = 0;
    double former = 1e9;  // points a patch
    for (const float distance : {3.0F, 6.0F, 12.0F, 24.0F, 48.0F}) {
        const PatchView view = patchViewOf(cameraAt({0, 0, distance}, {0, 0, 0}), {512, 512});
        const SelectionCounts counts =
            selectPatches(model.patches, model.levels, view, settings, drawn);
        // Farther: coarser. (Of all points it does not hold: a near eye sees fewer patches.)
        const double pointsAPatch = static_cast<double>(counts.points) / counts.drawn;
        EXPECT_LE(pointsAPatch, former) << distance;
        former = pointsAPatch;
        for (const DrawnPatch& item : drawn) {
            const Patch& patch = model.patches[item.patch];
            const bool isFine = angleToNormalDeg(patch, view.eyeWorld) < 90.0 - kSilhouetteDeg
                                    ? patch.curvature > settings.curvedAbove ||
                                          patch.coneRad > settings.wideAboveRad
                                    : true;
            (isFine ? fine : coarse) += 1;
            const float target = isFine ? settings.fineRadiusPx : settings.targetRadiusPx;
            const auto radiusPx = [&](std::uint32_t level) {
                return model.levels[patch.firstLevel + level].maxRadius * view.focalPx /
                       nearestCorner(patch.bounds, view.eyeWorld);
            };
            if (item.level + 1 < patch.levelCount) {
                EXPECT_LE(radiusPx(item.level), target * 1.001F);
            }
            if (item.level > 0) {
                EXPECT_GT(radiusPx(item.level - 1), target * 0.999F);
            }
        }
    }
    EXPECT_GT(fine, 50);
    EXPECT_GT(coarse, 50);
    EXPECT_LT(former, 100.0);  // of some 450
    settings.choosesLevels = settings.cullsCones = settings.cullsFrustum = false;
    const PatchView view = patchViewOf(cameraAt({0, 0, 24}, {0, 0, 0}), {512, 512});
    EXPECT_EQ(selectPatches(model.patches, model.levels, view, settings, drawn).points, 30000U);
}

/// The defaults are what configs/calibration/points.yaml came to.
TEST(PatchSelection, DefaultsAreWhatWasFitted) {
    std::istringstream csv(
        readFile(std::filesystem::path(GFXREPRO_SOURCE_DIR) / "results/calibration/points.csv"));
    std::string names, values;
    std::getline(csv, names);
    std::getline(csv, values);
    EXPECT_TRUE(names.starts_with("patch_points_min,target_radius_px,fine_radius_px,")) << names;
    std::istringstream row(values);
    float minPoints = 0.0F, target = 0.0F, fine = 0.0F;
    char comma = ' ';
    row >> minPoints >> comma >> target >> comma >> fine;
    EXPECT_EQ(static_cast<float>(TreeSettings{}.minPatchPoints), minPoints);
    EXPECT_EQ(SelectionSettings{}.targetRadiusPx, target);
    EXPECT_EQ(SelectionSettings{}.fineRadiusPx, fine);
}

TEST(PatchSelection, ModesFollowTheProjectedArea) {
    const SelectionSettings settings;
    const auto eta = static_cast<float>(cEta(glm::half_pi<double>()));
    EXPECT_NEAR(eta, std::sqrt(3.0F), 1e-6F);
    EXPECT_EQ(modeFor(3.01F, eta, settings), SplatMode::Reconstruction);
    EXPECT_EQ(modeFor(2.99F, eta, settings), SplatMode::FullEwa);
    EXPECT_EQ(modeFor(0.3F / eta * 1.01F, eta, settings), SplatMode::FullEwa);
    EXPECT_EQ(modeFor(0.3F / eta * 0.99F, eta, settings), SplatMode::LowPass);
}

TEST(PatchSelection, SilhouettesAreFullEwa) {
    const PointModel model = sphereModel(30000);
    SelectionSettings settings;
    settings.choosesLevels = false;
    settings.silhouetteRad = static_cast<float>(glm::radians(kSilhouetteDeg));
    std::vector<DrawnPatch> drawn;
    // Splats of some pixels near, and of a part of one far away.
    for (const auto& [distance, mode] :
         {std::pair(2.0F, SplatMode::Reconstruction), std::pair(60.0F, SplatMode::LowPass)}) {
        const PatchView view = patchViewOf(cameraAt({0, 0, distance}, {0, 0, 0}), {1024, 1024});
        selectPatches(model.patches, model.levels, view, settings, drawn);
        int atSilhouette = 0, within = 0;
        for (const DrawnPatch& item : drawn) {
            const double angle = angleToNormalDeg(model.patches[item.patch], view.eyeWorld);
            if (angle > 90.0 - kSilhouetteDeg) {
                ++atSilhouette;
                EXPECT_EQ(item.mode, SplatMode::FullEwa);
            } else if (angle < 60.0) {
                ++within;
                EXPECT_EQ(item.mode, mode);
            }
        }
        EXPECT_GT(atSilhouette, 5);
        EXPECT_GT(within, 5);
    }
}

}  // namespace
}  // namespace gfxrepro::point_splatting
