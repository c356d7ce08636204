// The G-buffer against rays of Embree through the pixels' centres.
#include "techniques/reflections/gbuffer.h"

#include <glm/gtc/matrix_transform.hpp>

#include "engine/image/srgb.h"
#include "engine/raycast/ray_tracer.h"
#include "tests/support/grid.h"
#include "tests/techniques/reflections/gl_calls.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

constexpr glm::ivec2 kBufferSize{96, 64};

/// A textured floor, seen from the side that its winding calls the back, and two turned, stretched
/// instances of a reflecting ball, one of them mirrored.
scene::Scene floorWithBalls() {
    scene::Scene scene;
    addPart(scene, squareMesh(), {.baseColorTexture = 0},
            glm::rotate(glm::mat4(1.0F), glm::radians(90.0F), {1, 0, 0}) *
                glm::scale(glm::mat4(1.0F), glm::vec3(3)));
    scene.textures = {randomImage(8, 8, 4)};
    addPart(scene, ballMesh(),
            {.baseColor = {1, 0.8F, 0.6F, 1}, .metallic = 0.7F, .roughness = 0.1F});
    scene.instances.push_back(scene.instances.back());
    scene.lights = {{{1, 3, 2}, {0.7F, 0.6F, 0.5F}, 2.0F}, {{-2, 2, 0}, {0.2F, 0.4F, 0.5F}, 3.0F}};
    return scene;
}

std::vector<glm::mat4> ballPoses(const scene::Scene& scene) {
    const auto ball = [](const glm::vec3& at, float angle, const glm::vec3& size) {
        return glm::rotate(glm::translate(glm::mat4(1.0F), at), angle,
                           glm::normalize(glm::vec3(1, 2, 3))) *
               glm::scale(glm::mat4(1.0F), size);
    };
    return {scene.instances[0].worldFromMesh, ball({-1, 0.7F, 0}, 0.8F, {0.9F, 0.5F, 0.6F}),
            ball({1, 0.6F, 0.4F}, -1.9F, {0.6F, -0.8F, 0.4F})};
}

kit::View viewOfScene() {
    return kit::viewOf(
        {.position = {0.5F, 2.5F, 5.0F}, .target = {0, 0.5F, 0}, .nearM = 0.5F, .farM = 20.0F},
        kBufferSize);
}

struct GBufferTest : ReflectionsTest {
    GBufferTest() {
        objects.setPoses(ballPoses(scene));
        posed = prepared.scene();
        for (std::size_t i = 0; i < posed.instances.size(); ++i) {
            posed.instances[i].worldFromMesh = objects.poses()[i];
        }
        GBufferRenderer(shaders, prepared).render(objects, gbuffer);
    }

    scene::Scene scene = floorWithBalls();
    ReflectiveScene prepared{scene};
    GpuObjects objects{prepared};
    scene::Scene posed;
    GBuffer gbuffer{viewOfScene()};
};

