
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/params.h"
#include "engine/core/random.h"
#include "engine/raycast/ray_tracer.h"
#include "scenes/registry.h"
#include "scenes/shared/mesh_builder.h"
#include "tests/support/crossings.h"
#include "tests/support/grid.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace gfxrepro::raycast {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Embree's reciprocals differ between processors, by a few units of the last place.
auto areDistances(const std::vector<float>& expected) {
    return testing::Pointwise(testing::FloatNear(1e-5F), expected);
}

scene::Scene body(const std::string& shape, int triangles = 20000) {
    Node values;
    values.set("shape", Node::scalar(shape));
    values.set("triangles", Node::number(triangles));
    Params params(values, "generator");
    return scene::findGenerator(scene::registeredGenerators(), "sdf_model", {}).generate(params, 1);
}

TEST(RayTracer, MeetsAPlaneWhereItIs) {
    const RayTracer tracer(scene::sceneOf(test::rectangle()));
    const auto hit = tracer.closestHit({0.5F, -0.25F, 3}, {0, 0, -7});
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->distance, 3.0F);  // along the unit direction
    EXPECT_LT(glm::distance(hit->position, glm::vec3(0.5F, -0.25F, 0)), 1e-5F);
    EXPECT_EQ(hit->geometricNormal, glm::vec3(0, 0, 1));
    EXPECT_EQ(hit->instance, 0U);
    EXPECT_EQ(hit->triangle, 0U);
    // 0.5 = -1·w0 + 1·w1 + 1·w2, -0.25 = -1·w0 - 1·w1 + 1·w2
    EXPECT_NEAR(hit->barycentric.x, 0.375F, 1e-6F);
    EXPECT_NEAR(hit->barycentric.y, 0.375F, 1e-6F);
    EXPECT_FALSE(tracer.closestHit({1.5F, 0, 3}, {0, 0, -1}));
    EXPECT_FALSE(tracer.closestHit({0.5F, 0, 3}, {0, 0, 1}));
    EXPECT_FALSE(tracer.closestHit({0.5F, 0, 3}, {0, 0, -1}, 0.0F, 2.9F));
    EXPECT_FALSE(tracer.closestHit({0.5F, 0, 3}, {0, 0, -1}, 3.1F));
    EXPECT_EQ(tracer.closestHit({0.5F, 0, -3}, {0, 0, 1})->geometricNormal, glm::vec3(0, 0, 1));
}

TEST(RayTracer, OcclusionHasEnds) {
    const RayTracer tracer(scene::sceneOf(test::rectangle()));
    EXPECT_TRUE(tracer.isOccluded({0.3F, 0, 1}, {0, 0, -10}, 0.0F, 2.0F));
    EXPECT_FALSE(tracer.isOccluded({0.3F, 0, 1}, {0, 0, -10}, 0.0F, 0.99F));
    EXPECT_FALSE(tracer.isOccluded({0.3F, 0, 1}, {0, 0, -10}, 1.01F, kInfinity));
    EXPECT_FALSE(tracer.isOccluded({3, 0, 1}, {0, 0, -1}, 0.0F, kInfinity));
}

TEST(RayTracer, SphereDistancesMatchTheEquation) {
    const RayTracer tracer(body("sphere", 100000));
    Random random(7);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 origin = 3.0F * glm::normalize(test::randomIn(random, -1.0F, 1.0F));
        const glm::vec3 direction = glm::normalize(test::randomIn(random, -1.0F, 1.0F) - origin);
        const float b = glm::dot(origin, direction);
        const float discriminant = b * b - glm::dot(origin, origin) + 1.0F;
        if (std::abs(discriminant) < 0.02F) continue;  // grazing: the facets decide
        const auto hit = tracer.closestHit(origin, direction);
        ASSERT_EQ(hit.has_value(), discriminant > 0.0F);
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->distance, -b - std::sqrt(discriminant), 5e-3F);
        EXPECT_GT(glm::dot(hit->geometricNormal, hit->position), 0.99F);
        EXPECT_TRUE(tracer.isOccluded(origin, direction, 0.0F, 6.0F));
    }
    EXPECT_GT(hits, 500);
}

