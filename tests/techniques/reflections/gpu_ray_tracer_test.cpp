// The device's ray tracer against Embree's.
#include "techniques/reflections/gpu_ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/animation.h"
#include "tests/techniques/reflections/gl_calls.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflections {
namespace {

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
