#include "techniques/reflections/embree_tracer.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <string>

#include "techniques/reflections/gpu_ray_tracer.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflections {
namespace {

constexpr glm::ivec2 kSizePx(48, 36);

scene::Box roomBox() {
    return {glm::vec3(-2.0F, 0.0F, -1.5F), glm::vec3(2.5F, 2.2F, 3.0F)};
}

/// Six coloured walls, a light, and a mirror for a floor.
scene::Scene mirrorFloorRoom() {
    scene::Scene scene = mattRoom(roomBox());
    scene.materials[2] = mirror();
    scene.lights = {{glm::vec3(0.5F, 1.5F, 0.2F), glm::vec3(0.8F, 0.7F, 0.6F), 1.5F}};
    return scene;
}

scene::Camera aboveFloor() {
    return camera({0.2F, 1.6F, 2.2F}, {0.1F, 0.0F, 0.4F});
}

/// Walls that glow in one colour, and a black floor that reflects.
scene::Scene glowingRoom(const glm::vec3& colour, float glossiness) {
    std::vector<scene::Material> materials(6, glowing(colour));
    materials[2] = mirror(glossiness);
    materials[2].baseColor = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    scene::Scene scene;
    addRoom(scene, roomBox(), materials);
    return scene;
}

std::vector<glm::mat4> posesOf(const EmbreeTrace& traced) {
    const std::span<const glm::mat4> poses = traced.prepared.objects.poses();
    return {poses.begin(), poses.end()};
}

/// What a wall shows at a hit, worked out from its material.
glm::vec3 shown(const scene::Scene& scene, const WallHit& hit, const glm::vec3& albedo) {
    return shadeDiffuse(scene.lights, glm::vec3(hit.position), hit.normal, albedo,
                        scene.materials[static_cast<std::size_t>(hit.side)].emissive);
}
glm::vec3 shown(const scene::Scene& scene, const WallHit& hit) {
    return shown(scene, hit,
                 glm::vec3(scene.materials[static_cast<std::size_t>(hit.side)].baseColor));
}

/// The mirror ray of a pixel that looks onto the floor, without the G-buffer.
struct FloorRay {
    glm::dvec3 origin, direction;
};
FloorRay floorRay(const kit::View& view, glm::ivec2 pixel) {
    const glm::dvec3 eye(view.eyeWorld);
    glm::dvec3 direction(kit::rayThrough(view, glm::vec2(pixel) + 0.5F));
    const glm::dvec3 origin = eye + direction * (-eye.y / direction.y);
    direction.y = -direction.y;
    return {origin, direction};
}

/// What the floor is drawn beside the true one: corners lie on 256ths of a pixel, which is 0.1 m
/// and more of a floor seen in 36 rows.
constexpr double kSnappedM = 5e-4;

using EmbreeTracerTest = TracerTest;

TEST_F(EmbreeTracerTest, MirrorFloorShowsTheRoom) {
    const scene::Scene source = mirrorFloorRoom();
    const EmbreeTrace traced = trace(source, aboveFloor(), kSizePx);
    ASSERT_EQ(traced.samples.size(), 48U * 36U);

    int count = 0;
    bool isSeen[6] = {};
    forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const FloorRay ray = floorRay(traced.gbuffer.view, pixel);
        const WallHit hit = wallHit(roomBox(), ray.origin, ray.direction);
        EXPECT_NEAR(traced.samples[index].distanceM, hit.distanceM, kSnappedM);
        if (hit.edgeDistanceM < 1e-4) return;
        EXPECT_EQ(traced.samples[index].object, 1U + static_cast<unsigned>(hit.side));
        EXPECT_LT(largestDifference(traced.samples[index].radiance, shown(source, hit)), 1e-4F);
        isSeen[hit.side] = true;
        ++count;
    });
    EXPECT_GT(count, 800);
    EXPECT_TRUE(isSeen[0] && isSeen[1] && isSeen[3] && isSeen[4]);
    for (std::size_t i = 0; i < traced.samples.size(); ++i) {
        if (traced.gbuffer.isReflective(i)) continue;
        EXPECT_EQ(traced.samples[i].object, 0U);
    }
}