TEST(RayTracer, InstancesKeepTheirNumbersAndTheirOutside) {
    scene::Scene scene = scene::sceneOf(test::rectangle());
    const glm::mat4 moved = glm::translate(glm::mat4(1.0F), glm::vec3(10, 0, 0));
    scene.instances.push_back({0, glm::scale(moved, glm::vec3(-2, 2, 2))});  // a mirror image
    const RayTracer tracer(scene);
    const auto hit = tracer.closestHit({11, 0.5F, 5}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->instance, 1U);
    // flattened() turns mirrored triangles, so that the mirrored square still faces +z.
    EXPECT_EQ(hit->geometricNormal, glm::vec3(0, 0, 1));
    const glm::uvec3 t = scene.meshes[0].triangles[hit->triangle];
    const glm::vec2 b = hit->barycentric;
    const auto& p = scene.meshes[0].positions;
    const glm::vec3 inMesh = (1 - b.x - b.y) * p[t.x] + b.x * p[t.y] + b.y * p[t.z];
    EXPECT_NEAR(inMesh.x, -0.5F, 1e-6F);
    EXPECT_NEAR(inMesh.y, 0.25F, 1e-6F);
}

TEST(RayTracer, AllHitsCountEveryTriangleAndCrossingsEverySurface) {
    scene::MeshBuilder box;
    box.addBox(glm::vec3(0.0F), glm::vec3(1.0F));
    const RayTracer cube(scene::sceneOf(box.take("cube", -1)));
    EXPECT_THAT(test::crossings(cube, {-3, 0.123F, 0.231F}, {1, 0, 0}), areDistances({2, 4}));
    EXPECT_EQ(test::allHits(cube, {-3, 0.123F, 0.231F}, {1, 0, 0}).size(), 2U);
    EXPECT_TRUE(test::allHits(cube, {-3, 3, 0}, {1, 0, 0}).empty());

    // Along the diagonal of two faces: the ray meets both triangles of the shared edge.
    const RayTracer two(scene::sceneOf(test::rectangle()));
    EXPECT_GE(test::allHits(two, {0, 0, 1}, {0, 0, -1}).size(), 1U);
    EXPECT_EQ(test::crossings(two, {0, 0, 1}, {0, 0, -1}).size(), 1U);
    for (int i = 1; i < 100; ++i) {  // never through the crack, never twice
        const float s = 0.019F * static_cast<float>(i) - 0.95F;
        EXPECT_EQ(test::crossings(two, {s, s, 1}, {0, 0, -1}).size(), 1U) << s;
    }
}

/// Three squares facing +z at z = 0, −1, −2 of one-sided, double-sided and no material, the last
/// one a mirror image, and a fourth at z = −3 that is turned away.
scene::Scene stackOfSquares() {
    scene::Scene scene;
    scene.materials.resize(2);
    scene.materials[1].isDoubleSided = true;
    for (const int material : {0, 1, -1}) {
        scene.meshes.push_back(test::rectangle());
        scene.meshes.back().material = material;
    }
    const glm::mat4 one(1.0F);
    const glm::mat4 third = glm::translate(one, glm::vec3(0, 0, -2));
    const glm::mat4 fourth = glm::translate(one, glm::vec3(0, 0, -3));
    scene.instances = {{0, one},
                       {1, glm::translate(one, glm::vec3(0, 0, -1))},
                       {2, glm::scale(third, glm::vec3(-1, 1, 1))},
                       {0, glm::rotate(fourth, glm::pi<float>(), glm::vec3(1, 0, 0))}};
    return scene;
}

std::vector<float> distancesOf(const std::vector<TriangleHit>& hits) {
    std::vector<float> distances;
    for (const TriangleHit& hit : hits) distances.push_back(hit.distance);
    return distances;
}

