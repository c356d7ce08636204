// Environment maps in a room whose walls glow in known colours.
#include "techniques/reflections/reflection_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/image/srgb.h"
#include "techniques/reflections/gbuffer.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

constexpr glm::vec3 kHalfSize{2.0F, 1.0F, 3.0F};
constexpr glm::vec3 kCentre{0.5F, -0.2F, 0.7F};  // of the map
/// Of the walls at +x, −x, +y, −y, +z, −z; all channels black or full.
constexpr glm::vec3 kColors[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};

/// The wall's square, which faces inwards, in its place.
glm::mat4 wallPose(int wall) {
    const int axis = wall / 2;
    const float side = wall % 2 == 0 ? 1.0F : -1.0F;
    glm::vec3 normal(0.0F), at(0.0F);
    normal[axis] = -side;
    at[axis] = side * kHalfSize[axis];
    glm::vec3 across(0.0F);
    across[(axis + 1) % 3] = 1.0F;
    const glm::vec3 up = glm::cross(normal, across);
    return glm::mat4(glm::vec4(across * kHalfSize, 0), glm::vec4(up * kHalfSize, 0),
                     glm::vec4(normal, 0), glm::vec4(at, 1));
}

/// With `opening`, the wall at +z is missing. A mirror hangs in the room, behind the map's centre.
scene::Scene room(bool isOpen = false, float mirrorRoughness = 0.0F) {
    scene::Scene scene;
    for (int wall = 0; wall < (isOpen ? 4 : 6); ++wall) {
        addPart(scene, squareMesh(), {.baseColor = {0, 0, 0, 1}, .emissive = kColors[wall]},
                wallPose(wall));
    }
    if (!isOpen) {
        addPart(scene, squareMesh(),
                {.baseColor = {0, 0, 0, 1}, .metallic = 1.0F, .roughness = mirrorRoughness},
                glm::scale(glm::translate(glm::mat4(1.0F), {1.2F, 0.2F, -2.5F}), glm::vec3(0.4F)));
    }
    return scene;
}

/// The wall that a ray from the map's centre meets, and how clear its point is of the edges.
struct Meeting {
    int wall = 0;
    float clearance = 0.0F;
};
Meeting meetingOf(const glm::vec3& direction) {
    float times[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float to = direction[axis] > 0.0F ? kHalfSize[axis] : -kHalfSize[axis];
        times[axis] = (to - kCentre[axis]) / direction[axis];
    }
    const int axis = static_cast<int>(std::min_element(times, times + 3) - times);
    const glm::vec3 at = kCentre + times[axis] * direction;
    Meeting meeting{2 * axis + (direction[axis] > 0.0F ? 0 : 1), 1.0F};
    for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
        meeting.clearance = std::min(meeting.clearance, kHalfSize[other] - std::abs(at[other]));
    }
    return meeting;
}

bool isTowardsMirror(const glm::vec3& direction) {
    const float time = (-2.5F - kCentre.z) / direction.z;
    const glm::vec3 at = kCentre + time * direction - glm::vec3(1.2F, 0.2F, -2.5F);
    return time > 0.0F && std::max(std::abs(at.x), std::abs(at.y)) < 0.45F;
}

using EnvironmentMapTest = ReflectionsTest;

