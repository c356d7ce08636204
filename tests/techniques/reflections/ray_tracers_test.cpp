#include "techniques/reflections/embree_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <string>

#include "engine/scene/animation.h"
#include "techniques/reflections/gpu_ray_tracer.h"
#include "tests/techniques/reflections/gl_calls.h"
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
    scene::Scene source{.name = "leaning floor"};
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
    scene::Scene source{.name = "corner"};
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

// The device's ray tracer against Embree's.

/// A mirror floor and a mirror ball among coloured boxes; the boxes move.
scene::Scene mirrors() {
    scene::Scene scene{.name = "mirrors",
                       .materials = {{.name = "plain"},
                                     {.name = "mirror", .metallic = 1.0F, .roughness = 0.0F},
                                     {.name = "glossy", .metallic = 0.9F, .roughness = 0.25F}}};
    scene::MeshBuilder builder;
    for (int i = 0; i < 40; ++i) {
        const float turn = 0.8F * static_cast<float>(i);
        builder.setColor({0.5F + 0.5F * std::sin(turn), 0.5F, 0.5F + 0.5F * std::cos(turn)});
        builder.addBox(
            {2.0F * std::cos(turn), 0.2F + 0.05F * static_cast<float>(i), 2.0F * std::sin(turn)},
            glm::vec3(0.15F));
    }
    scene.meshes.push_back(builder.take("boxes", 0));
    builder.setColor(glm::vec3(1.0F));
    builder.addBox({0, -0.1F, 0}, {4, 0.1F, 4});
    scene.meshes.push_back(builder.take("floor", 1));
    scene.meshes.push_back(dome({0, 0.9F, 0}, 0.8F, glm::pi<float>(), 48, 24));
    scene.meshes.back().material = 2;
    scene.instances = {{.mesh = 0}, {.mesh = 1}, {.mesh = 2}};
    scene.motions = {{.instance = 0, .axis = {0, 1, 0}, .turnRad = 3.0F, .swing = {0, 0.5F, 0}}};
    return scene;
}

/// Of the samples that reflect.
struct Comparison {
    int samples = 0, mismatches = 0;
    double radianceError = 0.0;  // mean absolute
};

struct GpuRayTracerTest : ReflectionsTest {
    Prepared prepared(const scene::Scene& source, std::optional<float> glossiness = {}) const {
        return {shaders,
                source,
                {.position = {1.0F, 2.5F, 6.0F}, .target = {0, 0.6F, 0}, .verticalFovRad = 0.8F},
                {129, 95},  // no multiple of a group's
                glossiness};
    }

    /// Both tracers over the scene in its pose at `time`.
    Comparison compared(const scene::Scene& from, const LobeSettings& lobe,
                        std::optional<float> glossiness, double time = 0.0) {
        Prepared frame = prepared(from, glossiness);
        const float diagonalM = frame.scene.diagonalM();
        frame.objects.setPoses(scene::posesAt(frame.scene.scene(), time));
        frame.renderer.render(frame.objects, frame.gbuffer);
        ReflectionTarget target(frame.gbuffer.view.sizePx);
        GpuRayTracer tracer(shaders, frame.objects, lobe, diagonalM);
        tracer.update(frame.objects, profiler);
        tracer.trace(frame.gbuffer, nullptr, target, profiler);
        EmbreeTracer embree(frame.scene, lobe);
        embree.update(frame.objects, profiler);
        const HostGBuffer host = readGBuffer(frame.gbuffer);
        const std::vector<TracedSample> truth = embree.trace(host);

        const auto distances = target.distance.read<float>(GL_RED, GL_FLOAT, 1);
        const auto radiances = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        // Rays start off their surface; hits nearer than that apart are told apart by rounding.
        const float roundingM = EmbreeTracer::kLift * diagonalM;
        Comparison result;
        result.samples = forEachReflective(host, [&](glm::ivec2, std::size_t i) {
            const float a = truth[i].distanceM, b = distances[i];
            const bool isMatch =
                (a > 0.0F) == (b > 0.0F) && std::abs(a - b) <= 1e-4F * std::max(a, b) + roundingM;
            result.mismatches += isMatch ? 0 : 1;
            const glm::vec3 error = glm::abs(glm::vec3(radiances[i]) - truth[i].radiance);
            result.radianceError += static_cast<double>(error.x + error.y + error.z) / 3.0;
        });
        result.radianceError /= std::max(result.samples, 1);
        return result;
    }
    static void expectEmbrees(const Comparison& result) {
        EXPECT_GT(result.samples, 3000);
        EXPECT_LE(result.mismatches, result.samples / 2000);  // grazes of edges
        EXPECT_LT(result.radianceError, 5e-4);
    }
};

