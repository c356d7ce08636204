// The device's ray tracer against Embree's.
#include "techniques/reflections/gpu_ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/files.h"
#include "engine/scene/animation.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/reflections/embree_tracer.h"
#include "tests/gl/gl_fixture.h"
#include "tests/techniques/reflections/gl_calls.h"

namespace gfxrepro::reflections {
namespace {

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

/// Of the samples that reflect.
struct Comparison {
    std::uint32_t samples = 0, mismatches = 0;
    double radianceError = 0.0;  // mean absolute
};

class GpuRayTracerTest : public test::GlTest {
  protected:
    static constexpr glm::ivec2 kSizePx{129, 95};  // no multiple of a group's

    /// Both tracers over the scene in its pose at `time`.
    Comparison compared(const scene::Scene& from, const LobeSettings& lobe, float glossiness,
                        double time = 0.0) {
        ReflectiveScene scene(from);
        if (glossiness >= 0.0F) scene.setGlossiness(glossiness);
        GpuObjects objects(scene);
        EnvironmentMap map(shaders_, scene);
        map.render(objects);
        objects.setPoses(scene::posesAt(scene.scene(), time));
        GBuffer gbuffer(kit::viewOf(from.cameras.front(), kSizePx));
        GBufferRenderer(shaders_, scene).render(objects, gbuffer);
        ReflectionTarget target(kSizePx);
        GpuRayTracer tracer(shaders_, objects, map, lobe, scene.diagonalM());
        tracer.update(objects, profiler_);
        tracer.trace(gbuffer, nullptr, target, profiler_);
        EmbreeTracer embree(shaders_, scene, map, lobe);
        embree.update(objects, profiler_);
        const HostGBuffer host = readGBuffer(gbuffer);
        const std::vector<TracedSample> truth = embree.trace(host);

        const auto distances = target.distance.read<float>(GL_RED, GL_FLOAT, 1);
        const auto radiances = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        // Rays start off their surface; hits nearer than that apart are told apart by rounding.
        const float roundingM = 0.1F * EmbreeTracer::kStart * scene.diagonalM();
        Comparison result;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (!host.isReflective(i)) continue;
            ++result.samples;
            const float a = truth[i].distanceM, b = distances[i];
            const bool isMatch =
                (a > 0.0F) == (b > 0.0F) && std::abs(a - b) <= 1e-4F * std::max(a, b) + roundingM;
            result.mismatches += isMatch ? 0 : 1;
            const glm::vec3 error = glm::abs(glm::vec3(radiances[i]) - truth[i].radiance);
            result.radianceError += static_cast<double>(error.x + error.y + error.z) / 3.0;
        }
        result.radianceError /= std::max(result.samples, 1U);
        return result;
    }
    static void expectEmbrees(const Comparison& result) {
        EXPECT_GT(result.samples, 3000U);
        EXPECT_LE(result.mismatches, result.samples / 2000);  // grazes of edges
        EXPECT_LT(result.radianceError, 5e-4);
    }