TEST_F(EnvironmentMapTest, ShowsTheWallsInTheirDirections) {
    const ReflectiveScene scene(room());
    const GpuObjects objects(scene);
    EnvironmentMap map(shaders, scene, kCentre);
    map.render(objects);
    const EnvironmentMap::Host host = map.read();
    std::vector<glm::vec4> directions;
    for (int wall = 0; wall < 6; ++wall) {
        glm::vec3 direction(0.0F);
        direction[wall / 2] = wall % 2 == 0 ? 1.0F : -1.0F;
        EXPECT_EQ(host.radianceFrom(direction), kColors[wall]) << wall;
        directions.emplace_back(direction, 0);
    }
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 unit = randomUnit(random);
        const glm::vec3 direction = unit * random.uniform(0.1F, 10.0F);
        directions.emplace_back(direction, 0);
        const Meeting meeting = meetingOf(direction);
        // Within a texel of an edge either wall may be seen.
        if (meeting.clearance < 0.03F || isTowardsMirror(direction)) continue;
        EXPECT_EQ(host.radianceFrom(direction), kColors[meeting.wall]) << i;
    }

    // The device samples the same texels, but where a direction passes between two.
    const gl::Pass read = compute(R"(#version 450 core
#include "reflections/environment.glsl"
layout(local_size_x = 1) in;
layout(std430) readonly buffer Inputs { vec4 inputs[]; };
layout(std430) writeonly buffer Results { vec4 results[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    results[i] = vec4(radianceFrom(inputs[i].xyz), 1.0);
}
)");
    const gl::Buffer inputs = gl::Buffer::of(directions);
    const gl::Buffer results(directions.size() * sizeof(glm::vec4));
    read.dispatch({directions.size(), 1, 1},
                  gl::Resources{{"Inputs", inputs}, {"Results", results}}.with(map.resources()));
    const auto found = results.read<glm::vec4>(directions.size());
    int different = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (glm::vec3(found[i]) != host.radianceFrom(glm::vec3(directions[i]))) ++different;
    }
    EXPECT_LE(different, 3);
}

// Half way between steps of linear colours in 10 bits: those are 1.6 levels off there.
TEST_F(EnvironmentMapTest, KeepsDarkColours) {
    scene::Scene dark = room();
    const auto colourOf = [](int wall) { return (static_cast<float>(wall) + 0.5F) / 1023.0F; };
    for (int wall = 0; wall < 6; ++wall) {
        dark.materials[static_cast<std::size_t>(wall)].emissive = glm::vec3(colourOf(wall));
    }
    const ReflectiveScene scene(dark);
    const GpuObjects objects(scene);
    EnvironmentMap map(shaders, scene, kCentre);
    map.render(objects);
    const EnvironmentMap::Host host = map.read();
    for (int wall = 0; wall < 6; ++wall) {
        glm::vec3 direction(0.0F);
        direction[wall / 2] = wall % 2 == 0 ? 1.0F : -1.0F;
        const float kept = host.radianceFrom(direction).x;
        EXPECT_LE(255.0 * std::abs(image::srgbOf(kept) - image::srgbOf(colourOf(wall))), 0.4)
            << wall;  // steps of 0.36 levels; llvmpipe rounds down
    }
}

TEST_F(EnvironmentMapTest, ShowsTheBackgroundWhereNothingIs) {
    const ReflectiveScene scene(room(true));
    const GpuObjects objects(scene);
    EnvironmentMap map(shaders, scene, glm::vec3(0.0F));
    map.render(objects);
    const EnvironmentMap::Host host = map.read();
    EXPECT_EQ(host.radianceFrom({1, 0, 0}), kColors[0]);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(host.radianceFrom({0, 0, 1})[c], kBackground[c],
                    std::sqrt(kBackground[c]) / 1023.0F + 1e-6F);
    }
}

class EnvironmentTracerTest : public ReflectionsTest {
  protected:
    /// The mirror, seen from the middle of the room.
    static kit::View mirrorView() {
        scene::Camera camera;
        camera.position = {0.0F, 0.1F, 0.0F};
        camera.target = {1.2F, 0.2F, -2.5F};
        camera.verticalFovRad = 0.4F;
        return kit::viewOf(camera, {32, 24});
    }

    gl::Profiler profiler{true};
    LobeSettings lobe;
};

