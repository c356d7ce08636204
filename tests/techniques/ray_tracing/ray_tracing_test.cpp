// The device's ray tracer against Embree's, and the technique as a whole.
#include "techniques/ray_tracing/ray_tracing.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "runner/scene/mesh_builder.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::ray_tracing {
namespace {

using test::errorText;

/// A mirror ball of `steps` × 2·steps quads with smooth normals.
void addBall(scene::MeshBuilder& builder, const glm::vec3& centre, float radius, int steps) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::uvec3> triangles;
    const int around = 2 * steps;
    for (int j = 0; j <= steps; ++j) {
        for (int i = 0; i <= around; ++i) {
            const float phi = 3.14159265F * static_cast<float>(j) / static_cast<float>(steps);
            const float theta = 3.14159265F * static_cast<float>(i) / static_cast<float>(steps);
            normals.emplace_back(std::sin(phi) * std::cos(theta), std::cos(phi),
                                 std::sin(phi) * std::sin(theta));
            positions.push_back(centre + radius * normals.back());
        }
    }
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < around; ++i) {
            const auto a = static_cast<unsigned>(j * (around + 1) + i);
            const auto b = a + static_cast<unsigned>(around) + 1;
            triangles.emplace_back(a, a + 1, b);
            triangles.emplace_back(a + 1, b + 1, b);
        }
    }
    builder.addIndexed(positions, normals, triangles);
}

/// A mirror floor and a mirror ball among coloured boxes; the boxes move.
scene::Scene mirrors() {
    scene::Scene scene;
    scene.name = "mirrors";
    scene.materials = {{.name = "plain"},
                       {.name = "mirror", .metallic = 1.0F, .roughness = 0.0F},
                       {.name = "glossy", .metallic = 0.9F, .roughness = 0.25F}};
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
    addBall(builder, {0, 0.9F, 0}, 0.8F, 24);
    scene.meshes.push_back(builder.take("ball", 2));
    scene.instances = {{.mesh = 0}, {.mesh = 1}, {.mesh = 2}};
    scene.motions = {{.instance = 0, .axis = {0, 1, 0}, .turnRad = 3.0F, .swing = {0, 0.5F, 0}}};
    scene::Camera camera;
    camera.name = "front";
    camera.position = {1.0F, 2.5F, 6.0F};
    camera.target = {0, 0.6F, 0};
    camera.verticalFovRad = 0.8F;
    scene.cameras = {camera};
    return scene;
}

class RayTracingTest : public test::TechniqueTest {
  protected:
    RayTracingTest() : TechniqueTest(kRayTracing, {64, 48}) {}
};

/// Mean absolute difference of two images' values.
double meanDifference(const image::ImageF& a, const image::ImageF& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        sum += std::abs(static_cast<double>(a.values()[i]) - static_cast<double>(b.values()[i]));
    }
    return sum / static_cast<double>(a.values().size());
}

TEST_F(RayTracingTest, MeetsWhatEmbreeMeetsInMirrors) {
    const scene::Scene scene = mirrors();
    const auto metrics = recorded("{glossiness: 0, errors: true}", &scene).metrics;
    EXPECT_GT(metrics.at("reflective_pct"), 30.0);
    EXPECT_EQ(metrics.at("rays"), std::round(metrics.at("reflective_pct") * 0.01 * 128 * 96));
    EXPECT_LE(metrics.at("mismatch_pct"), 0.05);  // grazes of edges
    EXPECT_LT(metrics.at("radiance_error"), 5e-4);
    EXPECT_EQ(metrics.at("nodes"), metrics.at("triangles") - 1);
    EXPECT_GT(metrics.at("memory_bytes"), metrics.at("triangles") * (64 + 48 + 16));
}

TEST_F(RayTracingTest, ShadesLobesAsEmbreeDoes) {
    const scene::Scene scene = mirrors();
    for (const char* yaml :
         {"{errors: true}", "{glossiness: 0.1, errors: true}",
          "{glossiness: 0.3, rays: 5, errors: true}", "{glossiness: 1, errors: true}"}) {
        const auto metrics = recorded(yaml, &scene).metrics;
        EXPECT_LE(metrics.at("mismatch_pct"), 0.05) << yaml;
        EXPECT_LT(metrics.at("radiance_error"), 5e-4) << yaml;
    }
    const auto five = recorded("{glossiness: 0.3, rays: 5}", &scene).metrics;
    const auto one = recorded("{glossiness: 0}", &scene).metrics;
    EXPECT_EQ(five.at("rays"), 5 * one.at("rays"));
}

