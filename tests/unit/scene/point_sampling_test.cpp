#include "engine/scene/point_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene {
namespace {

Scene rectangles() {
    MeshBuilder builder;
    builder.setColor({0.5F, 0.25F, 0.125F});
    builder.addQuad({0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0});
    builder.addQuad({10, 0, 0}, {11, 0, 0}, {11, 1, 0}, {10, 1, 0});
    return sceneOf(builder.take("rectangles", -1));
}

PointCloud spherePoints(int count) {
    PointCloud points;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / count, angle = 2.399963229728653 * i;
        const double r = std::sqrt(1.0 - z * z);
        points.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return points;
}

TEST(SampledPoints, AreSpreadByArea) {
    const PointCloud points = sampledPoints(rectangles(), 4000);
    ASSERT_EQ(points.positions.size(), 4000U);
    const auto far = std::count_if(points.positions.begin(), points.positions.end(),
                                   [](const glm::vec3& p) { return p.x > 5.0F; });
    EXPECT_EQ(far, 1000);
    // Each of 300 equal cells of the larger rectangle has its 10 points, give or take.
    std::vector<int> cells(300);
    for (const glm::vec3& p : points.positions) {
        EXPECT_EQ(p.z, 0.0F);
        if (p.x < 5.0F) ++cells[static_cast<std::size_t>(p.y * 10) * 30 + std::size_t(p.x * 10)];
    }
    EXPECT_GE(*std::min_element(cells.begin(), cells.end()), 6);
    EXPECT_LE(*std::max_element(cells.begin(), cells.end()), 14);
    EXPECT_NEAR(points.radii[0], 2.0 * std::sqrt(4.0 / 4000 / glm::pi<double>()), 1e-6);
    EXPECT_EQ(points.normals[7], glm::vec3(0, 0, 1));
    EXPECT_NEAR(points.colors[7].x, 0.4F, 1e-6F);  // default grey times vertex colour
}

TEST(SampledPoints, OfAFlatMeshHaveItsTrianglesNormals) {
    Mesh mesh;  // two triangles at a right angle, with two vertices in common
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
    mesh.isFlat = true;
    const PointCloud points = sampledPoints(sceneOf(mesh), 100);
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const bool isUpright = points.positions[i].y > 0.0F;
        EXPECT_EQ(points.normals[i], isUpright ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0)) << i;
    }
}

TEST(SampledPoints, AreFramedByTheirSurface) {
    const Scene scene = rectangles();
    for (const std::size_t count : {1U, 50U, 4000U}) {
        const PointCloud points = sampledPoints(scene, count);
        EXPECT_EQ(points.framed().min, scene.bounds().min);
        EXPECT_EQ(points.framed().max, scene.bounds().max);
        EXPECT_NE(points.bounds().max, scene.bounds().max);
        EXPECT_EQ(points.surface.triangles.size(), scene.triangleCount());
    }
}

TEST(SurfaceOf, HasTheOutsideOutsideOfAMirrorImage) {
    MeshBuilder builder;
    builder.addBox({1, 0, 0}, {0.5F, 0.5F, 0.5F});
    Scene scene = sceneOf(builder.take("box", -1));
    scene.instances[0].worldFromMesh[0][0] = -2.0F;
    const Mesh surface = surfaceOf(scene);
    EXPECT_EQ(surface.bounds().min, glm::vec3(-3.0F, -0.5F, -0.5F));
    for (const glm::uvec3& triangle : surface.triangles) {
        const glm::vec3 &a = surface.positions[triangle.x], &b = surface.positions[triangle.y],
                        &c = surface.positions[triangle.z];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), surface.normals[triangle.x]), 0.0F);
    }
}

TEST(SampledPoints, RefuseWhatHasNoArea) {
    const Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}};
    Scene scene = sceneOf(mesh);
    scene.name = "line";
    try {
        sampledPoints(scene, 10);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "scene 'line' has no surface to take points from");
    }
    EXPECT_THROW(sampledPoints(rectangles(), 0), Error);
}

TEST(ThinnedPoints, AreEvenlyTaken) {
    const PointCloud all = spherePoints(20000);
    const PointCloud some = thinnedPoints(all, 2000);
    ASSERT_EQ(some.positions.size(), 2000U);
    for (int axis = 0; axis < 3; ++axis) {  // each half of the sphere keeps its half
        const auto half = std::count_if(some.positions.begin(), some.positions.end(),
                                        [&](const glm::vec3& p) { return p[axis] > 0.0F; });
        EXPECT_NEAR(static_cast<double>(half), 1000.0, 20.0);
    }
    EXPECT_EQ(thinnedPoints(all, 20001).positions, all.positions);
    EXPECT_EQ(some.framed().max, all.bounds().max);
    EXPECT_NE(some.bounds().max, all.bounds().max);
}