TEST(RayTracer, DrawnFacesAreThoseThatCullingLeaves) {
    const RayTracer tracer(stackOfSquares());
    const glm::vec3 front(0.5F, -0.25F, 1);
    const glm::vec3 behind(0.5F, -0.25F, -4);
    std::vector<TriangleHit> hits;
    tracer.hitsBetween(front, {0, 0, -2}, 0, kInfinity, Faces::All, hits);
    EXPECT_THAT(distancesOf(hits), areDistances({1, 2, 3, 4}));
    tracer.hitsBetween(front, {0, 0, -2}, 0, kInfinity, Faces::Drawn, hits);
    EXPECT_THAT(distancesOf(hits), areDistances({1, 2, 3}));
    tracer.hitsBetween(front, {0, 0, -2}, 1.5F, 2.5F, Faces::Drawn, hits);
    EXPECT_THAT(distancesOf(hits), areDistances({2}));
    tracer.hitsBetween(behind, {0, 0, 1}, 0, kInfinity, Faces::Drawn, hits);
    EXPECT_THAT(distancesOf(hits), areDistances({1, 3}));

    EXPECT_FLOAT_EQ(tracer.closestHit(behind, {0, 0, 1}, 1.5F)->distance, 2.0F);
    EXPECT_FLOAT_EQ(tracer.closestHit(behind, {0, 0, 1}, 1.5F, 9.0F, Faces::Drawn)->distance, 3.0F);
    EXPECT_FALSE(tracer.closestHit(behind, {0, 0, 1}, 3.5F, 9.0F, Faces::Drawn));
    EXPECT_TRUE(tracer.isOccluded(behind, {0, 0, 1}, 1.5F, 2.5F));
    EXPECT_FALSE(tracer.isOccluded(behind, {0, 0, 1}, 1.5F, 2.5F, Faces::Drawn));
    EXPECT_TRUE(tracer.isOccluded(behind, {0, 0, 1}, 1.5F, 3.5F, Faces::Drawn));
    EXPECT_FALSE(tracer.isOccluded(behind, {0, 0, 1}, 1.5F, 3.5F, Faces::Drawn, hits[1].triangle));
}

TEST(RayTracer, TellsWhatIsInTheWay) {
    const RayTracer tracer(stackOfSquares());
    const glm::vec3 front(0.5F, -0.25F, 1);
    std::vector<TriangleHit> hits;
    tracer.hitsBetween(front, {0, 0, -2}, 0, kInfinity, Faces::Drawn, hits);
    const auto occluder = [&](float tMin, float tMax, unsigned ignored = kNoTriangle) {
        return tracer.occluder(front, {0, 0, -2}, tMin, tMax, Faces::Drawn, ignored);
    };
    EXPECT_EQ(occluder(1.5F, 2.5F), hits[1].triangle);
    EXPECT_EQ(occluder(1.5F, 2.5F, hits[1].triangle), std::nullopt);
    EXPECT_EQ(occluder(1.5F, 3.5F, hits[1].triangle), hits[2].triangle);
    EXPECT_EQ(occluder(3.5F, 9.0F), std::nullopt) << "the last one is seen from behind";
}

TEST(RayTracer, WhatIsClearlyHitIsHit) {
    const WorldTriangle triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, false};
    const auto isHit = [&](glm::vec3 target, glm::vec3 from, float tMin, float tMax) {
        return triangle.isClearlyHit(from, 7.0F * (target - from), tMin, tMax);
    };
    const glm::vec3 inside(0.25F, 0.25F, 0);
    const glm::vec3 eye(0.25F, 0.25F, 2);
    EXPECT_TRUE(isHit(inside, eye, 0, 3));
    EXPECT_FALSE(isHit(inside, eye, 0, 2)) << "ends at the triangle";
    EXPECT_FALSE(isHit(inside, eye, 2, 3)) << "begins at the triangle";
    EXPECT_FALSE(isHit(inside, -eye, 0, 3)) << "from behind";
    EXPECT_FALSE(isHit({0.25F, 1e-5F, 0}, eye, 0, 3)) << "near to an edge";
    EXPECT_FALSE(isHit({0.25F, -0.25F, 0}, eye, 0, 3)) << "beyond an edge";
    EXPECT_FALSE(isHit({0.49999F, 0.49999F, 0}, eye, 0, 3)) << "near to the third edge";
    EXPECT_FALSE(isHit(inside, {9, 9, 0.05F}, 0, 20)) << "grazing";
    WorldTriangle twoSided = triangle;
    twoSided.isDoubleSided = true;
    EXPECT_TRUE(twoSided.isClearlyHit(-eye, inside + eye, 0, 9));
    EXPECT_FALSE(WorldTriangle{}.isClearlyHit(eye, {0, 0, -1}, 0, 3)) << "no area";
}