TEST_F(EmbreeTracerTest, MirrorSphereShowsTheRoom) {
    scene::Scene source = mirrorFloorRoom();
    source.materials[2] = matt({0.2F, 0.2F, 0.9F});
    const glm::vec3 centre(0.2F, 1.0F, 0.3F);
    addPart(source, dome(centre, 0.4F, glm::pi<float>(), 192, 96), mirror());
    const EmbreeTrace traced = trace(source, camera({0.4F, 1.3F, 1.9F}, centre), kSizePx);

    int count = 0;
    bool isSeen[6] = {};
    forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        // From where the drawn sphere is, about the normal of the true one.
        const glm::dvec3 origin(traced.gbuffer.positionWorld(pixel));
        const glm::dvec3 normal = glm::normalize(origin - glm::dvec3(centre));
        const glm::dvec3 direction =
            glm::reflect(glm::normalize(origin - glm::dvec3(traced.gbuffer.view.eyeWorld)), normal);
        // Rays that graze the true sphere enter the drawn one.
        if (glm::dot(direction, normal) < 0.1) return;
        const WallHit hit = wallHit(roomBox(), origin, direction);
        // The interpolated normal is not quite the true one.
        if (hit.edgeDistanceM < 0.02) return;
        EXPECT_EQ(traced.samples[index].object, 1U + static_cast<unsigned>(hit.side));
        EXPECT_NEAR(traced.samples[index].distanceM, hit.distanceM, 5e-3);
        EXPECT_LT(largestDifference(traced.samples[index].radiance, shown(source, hit)), 5e-3F);
        isSeen[hit.side] = true;
        ++count;
    });
    EXPECT_GT(count, 250);
    for (const bool seen : isSeen) EXPECT_TRUE(seen);
}

/// Vertex colours that grow along x, on a ceiling that is turned inside out by its instance.
TEST_F(EmbreeTracerTest, AttributesOfMirroredInstancesStayWithTheirVertices) {
    scene::Scene source = mirrorFloorRoom();
    const scene::Box box = roomBox();
    scene::Mesh& ceiling = source.meshes[3];
    source.materials[3] = matt(glm::vec3(1.0F));
    const float middle = box.centre().x;
    for (glm::vec3& position : ceiling.positions) {
        ceiling.colors.push_back(glm::vec3((position.x - box.min.x) / box.size().x, 0.5F, 0.25F));
        position.x -= middle;
    }
    source.instances[3].worldFromMesh = glm::scale(
        glm::translate(glm::mat4(1.0F), glm::vec3(middle, 0.0F, 0.0F)), glm::vec3(-1, 1, 1));
    const EmbreeTrace traced = trace(source, aboveFloor(), kSizePx);
    int count = 0;
    forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const FloorRay ray = floorRay(traced.gbuffer.view, pixel);
        const WallHit hit = wallHit(box, ray.origin, ray.direction);
        if (hit.side != 3 || hit.edgeDistanceM < 1e-4) return;
        const auto x = static_cast<float>(hit.position.x);
        const glm::vec3 albedo((box.max.x - x) / box.size().x, 0.5F, 0.25F);
        EXPECT_LT(largestDifference(traced.samples[index].radiance, shown(source, hit, albedo)),
                  1e-4F);
        ++count;
    });
    EXPECT_GT(count, 200);
}

TEST_F(EmbreeTracerTest, GlossyMeanOfOneColourIsThatColour) {
    const glm::vec3 colour(0.3F, 0.4F, 0.5F);
    scene::Scene source = glowingRoom(colour, 0.3F);
    source.materials[2].emissive = colour;  // the diffuse colour stands in for what has faded
    const EmbreeTrace traced = trace(source, aboveFloor(), kSizePx);
    const int count = forEachReflective(traced.gbuffer, [&](glm::ivec2, std::size_t index) {
        // The G-buffer keeps ten bits of a colour's root.
        EXPECT_LT(largestDifference(traced.samples[index].radiance, colour), 2e-3F);
    });
    EXPECT_GT(count, 800);
}

