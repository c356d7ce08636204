#include "techniques/point_splatting/patch_selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "runner/core/random.h"
#include "techniques/point_splatting/splat_math.h"

namespace gfxrepro::point_splatting {
namespace {

PointModel sphereModel(int count) {
    scene::PointCloud points;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / count, angle = 2.399963229728653 * i;
        const double r = std::sqrt(1.0 - z * z);
        points.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    points.normals = points.positions;
    points.radii.assign(points.positions.size(), static_cast<float>(1.5 * std::sqrt(4.0 / count)));
    return buildModel(points, {});
}

scene::Camera cameraAt(const glm::vec3& position, const glm::vec3& target) {
    scene::Camera camera;
    camera.position = position;
    camera.target = target;
    camera.nearM = 0.05F;
    camera.farM = 100.0F;
    return camera;
}

/// Whether the point faces the eye and its disc's centre is inside of the frustum.
bool isSeen(const PointModel& model, std::uint32_t point, const PatchView& view) {
    const glm::vec3& p = model.positions[point];
    if (glm::dot(model.normals[point], view.eyeModel - p) <= 0.0F) return false;
    const glm::vec4 clip = view.clipFromView * view.viewFromModel * glm::vec4(p, 1.0F);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && std::abs(clip.z) <= clip.w;
}

TEST(PatchSelection, CullsNothingThatIsSeen) {
    const PointModel model = sphereModel(30000);
    Random random(6);
    std::vector<DrawnPatch> drawn;
    std::uint32_t outside = 0, turnedAway = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const auto coordinate = [&] { return random.uniform(-3.0F, 3.0F); };
        const PatchView view =
            patchViewOf(cameraAt({coordinate(), coordinate(), coordinate()},
                                 {coordinate() / 3, coordinate() / 3, coordinate() / 3}),
                        {320, 200});
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
    SelectionSettings settings;
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
            if (item.level + 1 == patch.levelCount) continue;
            float nearest = 1e9F;
            for (std::uint32_t i = 0; i < patch.pointCount; ++i) {
                nearest = std::min(nearest, distance - model.positions[patch.firstPoint + i].z);
            }
            const Level& level = model.levels[patch.firstLevel + item.level];
            EXPECT_LE(level.maxRadius * view.focalPx / nearest, settings.targetRadiusPx * 1.001F);
        }
    }
    EXPECT_LT(former, 60.0);  // of some 450
    settings.choosesLevels = settings.cullsCones = settings.cullsFrustum = false;
    const PatchView view = patchViewOf(cameraAt({0, 0, 24}, {0, 0, 0}), {512, 512});
    EXPECT_EQ(selectPatches(model.patches, model.levels, view, settings, drawn).points, 30000U);
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
    std::vector<DrawnPatch> drawn;
    const PatchView view = patchViewOf(cameraAt({0, 0, 2}, {0, 0, 0}), {2048, 2048});
    selectPatches(model.patches, model.levels, view, settings, drawn);
    int atSilhouette = 0, within = 0;
    for (const DrawnPatch& item : drawn) {
        const Patch& patch = model.patches[item.patch];
        bool towards = false, away = false;
        for (std::uint32_t i = patch.firstPoint; i < patch.firstPoint + patch.pointCount; ++i) {
            const float side = glm::dot(model.normals[i], view.eyeModel - model.positions[i]);
            (side > 0.0F ? towards : away) = true;
        }
        if (towards && away) {
            ++atSilhouette;
            EXPECT_EQ(item.mode, SplatMode::FullEwa);
        }
        within += item.mode == SplatMode::Reconstruction;  // large splats in the middle
    }
    EXPECT_GT(atSilhouette, 5);
    EXPECT_GE(within, 5);
}

}  // namespace
}  // namespace gfxrepro::point_splatting
