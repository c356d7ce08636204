// Environment maps in a room whose walls glow in known colours.

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/image/srgb.h"
#include "tests/techniques/reflections/environment_on_host.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflections {
namespace {

const scene::Box kWalls{glm::vec3(-2.0F, -1.0F, -3.0F), glm::vec3(2.0F, 1.0F, 3.0F)};
constexpr glm::vec3 kCentre{0.5F, -0.2F, 0.7F};  // of the map
constexpr glm::vec3 kMirror{1.2F, 0.2F, -2.5F};
/// Of the walls, as addRoom() counts them; all channels black or full.
constexpr glm::vec3 kColors[6] = {{0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};

/// A mirror hangs in the room, behind the map's centre.
scene::Scene room(float mirrorRoughness = 0.0F) {
    std::vector<scene::Material> walls;
    for (const glm::vec3& color : kColors) walls.push_back(glowing(color));
    scene::Scene scene;
    addRoom(scene, kWalls, walls);
    scene::Material material = glowing(glm::vec3(0.0F));
    material.metallic = 1.0F;
    material.roughness = mirrorRoughness;
    addPart(scene, squareMesh(), material,
            glm::scale(glm::translate(glm::mat4(1.0F), kMirror), glm::vec3(0.4F)));
    return scene;
}

/// From inside, straight to a wall.
glm::vec3 towards(int side) {
    glm::vec3 direction(0.0F);
    direction[side / 2] = side % 2 == 0 ? -1.0F : 1.0F;
    return direction;
}

bool isTowardsMirror(const glm::vec3& direction) {
    const float time = (kMirror.z - kCentre.z) / direction.z;
    const glm::vec3 at = kCentre + time * direction - kMirror;
    return time > 0.0F && std::max(std::abs(at.x), std::abs(at.y)) < 0.45F;
}

struct EnvironmentMapTest : ReflectionsTest {
    EnvironmentMap drawn(const scene::Scene& source, const glm::vec3& centre = kCentre) const {
        const ReflectiveScene scene(source);
        EnvironmentMap map(shaders, scene, centre);
        map.render(GpuObjects(scene));
        return map;
    }
};

TEST_F(EnvironmentMapTest, ShowsTheWallsInTheirDirections) {
    const EnvironmentMap map = drawn(room());
    const HostEnvironment host(map);
    std::vector<glm::vec4> directions;
    for (int side = 0; side < 6; ++side) {
        EXPECT_EQ(host.radianceFrom(towards(side)), kColors[side]) << side;
        directions.emplace_back(towards(side), 0);
    }
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 unit = randomUnit(random);
        const glm::vec3 direction = unit * random.uniform(0.1F, 10.0F);
        directions.emplace_back(direction, 0);
        const WallHit hit = wallHit(kWalls, kCentre, direction);
        // Within a texel of an edge either wall may be seen.
        if (hit.edgeDistanceM < 0.03 || isTowardsMirror(direction)) continue;
        EXPECT_EQ(host.radianceFrom(direction), kColors[hit.side]) << i;
    }

    // The device samples the same texels, but where a direction passes between two.
    const gl::Pass read = compute("environment", "vec4 direction;", R"(
    results[i] = vec4(radianceFrom(inputs[i].direction.xyz), 1.0);)");
    const auto found = computed(read, directions, 1, map.resources());
    int different = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (glm::vec3(found[i]) != host.radianceFrom(glm::vec3(directions[i]))) ++different;
    }
    EXPECT_LE(different, 3);
}

// Half way between steps of linear colours in 10 bits: those are 1.6 levels off there.
TEST_F(EnvironmentMapTest, KeepsDarkColours) {
    scene::Scene dark = room();
    const auto colourOf = [](int side) { return (static_cast<float>(side) + 0.5F) / 1023.0F; };
    for (int side = 0; side < 6; ++side) {
        dark.materials[static_cast<std::size_t>(side)].emissive = glm::vec3(colourOf(side));
    }
    const HostEnvironment host(drawn(dark));
    for (int side = 0; side < 6; ++side) {
        const float kept = host.radianceFrom(towards(side)).x;
        EXPECT_LE(255.0 * std::abs(image::srgbOf(kept) - image::srgbOf(colourOf(side))), 0.4)
            << side;  // steps of 0.36 levels; llvmpipe rounds down
    }
}