/// Black floor, glowing walls: what is left of the glow is the mean weight of the lobe's rays.
TEST_F(EmbreeTracerTest, GlossyRaysFadeTowardsTheFarPlane) {
    const glm::vec3 colour(0.8F, 0.6F, 0.4F);
    const LobeSettings lobe{12, 0.5F, 4.0F};
    const EmbreeTrace traced = trace(glowingRoom(colour, 0.2F), aboveFloor(), kSizePx, lobe);

    const float glossiness = 51.0F / 255.0F;
    const double farPlane = double{glm::length(roomBox().size())} * std::pow(0.8, 4.0);
    int faded = 0, whole = 0;
    forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const FloorRay ray = floorRay(traced.gbuffer.view, pixel);
        double weights = 0.0;
        for (int i = 0; i < 12; ++i) {
            const glm::dvec3 direction(
                lobeDirection(lobe, glm::vec3(ray.direction), glossiness, i, 12));
            ASSERT_GT(direction.y, 0.0);
            const WallHit hit = wallHit(roomBox(), ray.origin, direction);
            weights += std::clamp(3.0 * (1.0 - hit.distanceM / farPlane), 0.0, 1.0);
        }
        const glm::vec3 expected = static_cast<float>(weights / 12.0) * colour;
        EXPECT_LT(largestDifference(traced.samples[index].radiance, expected), 2e-4F);
        EXPECT_NEAR(traced.samples[index].distanceM,
                    wallHit(roomBox(), ray.origin, ray.direction).distanceM, kSnappedM);
        ++(weights < 11.999 ? faded : whole);
    });
    EXPECT_GT(faded, 100);
    EXPECT_GT(whole, 100);
}

/// The ceiling goes up by a metre; the gap shows the background.
TEST_F(EmbreeTracerTest, MovedObjectsAreMetWhereTheyAre) {
    const scene::Scene source = mirrorFloorRoom();
    EmbreeTrace traced = trace(source, aboveFloor(), kSizePx);

    std::vector<glm::mat4> poses = posesOf(traced);
    poses[3] = glm::translate(poses[3], glm::vec3(0.0F, 1.0F, 0.0F));
    traced.prepared.objects.setPoses(poses);
    traced.tracer.update(traced.prepared.objects, profiler);
    const std::vector<TracedSample> after = traced.tracer.trace(traced.gbuffer);

    scene::Box raised = roomBox();
    raised.max.y += 1.0F;
    int onCeiling = 0, throughGap = 0, unchanged = 0;
    forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const FloorRay ray = floorRay(traced.gbuffer.view, pixel);
        const WallHit hit = wallHit(raised, ray.origin, ray.direction);
        const double rim = double{roomBox().max.y};
        if (hit.edgeDistanceM < 1e-3 || std::abs(hit.position.y - rim) < 1e-3) return;
        if (hit.side != 3 && hit.position.y > rim) {
            EXPECT_EQ(after[index].object, 0U);
            EXPECT_EQ(after[index].distanceM, 0.0F);
            EXPECT_EQ(after[index].radiance, kBackground);
            ++throughGap;
            return;
        }
        EXPECT_NEAR(after[index].distanceM, hit.distanceM, kSnappedM);
        EXPECT_LT(largestDifference(after[index].radiance, shown(source, hit)), 1e-4F);
        if (hit.side == 3) {
            EXPECT_GT(after[index].distanceM, traced.samples[index].distanceM + 0.9F);
            ++onCeiling;
        } else {
            EXPECT_EQ(after[index].distanceM, traced.samples[index].distanceM);
            ++unchanged;
        }
    });
    EXPECT_GT(onCeiling, 100);
    EXPECT_GT(throughGap, 50);
    EXPECT_GT(unchanged, 100);
}

/// A floor whose normals lean so far away that mirror rays go through it, to what glows below.
scene::Scene leaningFloor(float glossiness) {
    scene::Scene source;
    source.name = "leaning floor";
    scene::Mesh floor = rectangle({0, 0, 0}, {0, 0, 3}, {3, 0, 0});
    floor.normals.assign(floor.positions.size(), glm::normalize(glm::vec3(0.0F, 0.5F, -1.0F)));
    addPart(source, std::move(floor), mirror(glossiness));
    addPart(source, block({glm::vec3(-9.0F, -3.0F, -9.0F), glm::vec3(9.0F, -1.0F, 9.0F)}),
            glowing({1.0F, 0.5F, 0.0F}));
    return source;
}