TEST_F(RayTracingTest, FollowsMovedObjects) {
    const scene::Scene scene = mirrors();
    const auto still = recorded("{glossiness: 0}", &scene, 2, 3);
    const auto moved = recorded("{glossiness: 0, motion: true, errors: true}", &scene, 2, 3);
    EXPECT_LE(moved.metrics.at("mismatch_pct"), 0.05);
    EXPECT_GT(meanDifference(still.images.at("result"), moved.images.at("result")), 1e-3);
}

TEST_F(RayTracingTest, GivesEmbreesPicture) {
    const scene::Scene scene = mirrors();
    const auto compute = recorded("{}", &scene);
    EXPECT_EQ(passes_, (std::vector<std::string>{"first_pass", "bvh_build", "bvh_codes", "bvh_sort",
                                                 "bvh_hierarchy", "bvh_boxes", "ray_list",
                                                 "intersection", "composite"}));
    const auto embree = recorded("{method: embree}", &scene);
    EXPECT_EQ(passes_, (std::vector<std::string>{"first_pass", "bvh_build", "transfer",
                                                 "intersection", "composite"}));
    EXPECT_EQ(compute.metrics.at("rays"), embree.metrics.at("rays"));
    EXPECT_EQ(embree.metrics.count("memory_bytes"), 0U);
    EXPECT_LT(meanDifference(compute.images.at("result"), embree.images.at("result")), 5e-4);
}

// A sample that is not wanted keeps what the target had.
TEST_F(RayTracingTest, TracesOnlyWhatIsWanted) {
    const reflections::ReflectiveScene scene(mirrors());
    reflections::GpuObjects objects(scene);
    reflections::EnvironmentMap map(shaders_, scene.boundsWorld().centre());
    map.render(objects);
    const glm::ivec2 size(65, 47);  // no multiple of a group's
    reflections::GBuffer gbuffer(depth_images::viewOf(scene.scene().cameras.front(), size));
    reflections::GBufferRenderer(shaders_).render(objects, gbuffer);
    reflections::GpuRayTracer tracer(shaders_, objects, map, {}, scene.diagonalM());
    reflections::ReflectionTarget all(size), some(size);
    some.radiance.clearToZero();
    gl::Texture wanted = gl::Texture::make2D(GL_R8UI, size);
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(size.x * size.y));
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = i % 3 == 0 ? 1 : 0;
    wanted.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, mask.data());
    tracer.update(objects, profiler_);
    tracer.trace(gbuffer, nullptr, all, profiler_);
    tracer.trace(gbuffer, &wanted, some, profiler_);

    const auto host = reflections::readGBuffer(gbuffer);
    const auto allRadiance = all.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    const auto someRadiance = some.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    std::uint32_t expected = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        const bool isTraced = host.isReflective(i) && mask[i] != 0;
        expected += isTraced;
        ASSERT_EQ(someRadiance[i], isTraced ? allRadiance[i] : glm::vec4(0.0F)) << i;
    }
    EXPECT_GT(expected, 100U);
    EXPECT_EQ(tracer.lastCounts().samples, expected);

    wanted.clearToZero();
    tracer.trace(gbuffer, &wanted, some, profiler_);
    EXPECT_EQ(tracer.lastCounts().samples, 0U);
    EXPECT_EQ(tracer.lastCounts().rays, 0U);
}

TEST_F(RayTracingTest, TakesScenesWithoutReflectors) {
    scene::MeshBuilder builder;
    builder.addBox({0, 0, 0}, {1, 1, 1});
    const scene::Scene scene = scene::sceneOf(builder.take("box", -1));
    const auto metrics = recorded("{errors: true}", &scene).metrics;
    EXPECT_EQ(metrics.at("rays"), 0.0);
    EXPECT_EQ(metrics.at("mismatch_pct"), 0.0);
}

TEST_F(RayTracingTest, SaysWhatIsWrong) {
    const scene::Scene scene = mirrors();
    EXPECT_EQ(errorText([&] { recorded("{}", nullptr); }), "technique 'ray_tracing' needs a scene");
    EXPECT_EQ(errorText([&] { recorded("{view: back}", &scene); }),
              "the scene has no path or camera 'back'; paths: none; cameras: 'front'");
    EXPECT_EQ(errorText([&] { recorded("{glossiness: -0.5}", &scene); }),
              "case.yaml:1:14: technique 'ray_tracing': glossiness is -0.5; allowed: -1, 0 … 1");
    EXPECT_EQ(errorText([&] { recorded("{method: embree, errors: true}", &scene); }),
              "case.yaml:1:26: 'errors' needs 'method: compute'");
}

}  // namespace
}  // namespace gfxrepro::ray_tracing