TEST_F(EnvironmentMapTest, ShowsTheBackgroundWhereNothingIs) {
    scene::Scene open = room();
    open.instances.resize(4);  // without the walls at ±z, and the mirror
    const HostEnvironment host(drawn(open, glm::vec3(0.0F)));
    EXPECT_EQ(host.radianceFrom({1, 0, 0}), kColors[1]);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(host.radianceFrom({0, 0, 1})[c], kBackground[c],
                    std::sqrt(kBackground[c]) / 1023.0F + 1e-6F);
    }
}

struct EnvironmentTracerTest : ReflectionsTest {
    /// The mirror, seen from the middle of the room.
    Prepared prepared(float mirrorRoughness = 0.0F) const {
        return {shaders,
                room(mirrorRoughness),
                {.position = {0.0F, 0.1F, 0.0F}, .target = kMirror, .verticalFovRad = 0.4F},
                {32, 24}};
    }
};

TEST_F(EnvironmentTracerTest, TakesTheMeanOfTheMapOverTheLobe) {
    const LobeSettings lobe;
    for (const float roughness : {0.0F, 0.4F}) {
        Prepared mirror = prepared(roughness);
        EnvironmentTracer tracer(shaders, mirror.map, lobe, mirror.scene.diagonalM());
        tracer.update(mirror.objects, profiler);
        ReflectionTarget target(mirror.gbuffer.view.sizePx);
        tracer.trace(mirror.gbuffer, nullptr, target, profiler);

        const HostGBuffer host = readGBuffer(mirror.gbuffer);
        const HostEnvironment environment(mirror.map);
        const auto radiance = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        int different = 0;
        const int reflective = forEachReflective(host, [&](glm::ivec2 pixel, std::size_t i) {
            const float g = host.glossiness(i);
            const int count = raysOf(lobe, g);
            glm::vec3 sum(0.0F);
            for (int ray = 0; ray < count; ++ray) {
                sum += environment.radianceFrom(
                    lobeDirection(lobe, host.mirrorDirection(pixel), g, ray, count));
            }
            // Rays between two texels of an edge fall to either side.
            const glm::vec3 mean = sum / static_cast<float>(count);
            different += glm::distance(glm::vec3(radiance[i]), mean) > 2e-3F ? 1 : 0;
            EXPECT_EQ(radiance[i].a, 1.0F);
        });
        EXPECT_GT(reflective, 100);
        EXPECT_LE(different, reflective / 50) << roughness;
    }
}

TEST_F(EnvironmentTracerTest, FollowsMovedObjects) {
    Prepared mirror = prepared();
    EnvironmentTracer tracer(shaders, mirror.map, {}, mirror.scene.diagonalM());
    const auto passesOfUpdate = [&] {
        tracer.update(mirror.objects, profiler);
        return profiler.collect().size();
    };
    EXPECT_EQ(passesOfUpdate(), 1U);
    EXPECT_EQ(HostEnvironment(mirror.map).radianceFrom({1, 0, 0}), kColors[1]);
    EXPECT_EQ(passesOfUpdate(), 0U);
    std::vector<glm::mat4> poses(mirror.objects.poses().begin(), mirror.objects.poses().end());
    for (const std::size_t side : {0U, 1U}) {
        poses[side] = glm::rotate(poses[side], glm::pi<float>(), {0, 1, 0});
    }
    mirror.objects.setPoses(poses);
    EXPECT_EQ(passesOfUpdate(), 1U);
    EXPECT_EQ(HostEnvironment(mirror.map).radianceFrom({1, 0, 0}), kColors[0]);
}

}  // namespace
}  // namespace gfxrepro::reflections