TEST_F(GBufferTest, SeesWhatRaysMeet) {
    const HostGBuffer host = readGBuffer(gbuffer);
    const raycast::RayTracer rays(posed);
    int seen = 0, background = 0, elsewhere = 0, filtered = 0, ofReflector[3] = {};
    for (int y = 0; y < kBufferSize.y; ++y) {
        for (int x = 0; x < kBufferSize.x; ++x) {
            const glm::ivec2 pixel(x, y);
            const std::size_t i = host.indexOf(pixel);
            const glm::vec3 direction = rayThrough(host.view, glm::vec2(pixel) + 0.5F);
            const auto hit = rays.closestHit(host.view.eyeWorld, direction);
            if (!hit || host.depthM[i] == 0.0F) {
                if (hit.has_value() != (host.depthM[i] != 0.0F)) ++elsewhere;
                if (hit) continue;
                ++background;
                EXPECT_EQ(host.surface[i], 0U);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(host.diffuse[i][c], kBackground[c], 1e-3F);
                continue;
            }
            if (glm::distance(host.positionWorld(pixel), hit->position) > 1e-3F) {
                ++elsewhere;  // a pixel whose centre lies on an edge
                continue;
            }
            ++seen;
            const Object& object = prepared.objects()[hit->instance];
            ++ofReflector[host.reflector(i)];
            ASSERT_EQ(host.reflector(i), object.reflector);
            ASSERT_EQ(host.isReflective(i), object.reflector != 0);
            ASSERT_EQ(reflectivityOf(host, i), object.reflectivity);
            ASSERT_EQ(host.glossiness(i), object.glossiness);

            const glm::mat3 toWorld(glm::transpose(glm::inverse(objects.poses()[hit->instance])));
            glm::vec3 normal = glm::normalize(
                toWorld * prepared.normalMeshAt(hit->flattenedTriangle, hit->barycentric));
            if (glm::dot(normal, direction) > 0.0F) normal = -normal;
            // A silhouette's normal is across the view: which side is turned to it is rounding.
            if (std::abs(glm::dot(normal, direction)) > 1e-3F) {
                // Corners may lie on 256ths of a pixel.
                ASSERT_LE(glm::distance(host.normalWorld[i], normal), 3e-3F) << x << " " << y;
            }
            const glm::vec3 mirror = direction - 2.0F * glm::dot(direction, normal) * normal;
            ASSERT_LE(glm::distance(host.mirrorDirection(pixel), mirror), 6e-3F);

            // What the pixel covers: between the rays through it and through its neighbours.
            const auto toNeighbour = [&](const glm::vec2& offset) {
                return rayThrough(host.view, glm::vec2(pixel) + 0.5F + offset) - direction;
            };
            const float beamArea = std::abs(glm::dot(direction, glm::cross(toNeighbour({1, 0}),
                                                                           toNeighbour({0, 1})))) *
                                   hit->distance * hit->distance;
            const float footprint = prepared.footprintAt(
                hit->flattenedTriangle, objects.poses()[hit->instance], direction, beamArea);
            const glm::vec3 colour =
                shadeDiffuse(prepared.lights(), hit->position, normal,
                             prepared.albedoAt(hit->flattenedTriangle, hit->barycentric, footprint),
                             object.emissive);
            filtered += object.textureLayer >= 0 && footprint > 1.0F / 512.0F ? 1 : 0;
            for (int c = 0; c < 3; ++c) {
                // 10 bits, the sampler's 256ths of a texel, and 8 bits of what sRGB decodes to.
                ASSERT_NEAR(host.diffuse[i][c], colour[c], 6e-3F) << x << " " << y << " " << c;
            }
        }
    }
    EXPECT_LE(elsewhere, kBufferSize.x * kBufferSize.y / 500);
    EXPECT_GT(background, 500);
    EXPECT_GT(filtered, 500);
    EXPECT_GT(ofReflector[0], 500);
    EXPECT_GT(ofReflector[1], 300);
    EXPECT_GT(ofReflector[2], 300);
    EXPECT_EQ(seen + background + elsewhere, kBufferSize.x * kBufferSize.y);
}

TEST_F(GBufferTest, IsReadTheSameOnTheDevice) {
    const gl::Pass read = compute("gbuffer", "", R"(
    uint surface = texelFetch(gbufferSurface, pixel, 0).r;
    vec3 position = gbufferPosition(pixel);
    vec3 normal = gbufferUnitNormal(pixel);
    results[4 * i] = vec4(position, reflectorOf(surface));
    results[4 * i + 1] = vec4(normal, reflectivityOf(surface));
    results[4 * i + 2] = vec4(gbufferMirrorDirection(position, normal), glossinessOf(surface));
    results[4 * i + 3] = vec4(gbufferDiffuseAt(pixel), 1.0);)");
    const HostGBuffer host = readGBuffer(gbuffer);
    const auto results = computed(read, kBufferSize, 4, gbuffer.resourcesFor(read));
    for (const auto [y, x] : test::grid(kBufferSize.y, kBufferSize.x)) {
        const std::size_t i = host.indexOf({x, y});
        if (host.depthM[i] == 0.0F) continue;
        const glm::vec4* found = &results[4 * i];
        ASSERT_LE(glm::distance(glm::vec3(found[0]), host.positionWorld({x, y})), 1e-5F);
        ASSERT_EQ(found[0].w, static_cast<float>(host.reflector(i)));
        ASSERT_LE(glm::distance(glm::vec3(found[1]), host.normalWorld[i]), 1e-6F);
        ASSERT_NEAR(found[1].w, reflectivityOf(host, i), 1e-7F);
        ASSERT_LE(glm::distance(glm::vec3(found[2]), host.mirrorDirection({x, y})), 2e-6F);
        ASSERT_NEAR(found[2].w, host.glossiness(i), 1e-7F);
        ASSERT_EQ(glm::vec3(found[3]), host.diffuse[i]);
    }
}