    gl::ShaderLibrary shaders_{dataFolder("shaders")};
    gl::Profiler profiler_{true};
};

TEST_F(GpuRayTracerTest, MeetsWhatEmbreeMeetsInMirrors) {
    expectEmbrees(compared(mirrors(), {}, 0.0F));
}

TEST_F(GpuRayTracerTest, ShadesLobesAsEmbreeDoes) {
    for (const float glossiness : {-1.0F, 0.1F, 1.0F}) {
        SCOPED_TRACE(glossiness);
        expectEmbrees(compared(mirrors(), {}, glossiness));
    }
    expectEmbrees(compared(mirrors(), {.rays = 5}, 0.3F));
}

/// Floor and boxes with textures for everything; a mirrored instance among them.
scene::Scene texturedMirrors() {
    scene::Scene scene = mirrors();
    const auto image = [](const auto& texel) {
        image::Image8 result(512, 512, 3);
        for (int y = 0; y < 512; ++y) {
            for (int x = 0; x < 512; ++x) {
                const glm::vec3 value =
                    texel(6.2831853F * glm::vec2(x, y) / 128.0F);  // smooth: samplers round weights
                for (int c = 0; c < 3; ++c) {
                    result.at(x, y, c) = static_cast<std::uint8_t>(127.5F + 127.0F * value[c]);
                }
            }
        }
        return result;
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
    for (const float glossiness : {-1.0F, 0.0F}) {
        SCOPED_TRACE(glossiness);
        const Comparison result = compared(texturedMirrors(), {}, glossiness);
        // The floor reflects where its texels are smooth: less than half of what it is.
        EXPECT_GT(result.samples, 1000U);
        EXPECT_LT(result.samples, compared(mirrors(), {}, 0.0F).samples);
        EXPECT_LE(result.mismatches, result.samples / 1000);
        // Samplers weigh texels in 256ths.
        EXPECT_LT(result.radianceError, 2e-3);
    }
}

TEST_F(GpuRayTracerTest, FollowsMovedObjects) {
    expectEmbrees(compared(mirrors(), {}, 0.0F, 0.7));
}

// A sample that is not wanted keeps what the target had.
TEST_F(GpuRayTracerTest, TracesOnlyWhatIsWanted) {
    const ReflectiveScene scene(mirrors());
    GpuObjects objects(scene);
    EnvironmentMap map(shaders_, scene);
    map.render(objects);
    const glm::ivec2 size(65, 47);  // no multiple of a group's
    GBuffer gbuffer(kit::viewOf(scene.scene().cameras.front(), size));
    GBufferRenderer(shaders_, scene).render(objects, gbuffer);
    GpuRayTracer tracer(shaders_, objects, map, {}, scene.diagonalM());
    ReflectionTarget all(size), some(size);
    some.radiance.clearToZero();
    gl::Texture wanted = gl::Texture::make2D(GL_R8UI, size);
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(size.x * size.y));
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = i % 3 == 0 ? 1 : 0;
    wanted.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, mask.data());
    tracer.update(objects, profiler_);
    tracer.trace(gbuffer, nullptr, all, profiler_);
    tracer.trace(gbuffer, &wanted, some, profiler_);

    const auto host = readGBuffer(gbuffer);
    const auto allRadiance = all.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    const auto someRadiance = some.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    std::uint32_t traced = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        const bool isTraced = host.isReflective(i) && mask[i] != 0;
        traced += isTraced;
        ASSERT_EQ(someRadiance[i], isTraced ? allRadiance[i] : glm::vec4(0.0F)) << i;
    }
    EXPECT_GT(traced, 100U);

    wanted.clearToZero();
    some.radiance.clearToZero();
    tracer.trace(gbuffer, &wanted, some, profiler_);
    for (const glm::vec4& radiance : some.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1)) {
        ASSERT_EQ(radiance, glm::vec4(0.0F));
    }
}

// What the device may still be reading, of the last frame, is not written to by the host: that
// would wait for it.
TEST_F(GpuRayTracerTest, TheHostNeitherWritesNorWaitsWhileItTraces) {
    const ReflectiveScene scene(mirrors());
    GpuObjects objects(scene);
    EnvironmentMap map(shaders_, scene);
    GBuffer gbuffer(kit::viewOf(scene.scene().cameras.front(), kSizePx));
    GBufferRenderer(shaders_, scene).render(objects, gbuffer);
    GpuRayTracer tracer(shaders_, objects, map, {}, scene.diagonalM());
    tracer.update(objects, profiler_);
    ReflectionTarget target(kSizePx);
    gl::Profiler untimed(false);
    tracer.trace(gbuffer, nullptr, target, untimed);
    glCalls().clear();
    tracer.trace(gbuffer, nullptr, target, untimed);
    EXPECT_GT(std::ranges::count(glCalls(), GlCall::Barrier), 0);
    EXPECT_EQ(std::ranges::count(glCalls(), GlCall::Write), 0);
    EXPECT_EQ(std::ranges::count(glCalls(), GlCall::Wait), 0);
}

}  // namespace
}  // namespace gfxrepro::reflections
