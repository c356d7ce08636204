// The glossy lobe and octahedral directions: shaders against the host, and what both should be.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/reflection_tracer.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

struct Input {
    glm::vec4 directionAndGlossiness, indexAndDistance;
};

TEST_F(ReflectionsTest, SpreadsRaysAsTheHostDoes) {
    constexpr float kDiagonalM = 7.0F;
    Random random(11);
    std::vector<Input> inputs;
    for (int i = 0; i < 500; ++i) {
        glm::vec3 direction = randomUnit(random);
        if (i % 50 == 1) direction = {0, 0, i % 100 == 1 ? -1 : 1};  // the frame's poles
        const float glossiness = i % 10 == 0 ? 0.0F : random.uniform(0.01F, 0.99F);
        inputs.push_back(
            {{direction, glossiness},
             {static_cast<float>(random.index(49)), random.uniform(0.0F, 5.0F), 0, 0}});
    }
    const gl::Pass pass = compute("lobe", "vec4 directionAndGlossiness, indexAndDistance;", R"(
    vec4 mirror = inputs[i].directionAndGlossiness, place = inputs[i].indexAndDistance;
    int count = raysOf(mirror.w);
    results[2 * i] = vec4(lobeDirection(mirror.xyz, mirror.w, int(place.x) % count, count), count);
    results[2 * i + 1] = vec4(farPlane(mirror.w), fadeOf(mirror.w, place.y), 0.0, 0.0);)");
    for (const LobeSettings& lobe : {LobeSettings{}, LobeSettings{16, 0.3F, 2.0F}}) {
        setLobe(pass, lobe, kDiagonalM);
        const auto results = computed(pass, inputs, 2);
        int faded = 0;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const float glossiness = inputs[i].directionAndGlossiness.w;
            const int count = raysOf(lobe, glossiness);
            const int index = static_cast<int>(inputs[i].indexAndDistance.x) % count;
            const glm::vec3 direction = lobeDirection(
                lobe, glm::vec3(inputs[i].directionAndGlossiness), glossiness, index, count);
            ASSERT_EQ(results[2 * i].w, static_cast<float>(count)) << i;
            // GLSL asks no accuracy of sines and powers; llvmpipe's are polynomials.
            ASSERT_LE(glm::distance(glm::vec3(results[2 * i]), direction), 2e-5F) << i;
            const float farM = farPlaneM(lobe, glossiness, kDiagonalM);
            ASSERT_NEAR(results[2 * i + 1].x, farM, 1e-4F * kDiagonalM) << i;
            const float fade = fadeOf(lobe, glossiness, inputs[i].indexAndDistance.y, kDiagonalM);
            if (farM < 0.01F) continue;  // the power's error is of the size of the far plane
            ASSERT_NEAR(results[2 * i + 1].y, fade, 5e-3F) << i;
            faded += fade > 0.0F && fade < 1.0F ? 1 : 0;
        }
        EXPECT_GT(faded, 20);  // not all in the clamped ends
    }
}

TEST(LobeTest, NumbersItsRays) {
    EXPECT_EQ(raysOf({}, 0.0F), 1);
    EXPECT_EQ(raysOf({}, 1e-4F), 8);
    EXPECT_EQ(raysOf({}, 0.5F), 29);
    EXPECT_EQ(raysOf({}, 1.0F), 49);
    EXPECT_EQ(raysOf({.rays = 20}, 0.5F), 20);
    EXPECT_EQ(raysOf({.rays = 20}, 0.0F), 1);
}

TEST(LobeTest, FillsItsConeEvenly) {
    Random random(7);
    for (int trial = 0; trial < 20; ++trial) {
        const glm::vec3 mirror = randomUnit(random);
        const float glossiness = random.uniform(0.1F, 1.0F);
        const LobeSettings lobe;
        const float halfAngle = glossiness * lobe.maxHalfAngleRad;
        const float cone = 1.0F - std::cos(halfAngle);  // solid angle over 2π
        constexpr int kRays = 48;
        const glm::vec3 across = glm::normalize(glm::cross(mirror, randomUnit(random)));
        const glm::vec3 other = glm::cross(mirror, across);
        int inRing[4] = {}, inQuadrant[4] = {};
        for (int i = 0; i < kRays; ++i) {
            const glm::vec3 ray = lobeDirection(lobe, mirror, glossiness, i, kRays);
            ASSERT_NEAR(glm::length(ray), 1.0F, 1e-6F);
            const float share = (1.0F - glm::dot(ray, mirror)) / cone;  // of the solid angle
            ASSERT_GE(share, 0.0F);
            ASSERT_LE(share, 1.0F);
            ++inRing[std::min(static_cast<int>(4.0F * share), 3)];
            ++inQuadrant[(glm::dot(ray, across) > 0.0F ? 1 : 0) +
                         (glm::dot(ray, other) > 0.0F ? 2 : 0)];
        }
        for (const int count : inRing) EXPECT_EQ(count, kRays / 4);
        for (const int count : inQuadrant) EXPECT_NEAR(count, kRays / 4, 2);
    }
    const glm::vec3 mirror = randomUnit(random);
    EXPECT_EQ(lobeDirection({}, mirror, 0.0F, 0, 1), mirror);
}