// A hundredth of the light: steps of linear colours in 10 bits are three levels there.
TEST_F(GBufferTest, KeepsDarkColours) {
    scene::Scene dark = floorWithBalls();
    for (scene::Material& material : dark.materials) {
        material.baseColor = glm::vec4(0.01F * glm::vec3(material.baseColor), 1.0F);
    }
    const ReflectiveScene scene(dark);
    GpuObjects darkObjects(scene);
    darkObjects.setPoses(ballPoses(dark));
    GBufferRenderer(shaders, scene).render(darkObjects, gbuffer);
    const HostGBuffer host = readGBuffer(gbuffer);
    const raycast::RayTracer rays(posed);
    double sum = 0.0, most = 0.0;
    int count = 0;
    forEachReflective(host, [&](glm::ivec2 pixel, std::size_t i) {  // the balls have no texture
        const glm::vec3 direction = rayThrough(host.view, glm::vec2(pixel) + 0.5F);
        const auto hit = rays.closestHit(host.view.eyeWorld, direction);
        if (!hit || glm::distance(host.positionWorld(pixel), hit->position) > 1e-3F) return;
        const glm::vec3 colour =
            shadeDiffuse(scene.lights(), hit->position, host.normalWorld[i],
                         scene.albedoAt(hit->flattenedTriangle, hit->barycentric), {});
        for (int c = 0; c < 3; ++c) {
            const double off =
                255.0 * std::abs(image::srgbOf(host.diffuse[i][c]) - image::srgbOf(colour[c]));
            sum += off;
            most = std::max(most, off);
            ++count;
        }
    });
    EXPECT_GT(count, 1800);
    // Steps of 0.36 levels; llvmpipe rounds down.
    EXPECT_LE(most, 0.4);
    EXPECT_LE(sum / count, 0.2);
}

/// A square that fills the middle of the view, with a texture whose halves have one colour each.
scene::Scene halvedSquare(scene::Material material, const glm::u8vec3& left,
                          const glm::u8vec3& right) {
    scene::Scene scene;
    addPart(scene, squareMesh(), material);
    scene.textures = {imageOf([&](int x, int) { return x < 256 ? left : right; })};
    return scene;
}

/// Seen from the front, or from behind: the middles of the left and of the right half.
struct Halves {
    HostGBuffer host;
    std::size_t left, right;

    Halves(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene, float side = 1.0F) {
        GBuffer gbuffer(
            kit::viewOf({.position = {0, 0, 5.0F * side}, .target = {0, 0, 0}}, kBufferSize));
        GBufferRenderer(shaders, scene).render(GpuObjects(scene), gbuffer);
        host = readGBuffer(gbuffer);
        left = host.indexOf({kBufferSize.x / 2 - static_cast<int>(9 * side), kBufferSize.y / 2});
        right = host.indexOf({kBufferSize.x / 2 + static_cast<int>(9 * side), kBufferSize.y / 2});
    }
};

TEST_F(GBufferTest, TakesRoughnessAndMetalnessOfTexels) {
    // Left rougher than 0.4; right 0.8 · 102 / 255 = 81.6 / 255, and 0.5 · 200 / 255.
    ReflectiveScene scene(
        halvedSquare({.metallic = 0.5F, .roughness = 0.8F, .metallicRoughnessTexture = 0},
                     {0, 200, 255}, {0, 102, 200}));
    const Halves halves(shaders, scene);
    EXPECT_FALSE(halves.host.isReflective(halves.left));
    EXPECT_EQ(halves.host.surface[halves.left], 0U);
    EXPECT_EQ(halves.host.reflector(halves.right), 1);
    EXPECT_EQ(reflectivityOf(halves.host, halves.right), 100.0F / 255.0F);
    EXPECT_EQ(halves.host.glossiness(halves.right), 82.0F / 255.0F);
    scene.setGlossiness(0.2F);
    const Halves one(shaders, scene);
    EXPECT_FALSE(one.host.isReflective(one.left));
    EXPECT_EQ(one.host.glossiness(one.right), 51.0F / 255.0F);
}