TEST_F(EmbreeTracerTest, RaysBelowTheirTriangleHaveNoWeight) {
    for (const float glossiness : {0.0F, 0.1F}) {
        EmbreeTrace traced =
            trace(leaningFloor(glossiness), camera({0, 1.5F, 2.5F}, {0, 0, 0}), kSizePx);
        GpuRayTracer compute(shaders, traced.prepared.objects, {},
                             traced.prepared.scene.diagonalM());
        compute.update(traced.prepared.objects, profiler);
        ReflectionTarget target(kSizePx);
        compute.trace(traced.prepared.gbuffer, nullptr, target, profiler);
        const auto radiance = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        const auto distancesM = target.distance.read<float>(GL_RED, GL_FLOAT, 1);
        int count = 0;
        forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
            ASSERT_LT(traced.gbuffer.mirrorDirection(pixel).y, -0.1F);
            const glm::vec3& diffuse = traced.gbuffer.diffuse[index];
            EXPECT_EQ(traced.samples[index].object, 0U);
            EXPECT_LT(largestDifference(traced.samples[index].radiance, diffuse), 1e-6F);
            EXPECT_EQ(distancesM[index], 0.0F);
            EXPECT_LT(largestDifference(glm::vec3(radiance[index]), diffuse), 1e-3F);  // halves
            ++count;
        });
        EXPECT_GT(count, 300);
    }
}

/// A wall on a mirror, seen from near: a hundred-thousandth of the diagonal is mirrored, too.
TEST_F(EmbreeTracerTest, WhatTouchesAMirrorIsMirrored) {
    scene::Scene source;
    source.name = "corner";
    addPart(source, rectangle({0, 0, 0}, {0, 0, 3}, {3, 0, 0}), mirror());
    addPart(source, rectangle({0, 1, 0}, {0, 1, 0}, {3, 0, 0}), glowing({1.0F, 0.5F, 0.0F}));
    scene::Camera near = camera({0.0F, 0.03F, 0.03F}, {0.0F, 0.0F, 0.0006F});
    near.verticalFovRad = 0.02F;
    near.nearM = 1e-3F;
    const EmbreeTrace traced = trace(source, near, kSizePx);
    int count = 0;
    forEachReflective(traced.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const float z = traced.gbuffer.positionWorld(pixel).z;
        if (z < 2e-4F) return;
        EXPECT_EQ(traced.samples[index].object, 2U) << z;
        EXPECT_NEAR(traced.samples[index].distanceM, z * std::numbers::sqrt2_v<float>, 0.05F * z);
        count += z < 6e-4F ? 1 : 0;  // the diagonal is 9 m
    });
    EXPECT_GT(count, 100);
}

TEST_F(EmbreeTracerTest, MirrorRaysEndWhereTheyDoWithRadiance) {
    const scene::Scene source = mirrorFloorRoom();
    EmbreeTrace traced = trace(source, aboveFloor(), kSizePx);
    const std::vector<TracedSample> ends = traced.tracer.traceMirrorRays(traced.gbuffer);
    ASSERT_EQ(ends.size(), traced.samples.size());
    std::size_t met = 0;
    for (std::size_t i = 0; i < traced.samples.size(); ++i) {
        EXPECT_EQ(ends[i].distanceM, traced.samples[i].distanceM);
        EXPECT_EQ(ends[i].object, traced.samples[i].object);
        EXPECT_EQ(ends[i].radiance, glm::vec3(0.0F));
        met += ends[i].object != 0 ? 1 : 0;
    }
    EXPECT_GT(met, traced.samples.size() / 10);
    EXPECT_EQ(readSurfaces(traced.prepared.gbuffer), traced.gbuffer.surface);
}

}  // namespace
}  // namespace gfxrepro::reflections