TEST_F(GpuRayTracerTest, MeetsWhatEmbreeMeetsInMirrors) {
    expectEmbrees(compared(mirrors(), {}, 0.0F));
}

TEST_F(GpuRayTracerTest, ShadesLobesAsEmbreeDoes) {
    for (const std::optional<float> glossiness : {std::optional<float>(), {0.1F}, {1.0F}}) {
        SCOPED_TRACE(glossiness.value_or(-1.0F));
        expectEmbrees(compared(mirrors(), {}, glossiness));
    }
    expectEmbrees(compared(mirrors(), {.rays = 5}, 0.3F));
}

/// Floor and boxes with textures for everything; a mirrored instance among them.
scene::Scene texturedMirrors() {
    scene::Scene scene = mirrors();
    const auto image = [](const auto& texel) {
        return imageOf([&](int x, int y) {
            // Smooth: samplers round weights.
            return glm::u8vec3(127.5F + 127.0F * texel(6.2831853F * glm::vec2(x, y) / 128.0F));
        });
    };
    scene.textures = {
        image([](glm::vec2 p) {
            return glm::vec3(0.6F * std::sin(p.x), 0.6F * std::sin(p.y), 0.8F);
        }),
        image([](glm::vec2 p) { return glm::vec3(0.0F, std::sin(p.x), std::sin(p.y)); }),
        image([](glm::vec2 p) { return glm::vec3(std::sin(p.x), std::sin(p.y), 0.0F); })};
    for (scene::Material& material : scene.materials) {
        material.normalTexture = 0;
        material.emissiveTexture = 2;
        material.emissive = glm::vec3(0.3F);
    }
    scene.materials[1].metallicRoughnessTexture = 1;
    scene.materials[1].roughness = 1.0F;
    for (scene::Mesh& mesh : scene.meshes) {
        for (const glm::vec3& p : mesh.positions) {
            mesh.texcoords.emplace_back(0.9F * p.x + 0.4F * p.y, p.z - 0.7F * p.y);
        }
    }
    scene.instances[0].worldFromMesh = glm::scale(glm::mat4(1.0F), {-1.0F, 1.0F, 1.2F});
    return scene;
}

TEST_F(GpuRayTracerTest, ShadesTexturedMaterialsAsEmbreeDoes) {
    for (const std::optional<float> glossiness : {std::optional<float>(), {0.0F}}) {
        SCOPED_TRACE(glossiness.value_or(-1.0F));
        const Comparison result = compared(texturedMirrors(), {}, glossiness);
        // The floor reflects where its texels are smooth: less than half of what it is.
        EXPECT_GT(result.samples, 1000);
        EXPECT_LT(result.samples, compared(mirrors(), {}, 0.0F).samples);
        EXPECT_LE(result.mismatches, result.samples / 1000);
        // Samplers weigh texels in 256ths.
        EXPECT_LT(result.radianceError, 2e-3);
    }
}

TEST_F(GpuRayTracerTest, ReadsTexturesBeyondTheirEdgesAsEmbreeDoes) {
    using Wrap = scene::Sampling::Wrap;
    scene::Scene scene = texturedMirrors();
    scene.samplings = {{Wrap::Mirror, Wrap::Clamp, false},
                       {Wrap::Clamp, Wrap::Mirror, false},
                       {Wrap::Mirror, Wrap::Mirror, false}};
    const Comparison result = compared(scene, {}, 0.0F);
    EXPECT_GT(result.samples, 1000U);
    EXPECT_LE(result.mismatches, result.samples / 1000);
    EXPECT_LT(result.radianceError, 2e-3);
}

TEST_F(GpuRayTracerTest, FollowsMovedObjects) {
    expectEmbrees(compared(mirrors(), {}, 0.0F, 0.7));
}

// What the device may still be reading, of the last frame, is not written to by the host: that
// would wait for it.
TEST_F(GpuRayTracerTest, TheHostNeitherWritesNorWaitsWhileItTraces) {
    const Prepared frame = prepared(mirrors());
    GpuRayTracer tracer(shaders, frame.objects, {}, frame.scene.diagonalM());
    tracer.update(frame.objects, profiler);
    ReflectionTarget target(frame.gbuffer.view.sizePx);
    gl::Profiler untimed(false);
    tracer.trace(frame.gbuffer, nullptr, target, untimed);
    glCalls().clear();
    tracer.trace(frame.gbuffer, nullptr, target, untimed);
    EXPECT_GT(std::ranges::count(glCalls(), GlCall::Barrier), 0);
    EXPECT_EQ(std::ranges::count(glCalls(), GlCall::Write), 0);
    EXPECT_EQ(std::ranges::count(glCalls(), GlCall::Wait), 0);
}

}  // namespace
}  // namespace gfxrepro::reflections