TEST_F(GBufferTest, BendsNormalsByTheirTexture) {
    // To the right along u, and upwards against v.
    const ReflectiveScene scene(
        halvedSquare({.roughness = 0.0F, .normalTexture = 0}, {255, 128, 255}, {128, 255, 255}));
    for (const float side : {1.0F, -1.0F}) {
        const Halves halves(shaders, scene, side);
        // From behind the frame is turned round; 128 is 1/255.
        EXPECT_LT(glm::distance(halves.host.normalWorld[halves.left],
                                side * glm::normalize(glm::vec3(1, 0, 1))),
                  0.01F);
        EXPECT_LT(glm::distance(halves.host.normalWorld[halves.right],
                                side * glm::normalize(glm::vec3(0, 1, 1))),
                  0.01F);
    }
}

TEST_F(GBufferTest, TintsEmissionByItsTexture) {
    const ReflectiveScene scene(halvedSquare(
        {.baseColor = {0, 0, 0, 1}, .emissive = {0.5F, 0.5F, 0.5F}, .emissiveTexture = 0},
        {255, 0, 0}, {0, 0, 188}));  // 188: 0.503 in linear light
    const Halves halves(shaders, scene);
    const auto expectNear = [](const glm::vec3& actual, const glm::vec3& expected) {
        EXPECT_LT(glm::distance(actual, expected), 0.003F) << actual.x << " " << actual.z;
    };
    expectNear(halves.host.diffuse[halves.left], {0.5F, 0, 0});
    expectNear(halves.host.diffuse[halves.right], {0, 0, 0.2515F});
}

TEST_F(GBufferTest, ClearsWhatWasThere) {
    std::vector<glm::mat4> away = ballPoses(scene);
    for (glm::mat4& pose : away) pose = glm::translate(glm::mat4(1.0F), {0, 0, 50}) * pose;
    objects.setPoses(away);
    GBufferRenderer(shaders, prepared).render(objects, gbuffer);
    const HostGBuffer host = readGBuffer(gbuffer);
    EXPECT_EQ(host.depthM, std::vector<float>(host.depthM.size(), 0.0F));
    EXPECT_EQ(host.surface, std::vector<std::uint32_t>(host.surface.size(), 0U));
}

TEST_F(GBufferTest, DrawsSomeObjectsOnly) {
    const gl::Pass draw(shaders,
                        {"reflections/surface.vert.glsl", "reflections/environment_map.frag.glsl"},
                        surfaceDefines(prepared));
    const gl::SampleQuery query;
    const auto samplesOf = [&](std::vector<std::uint32_t> drawn) {
        const gl::Texture colour = gl::Texture::make2D(GL_RGBA8, kBufferSize);
        const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 1>{&colour});
        framebuffer.bind();
        glDisable(GL_DEPTH_TEST);
        draw.set("clipFromWorld", gbuffer.view.clipFromWorld());
        draw.set("eyeWorld", gbuffer.view.eyeWorld);
        draw.use(objects.resources());
        query.begin();
        objects.draw(drawn);
        query.end();
        return query.result();
    };
    const std::uint64_t first = samplesOf({1});
    EXPECT_GT(first, 300U);
    EXPECT_EQ(samplesOf({1, 2}), first + samplesOf({2}));
    EXPECT_EQ(samplesOf({}), 0U);
}

TEST_F(GBufferTest, DrawsAreSplitWhereTheDeviceAsksForItOnly) {
    scene::Scene source;
    scene::Mesh large = squareMesh();
    large.triangles.resize(100'000, large.triangles.front());
    addPart(source, large, {});
    const ReflectiveScene many(source);
    const GBufferRenderer renderer(shaders, many);
    using enum GlCall;
    const auto callsOf = [&](bool splitsDraws) {
        const GpuObjects drawn(many, splitsDraws);
        GBuffer target(viewOfScene());
        glCalls().clear();
        renderer.render(drawn, target);
        std::vector<GlCall> calls = glCalls();
        std::erase_if(calls, [](GlCall c) { return c != DrawObject && c != Flush; });
        return calls;
    };
    EXPECT_EQ(callsOf(false), std::vector{DrawObject});
    EXPECT_EQ(callsOf(true), (std::vector{DrawObject, Flush, DrawObject}));
}

}  // namespace
}  // namespace gfxrepro::reflections
