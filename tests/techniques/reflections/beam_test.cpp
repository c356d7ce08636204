// What reflected rays cover on their way: beam.glsl, HostGBuffer::beam() and what planes and balls
// do.

#include <glm/gtc/matrix_transform.hpp>

#include "techniques/reflections/gbuffer.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

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