TEST(RayTracer, AgreesOnWhatIsClearlyHit) {
    const scene::Scene scene = body("sphere", 500);
    const RayTracer tracer(scene);
    const std::size_t count = scene.triangleCount();
    Random random(11);
    int hits = 0, clear = 0;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 origin = test::randomIn(random, -3.0F, 3.0F);
        const glm::vec3 direction = test::randomIn(random, -1.0F, 1.0F) - origin;
        const float end = glm::length(direction);
        const auto occluder = tracer.occluder(origin, direction, 0, end, Faces::Drawn, kNoTriangle);
        hits += occluder ? 1 : 0;
        bool isClear = false;
        for (unsigned t = 0; t < count && !isClear; ++t) {
            isClear = tracer.triangle(t).isClearlyHit(origin, direction, 0, end);
        }
        EXPECT_LE(isClear, occluder.has_value());
        clear += isClear ? 1 : 0;
    }
    EXPECT_GT(hits, 1000);
    EXPECT_GT(clear, hits * 9 / 10);
}

TEST(RayTracer, TrianglesHaveTheNumbersOfTheFlattenedScene) {
    scene::Scene scene = stackOfSquares();
    scene.meshes.push_back({});  // instances without triangles take no numbers
    scene.instances.insert(scene.instances.begin() + 1, {3, glm::mat4(1.0F)});
    scene.instances.push_back({3, glm::mat4(1.0F)});
    const RayTracer tracer(scene);
    const scene::Mesh mesh = flattened(scene);
    ASSERT_EQ(mesh.triangles.size(), 8U);
    for (unsigned t = 0; t < 8; ++t) {
        const WorldTriangle triangle = tracer.triangle(t);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(triangle.corners[c], mesh.positions[mesh.triangles[t][c]]) << t;
        }
        EXPECT_EQ(triangle.isDoubleSided, t == 2 || t == 3);
        EXPECT_EQ(triangle.isDrawnFrom({0, 0, 5}), t < 6);
        EXPECT_EQ(triangle.isDrawnFrom({0, 0, -5}), t != 0 && t != 1 && t != 4 && t != 5);
        const glm::vec3 centroid =
            (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0F;
        const auto hit = tracer.closestHit(centroid + glm::vec3(0, 0, 0.5F), {0, 0, -1});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->flattenedTriangle, t);
    }
}

TEST(RayTracer, HitsBetweenAreTheNearestOnesOneBehindTheOther) {
    constexpr float kApart = 1e-5F;  // nearer ones are those of a shared edge, or of a grazing ray
    const RayTracer torus(body("torus"));
    Random random(11);
    std::vector<TriangleHit> hits;
    std::size_t most = 0, counted = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 origin = test::randomIn(random, -2.0F, 2.0F);
        const glm::vec3 direction = test::randomIn(random, -1.0F, 1.0F);
        torus.hitsBetween(origin, direction, 0, kInfinity, Faces::All, hits);
        std::vector<float> distances = distancesOf(hits);
        distances.erase(std::unique(distances.begin(), distances.end(),
                                    [](float a, float b) { return b - a <= kApart; }),
                        distances.end());
        std::vector<float> nearest;
        while (const auto hit = torus.closestHit(
                   origin, direction, nearest.empty() ? 0.0F : nearest.back() + kApart)) {
            nearest.push_back(hit->distance);
        }
        EXPECT_EQ(distances, nearest);
        most = std::max(most, hits.size());
        // Of a closed body, a ray from outside leaves as often as it enters.
        const float ring = std::sqrt(origin.x * origin.x + origin.z * origin.z) - 0.7F;
        const bool isOutside = std::sqrt(ring * ring + origin.y * origin.y) > 0.305F;
        if (!isOutside || hits.empty()) continue;
        const std::size_t all = hits.size();
        torus.hitsBetween(origin, direction, 0, kInfinity, Faces::Drawn, hits);
        if (all == test::crossings(torus, origin, direction).size()) {  // clear of edges
            EXPECT_EQ(hits.size(), all / 2);
            ++counted;
        }
        EXPECT_EQ(torus.closestHit(origin, direction, 0, kInfinity, Faces::Drawn)->distance,
                  hits.front().distance);
    }
    EXPECT_GE(most, 4U);
    EXPECT_GT(counted, 100U);
}