TEST(LobeTest, FadesOverTheLastThirdOfTheWay) {
    const LobeSettings lobe{.farExponent = 2.0F};
    const float farM = farPlaneM(lobe, 0.5F, 12.0F);
    EXPECT_EQ(farM, 3.0F);
    EXPECT_EQ(fadeOf(lobe, 0.5F, 1.9F, 12.0F), 1.0F);
    EXPECT_NEAR(fadeOf(lobe, 0.5F, 2.5F, 12.0F), 0.5F, 1e-6F);
    EXPECT_EQ(fadeOf(lobe, 0.5F, 3.1F, 12.0F), 0.0F);
    EXPECT_EQ(fadeOf(lobe, 0.0F, 100.0F, 12.0F), 1.0F);  // mirrors do not
}

TEST_F(ReflectionsTest, KeepsDirectionsInTwoNumbers) {
    Random random(5);
    std::vector<glm::vec4> directions;
    for (int i = 0; i < 400; ++i) directions.emplace_back(randomUnit(random), 0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec4 unit(0.0F);
        for (const float sign : {1.0F, -1.0F}) {
            unit[axis] = sign;
            directions.push_back(unit);
        }
    }
    const gl::Pass pass = compute("octahedral", "vec4 unit;", R"(
    vec2 e = octahedralFromUnit(inputs[i].unit.xyz);
    float outside = max(max(abs(e.x), abs(e.y)) - 1.0, 0.0);
    results[i] = vec4(unitFromOctahedral(e), outside);)");
    const auto results = computed(pass, directions, 1);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        EXPECT_LE(glm::distance(results[i], directions[i]), 1e-6F) << i;
    }
}

// What reflected rays cover on their way: beam.glsl, HostGBuffer::beam() and what planes and balls
// do.

constexpr glm::ivec2 kSize{97, 65};  // the view's axis is a pixel's middle
constexpr glm::ivec2 kMiddle = kSize / 2;

struct BeamTest : ReflectionsTest {
    /// The middle of the view, 4 m away, is a mirror around the origin.
    GBuffer mirrorSeen(scene::Mesh mesh, float tiltRad = 0.0F) const {
        scene::Scene source;
        addPart(source, std::move(mesh), {.metallic = 1.0F, .roughness = 0.0F},
                glm::rotate(glm::mat4(1.0F), tiltRad, {0, 1, 0}));
        const ReflectiveScene scene(source);
        GBuffer gbuffer(kit::viewOf(
            {.position = {0, 0, 4}, .target = {0, 0, 0}, .nearM = 0.1F, .farM = 10.0F}, kSize));
        GBufferRenderer(shaders, scene).render(GpuObjects(scene), gbuffer);
        return gbuffer;
    }
    /// Between rays through the middle and the pixel beside it, a metre on.
    static float pitch(const HostGBuffer& host) {
        return glm::distance(rayThrough(host.view, glm::vec2(kMiddle) + 0.5F),
                             rayThrough(host.view, glm::vec2(kMiddle) + glm::vec2(1.5F, 0.5F)));
    }
};

TEST_F(BeamTest, IsTheSameOnTheDevice) {
    const gl::Pass read = compute("beam", "", R"(
    vec3 beam = beamOf(pixel);
    results[i] = vec4(beamArea(beam, 0.0), beamArea(beam, 0.5), beamArea(beam, 3.0), 0.0);)");
    const GBuffer gbuffer = mirrorSeen(ballMesh(), 0.4F);
    const HostGBuffer host = readGBuffer(gbuffer);
    const auto results = computed(read, kSize, 1, gbuffer.resourcesFor(read));
    const int reflective = forEachReflective(host, [&](glm::ivec2 pixel, std::size_t i) {
        const glm::vec3 beam = host.beam(pixel);
        int at = 0;
        for (const float distanceM : {0.0F, 0.5F, 3.0F}) {
            const float expected = beamArea(beam, distanceM);
            // Differences of directions to neighbours: a hundredth of them, to 2^-24.
            ASSERT_NEAR(results[i][at++], expected, 1e-3F * expected + 1e-6F)
                << pixel.x << " " << pixel.y << " " << distanceM;
        }
    });
    EXPECT_GT(reflective, 600);
}

TEST_F(BeamTest, OfAPlaneGrowsAsTheEyesDoes) {
    for (const float tiltRad : {0.0F, 0.6F, -1.0F}) {
        const HostGBuffer host = readGBuffer(mirrorSeen(squareMesh(), tiltRad));
        for (const float distanceM : {0.0F, 1.0F, 6.0F}) {
            const float side = pitch(host) * (4.0F + distanceM);
            EXPECT_NEAR(beamArea(host.beam(kMiddle), distanceM), side * side, 0.01F * side * side);
        }
    }
}

TEST_F(BeamTest, OfABallSpreads) {
    // The mirror's equation: a ball of radius 1, seen from 3 m, has the eye's image 3/7 m behind
    // its surface, where the beam comes from.
    const HostGBuffer host = readGBuffer(mirrorSeen(ballMesh()));
    for (const float distanceM : {0.0F, 1.0F, 6.0F}) {
        const float side = pitch(host) * 3.0F * (distanceM + 3.0F / 7.0F) / (3.0F / 7.0F);
        EXPECT_NEAR(beamArea(host.beam(kMiddle), distanceM), side * side, 0.05F * side * side);
    }
}

}  // namespace
}  // namespace gfxrepro::reflections