TEST(CompletePoints, EstimatesASpheresNormalsOutwards) {
    PointCloud points = spherePoints(5000);
    const PointRepairs repairs = completePoints(points);
    EXPECT_EQ(repairs.normals, 5000U);
    EXPECT_EQ(repairs.radii, 5000U);
    const double spacing = std::sqrt(4.0 * glm::pi<double>() / 5000);
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        EXPECT_GT(glm::dot(points.normals[i], points.positions[i]), 0.995F) << i;
        EXPECT_NEAR(points.radii[i], spacing, 0.35 * spacing) << i;
    }
}

TEST(CompletePoints, TurnsTheWayOfGivenNormals) {
    PointCloud points = spherePoints(2000);
    points.normals.assign(2000, glm::vec3(0.0F));
    points.normals[100] = -2.0F * points.positions[100];  // inwards, and not of unit length
    const PointRepairs repairs = completePoints(points);
    EXPECT_EQ(repairs.normals, 1999U);
    EXPECT_NEAR(glm::length(points.normals[100]), 1.0F, 1e-6F);
    for (std::size_t i = 0; i < 2000; ++i) {
        EXPECT_LT(glm::dot(points.normals[i], points.positions[i]), -0.99F) << i;
    }
}

TEST(CompletePoints, DropsDuplicatesAndWhatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    PointCloud points{.positions = {{0, 0, 0}, {1, 0, 0}, {nan, 0, 0}, {0, 0, 0}, {2, 0, 0}},
                      .normals = {{0, 1, 0}, {nan, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}},
                      .radii = {0.5F, 0.0F, 1.0F, 2.0F, -1.0F}};
    const PointRepairs repairs = completePoints(points);
    EXPECT_EQ(repairs.dropped, 1U);
    EXPECT_EQ(repairs.duplicates, 1U);
    EXPECT_EQ(repairs.normals, 1U);
    EXPECT_EQ(repairs.radii, 2U);
    ASSERT_EQ(points.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
    EXPECT_EQ(points.radii, (std::vector<float>{0.5F, 1.0F, 1.5F}));
}

TEST(CompletePoints, TakesOnePointAndRefusesNone) {
    PointCloud one{.positions = {{3, 4, 5}, {3, 4, 5}}};
    completePoints(one);
    ASSERT_EQ(one.positions.size(), 1U);
    EXPECT_EQ(one.normals[0], glm::vec3(0, 1, 0));
    EXPECT_EQ(one.radii[0], 1.0F);
    PointCloud none;
    try {
        completePoints(none);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "no point with a finite position");
    }
}

TEST(Eigensystem, SolvesASymmetricMatrix) {
    Random random(5);
    for (int trial = 0; trial < 50; ++trial) {
        glm::dmat3 a(0.0);
        for (int k = 0; k < 4; ++k) {
            const glm::dvec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            a += glm::outerProduct(v, v);
        }
        const Eigensystem system = eigensystem(a);
        EXPECT_LE(system.values[0], system.values[1]);
        EXPECT_LE(system.values[1], system.values[2]);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 v = system.vectors[k];
            EXPECT_NEAR(glm::length(v), 1.0, 1e-12);
            EXPECT_NEAR(glm::length(a * v - system.values[k] * v), 0.0, 1e-12);
        }
    }
}

TEST(Covariance, OfPointsFarFromTheOrigin) {
    Covariance covariance;
    for (const float x : {-1.0F, 1.0F}) {
        for (const float y : {-2.0F, 2.0F}) covariance.add({10000.0F + x, y, 5.0F});
    }
    EXPECT_EQ(covariance.mean(), glm::dvec3(10000.0, 0.0, 5.0));
    EXPECT_EQ(covariance.matrix()[0][0], 1.0);
    EXPECT_EQ(covariance.matrix()[1][1], 4.0);
    EXPECT_EQ(covariance.matrix()[2][2], 0.0);
}

TEST(CompletePoints, StrayPointsGetNoHugeDiscs) {
    PointCloud points;
    for (int i = 0; i < 400; ++i) {
        points.positions.emplace_back(0.1F * static_cast<float>(i % 20),
                                      0.1F * static_cast<float>(i / 20), 0.0F);
    }
    points.positions.emplace_back(50, 50, 50);
    EXPECT_EQ(completePoints(points).radii, 401U);
    // Four neighbours of the grid at 0.1, two at 0.1·√2: the median.
    const float median = 0.1F * (4.0F + 2.0F * std::sqrt(2.0F)) / 6.0F;
    EXPECT_NEAR(points.radii[10 * 20 + 10], median, 1e-4F);
    EXPECT_NEAR(points.radii[400], 4.0F * median, 1e-3F);
}

}  // namespace
}  // namespace gfxrepro::scene