TEST(RayTracer, ColumnsThroughATorusCrossAnEvenNumberOfTimes) {
    const RayTracer torus(body("torus", 4000));
    for (const auto [y, x] : test::grid(64, 64)) {
        const glm::vec3 origin((static_cast<float>(x) + 0.5F) / 32.0F - 1.0F,
                               (static_cast<float>(y) + 0.5F) / 32.0F - 1.0F, -2.0F);
        EXPECT_EQ(test::crossings(torus, origin, {0, 0, 1}).size() % 2, 0U);
    }
}

/// Of a box of two mirrored halves, the nearest point is where each coordinate is clamped, or,
/// inside, on the nearest face.
TEST(RayTracer, NearestPointsAreOnTheNearestTriangle) {
    scene::Mesh half;  // y and z from −1 to 1, x from 0 to 1, open at 0
    half.positions = {{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1},
                      {1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}};
    half.triangles = {{4, 5, 6}, {4, 6, 7}, {0, 4, 7}, {0, 7, 3}, {1, 2, 6},
                      {1, 6, 5}, {3, 7, 6}, {3, 6, 2}, {0, 1, 5}, {0, 5, 4}};
    scene::Scene scene = scene::sceneOf(half);
    scene.instances.push_back({0, glm::scale(glm::mat4(1.0F), glm::vec3(-1, 1, 1))});
    const RayTracer tracer(scene);
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 point = test::randomIn(random, -3.0F, 3.0F);
        const auto hit = tracer.nearest(point);
        ASSERT_TRUE(hit);
        const glm::vec3 clamped = glm::clamp(point, -1.0F, 1.0F), inside = 1.0F - glm::abs(point);
        const bool isInside = clamped == point;
        const float expected =
            isInside ? std::min({inside.x, inside.y, inside.z}) : glm::distance(point, clamped);
        EXPECT_NEAR(hit->distance, expected, 1e-5F);
        EXPECT_TRUE(tracer.nearest(point, 1.001F * expected + 1e-5F));
        EXPECT_FALSE(tracer.nearest(point, 0.999F * expected - 1e-5F));
        EXPECT_NEAR(glm::distance(point, hit->position), expected, 1e-5F);
        EXPECT_GT(glm::dot(hit->geometricNormal, hit->position), 0.999F) << "outwards";
        const scene::Instance& instance = scene.instances[hit->instance];
        const glm::uvec3 corners = half.triangles[hit->triangle];
        const glm::vec2 weights = hit->barycentric;
        const glm::vec3 local = half.positions[corners.x] * (1.0F - weights.x - weights.y) +
                                half.positions[corners.y] * weights.x +
                                half.positions[corners.z] * weights.y;
        EXPECT_LT(glm::distance(glm::vec3(instance.worldFromMesh * glm::vec4(local, 1.0F)),
                                hit->position),
                  1e-5F);
        EXPECT_EQ(hit->flattenedTriangle, 10 * hit->instance + hit->triangle);
        const WorldTriangle triangle = tracer.triangle(hit->flattenedTriangle);
        EXPECT_TRUE(isInside || triangle.isDrawnFrom(point) || expected < 1e-5F ||
                    glm::dot(hit->geometricNormal, point - hit->position) > -1e-5F);
    }
    // Triangles without area are as near as their corners.
    const scene::Mesh line{.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                           .triangles = {{0, 1, 2}, {1, 1, 1}}};
    const auto hit = RayTracer(scene::sceneOf(line)).nearest({1.5F, 2, 0});
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->distance, 2.0F);
    EXPECT_EQ(hit->geometricNormal, glm::vec3(0));
    EXPECT_FALSE(RayTracer(scene::Scene{}).nearest({0, 0, 0}));
}

TEST(RayTracer, EmptySceneHasNoHits) {
    const RayTracer tracer{scene::Scene{}};
    EXPECT_FALSE(tracer.closestHit({0, 0, 0}, {0, 0, 1}));
    EXPECT_TRUE(test::allHits(tracer, {0, 0, 0}, {1, 0, 0}).empty());
}

}  // namespace
}  // namespace gfxrepro::raycast