TEST_F(EnvironmentTracerTest, TakesTheMeanOfTheMapOverTheLobe) {
    for (const float roughness : {0.0F, 0.4F}) {
        const ReflectiveScene scene(room(false, roughness));
        const GpuObjects objects(scene);
        GBuffer gbuffer(mirrorView());
        GBufferRenderer(shaders, scene).render(objects, gbuffer);
        EnvironmentMap map(shaders, scene, kCentre);
        EnvironmentTracer tracer(shaders, map, lobe, scene.diagonalM());
        tracer.update(objects, profiler);
        ReflectionTarget target(gbuffer.view.sizePx);
        tracer.trace(gbuffer, nullptr, target, profiler);

        const HostGBuffer host = readGBuffer(gbuffer);
        const EnvironmentMap::Host environment = map.read();
        const auto radiance = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        int reflective = 0, different = 0;
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 32; ++x) {
                const std::size_t i = host.indexOf({x, y});
                if (!host.isReflective(i)) continue;
                ++reflective;
                const float g = host.glossiness(i);
                const int count = raysOf(lobe, g);
                glm::vec3 sum(0.0F);
                for (int ray = 0; ray < count; ++ray) {
                    sum += environment.radianceFrom(
                        lobeDirection(lobe, host.mirrorDirection({x, y}), g, ray, count));
                }
                // Rays between two texels of an edge fall to either side.
                if (glm::distance(glm::vec3(radiance[i]), sum / static_cast<float>(count)) >
                    2e-3F) {
                    ++different;
                }
                EXPECT_EQ(radiance[i].a, 1.0F);
            }
        }
        EXPECT_GT(reflective, 100);
        EXPECT_LE(different, reflective / 50) << roughness;
    }
}

TEST_F(EnvironmentTracerTest, LeavesAloneWhatIsNotWanted) {
    const ReflectiveScene scene(room());
    const GpuObjects objects(scene);
    GBuffer gbuffer(mirrorView());
    GBufferRenderer(shaders, scene).render(objects, gbuffer);
    EnvironmentMap map(shaders, scene, kCentre);
    EnvironmentTracer tracer(shaders, map, lobe, scene.diagonalM());
    tracer.update(objects, profiler);
    ReflectionTarget target(gbuffer.view.sizePx);
    target.radiance.clearToZero();
    gl::Texture wanted = gl::Texture::make2D(GL_R8UI, gbuffer.view.sizePx);
    const HostGBuffer host = readGBuffer(gbuffer);
    std::vector<std::uint8_t> isWanted(host.depthM.size());
    for (std::size_t i = 0; i < isWanted.size(); ++i) isWanted[i] = i % 5 == 0 ? 1 : 0;
    wanted.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, isWanted.data());
    tracer.trace(gbuffer, &wanted, target, profiler);
    const auto radiance = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    int written = 0;
    for (std::size_t i = 0; i < isWanted.size(); ++i) {
        const bool isExpected = isWanted[i] != 0 && host.isReflective(i);
        written += isExpected ? 1 : 0;
        EXPECT_EQ(radiance[i].a, isExpected ? 1.0F : 0.0F) << i;
    }
    EXPECT_GT(written, 20);
}

TEST_F(EnvironmentTracerTest, FollowsMovedObjects) {
    const ReflectiveScene scene(room());
    GpuObjects objects(scene);
    EnvironmentMap map(shaders, scene, kCentre);
    EnvironmentTracer tracer(shaders, map, lobe, scene.diagonalM());
    const auto passesOfUpdate = [&] {
        tracer.update(objects, profiler);
        return profiler.collect().size();
    };
    EXPECT_EQ(passesOfUpdate(), 1U);
    EXPECT_EQ(map.read().radianceFrom({1, 0, 0}), kColors[0]);
    EXPECT_EQ(passesOfUpdate(), 0U);
    std::vector<glm::mat4> poses(objects.poses().begin(), objects.poses().end());
    std::swap(poses[0], poses[1]);
    objects.setPoses(poses);
    EXPECT_EQ(passesOfUpdate(), 1U);
    EXPECT_EQ(map.read().radianceFrom({1, 0, 0}), kColors[1]);
}

}  // namespace
}  // namespace gfxrepro::reflections
