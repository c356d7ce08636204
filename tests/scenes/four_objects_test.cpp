// The claims of [xie2017] Fig. 11–12 about who hides whom, by rays.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "engine/raycast/ray_tracer.h"
#include "engine/scene/generators.h"
#include "scenes/outdoor/outdoor.h"

namespace gfxrepro::raycast {
namespace {

struct FourObjects : testing::Test {
    FourObjects() {
        Params params({}, "generator 'four_objects'");
        scene_ = scene::fourObjects(params, 1);
        tracer_.emplace(scene_);
        // The lower corners of an upright equilateral triangle around the camera.
        const scene::Camera& camera = scene_.cameras.at(0);
        const glm::vec3 forward = glm::normalize(camera.target - camera.position);
        const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
        const glm::vec3 up = glm::cross(right, forward);
        const float sideM = 0.5F * glm::length(scene_.bounds().size());  // the baseline
        middle_ = camera.position - up * (sideM * std::sqrt(3.0F) / 6.0F);
        left_ = middle_ - right * (0.5F * sideM);
        right_ = middle_ + right * (0.5F * sideM);
    }

    /// The names of what is drawn along the ray, nearest first, back faces culled.
    std::string objectsAlong(const glm::vec3& eye, const glm::vec3& direction) const {
        std::string names;
        float after = 0.0F;
        while (const auto hit = tracer_->closestHit(eye, direction, after)) {
            if (glm::dot(hit->geometricNormal, direction) < 0.0F) names += "ABCD"[hit->instance];
            // Boxes are centimetres apart and thick, so that nothing is stepped over; and neither
            // triangle at a diagonal is met twice.
            after = hit->distance + 1e-3F;
        }
        return names;
    }

    /// Points inside of C's faces: all six, or the front alone.
    std::vector<glm::vec3> samplesOfC(bool isFrontOnly) const {
        constexpr int kSamples = 25;
        const scene::Box box = scene_.meshes.at(2).bounds();
        std::vector<glm::vec3> samples;
        for (int axis = isFrontOnly ? 2 : 0; axis < 3; ++axis) {
            for (const float side : {1.0F, 0.0F}) {
                if (isFrontOnly && side == 0.0F) continue;
                for (int i = 0; i < kSamples; ++i) {
                    for (int j = 0; j < kSamples; ++j) {
                        glm::vec3 share(side);
                        share[(axis + 1) % 3] = (static_cast<float>(i) + 0.37F) / kSamples;
                        share[(axis + 2) % 3] = (static_cast<float>(j) + 0.41F) / kSamples;
                        samples.push_back(box.min + box.size() * share);
                    }
                }
            }
        }
        return samples;
    }

    bool isVisible(const glm::vec3& point, const glm::vec3& eye) const {
        const float distance = glm::length(point - eye);
        // Short of the point by 1 mm: it lies on its own surface.
        return !tracer_->isOccluded(eye, point - eye, 0.0F, distance - 1e-3F);
    }

    scene::Scene scene_;
    std::optional<RayTracer> tracer_;
    glm::vec3 left_{0.0F}, right_{0.0F}, middle_{0.0F};  // V₀, V₁ and between them
};

TEST_F(FourObjects, HasFourClosedBoxes) {
    ASSERT_EQ(scene_.meshes.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(scene_.meshes[i].name, std::string(1, "ABCD"[i]));
        EXPECT_EQ(scene_.meshes[i].triangles.size(), 12U);
    }
}

TEST_F(FourObjects, NeitherReferenceViewSeesCButTheMiddleDoes) {
    for (const glm::vec3& point : samplesOfC(false)) {
        EXPECT_FALSE(isVisible(point, left_));
        EXPECT_FALSE(isVisible(point, right_));
    }
    int visible = 0;
    const auto front = samplesOfC(true);
    for (const glm::vec3& point : front) visible += isVisible(point, middle_);
    EXPECT_EQ(visible, static_cast<int>(front.size()));
}

TEST_F(FourObjects, CIsThirdFromTheLeftAndSecondFromTheRight) {
    for (const glm::vec3& point : samplesOfC(true)) {
        EXPECT_EQ(objectsAlong(left_, point - left_), "ABC");
        EXPECT_EQ(objectsAlong(right_, point - right_), "DC");
    }
}

TEST_F(FourObjects, WhatHidesCFromTheRightIsSeenFromTheLeft) {
    // So that a non-redundant image at V₁ looks through it.
    for (const glm::vec3& point : samplesOfC(false)) {
        const auto hit = tracer_->closestHit(right_, point - right_);
        ASSERT_TRUE(hit);
        EXPECT_TRUE(isVisible(hit->position, left_));
        EXPECT_EQ(hit->geometricNormal, glm::vec3(0, 0, 1));
    }
}

TEST_F(FourObjects, LayersFromTheLeft) {
    std::set<char> layers[3];
    std::set<char> firstFromTheRight;
    constexpr int kAcross = 600;
    for (int j = 0; j < kAcross / 4; ++j) {
        for (int i = 0; i < kAcross; ++i) {
            // Points of a plane behind the objects that covers them from both eyes.
            const glm::vec3 point(40.0F * (static_cast<float>(i) + 0.5F) / kAcross - 20.0F,
                                  16.0F * (static_cast<float>(j) + 0.5F) / (kAcross / 4) - 3.0F,
                                  -25.0F);
            const std::string names = objectsAlong(left_, point - left_);
            ASSERT_LE(names.size(), 3U);
            for (std::size_t k = 0; k < names.size(); ++k) layers[k].insert(names[k]);
            const std::string fromRight = objectsAlong(right_, point - right_);
            if (!fromRight.empty()) firstFromTheRight.insert(fromRight[0]);
        }
    }
    EXPECT_EQ(layers[0], (std::set<char>{'A', 'D'}));
    EXPECT_EQ(layers[1], (std::set<char>{'B'}));
    EXPECT_EQ(layers[2], (std::set<char>{'C'}));
    EXPECT_EQ(firstFromTheRight, (std::set<char>{'A', 'B', 'D'}));
}

}  // namespace
}  // namespace gfxrepro::raycast
