// shaders/shading.glsl and objects.glsl against surfaces.cpp: the same light everywhere.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "techniques/reflections/frame.h"
#include "tests/support/grid.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

struct ShadedPoint {
    glm::vec4 position, normal, color, texcoordAndObject;
};

/// Two triangles whose corners carry random colours and texture coordinates, twice: with a texture
/// and without.
scene::Scene litScene(Random& random) {
    scene::Scene scene;
    for (const int texture : {1, -1}) {
        scene::Mesh mesh = squareMesh();
        for (glm::vec2& texcoord : mesh.texcoords) texcoord = glm::vec2(randomIn(random, -2, 2));
        for (int i = 0; i < 4; ++i) mesh.colors.push_back(randomIn(random, 0, 1));
        addPart(scene, mesh,
                {.baseColor = {randomIn(random, 0, 1), 1},
                 .emissive = randomIn(random, 0, 0.2F),
                 .baseColorTexture = texture});
    }
    scene.textures = {randomImage(8, 8, 1), randomImage(64, 32, 2)};
    for (int i = 0; i < 3; ++i) {
        scene.lights.push_back(
            {randomIn(random, -2, 2), randomIn(random, 0, 1), random.uniform(0.2F, 3.0F)});
    }
    return scene;
}

class ShadesAsTheHostDoes : public ReflectionsTest, public testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(Samplings, ShadesAsTheHostDoes, testing::Range(0, 3));

TEST_P(ShadesAsTheHostDoes, AtAnyPoint) {
    Random random(3);
    scene::Scene lit = litScene(random);
    using Wrap = scene::Sampling::Wrap;
    const scene::Sampling samplings[] = {
        {}, {Wrap::Mirror, Wrap::Clamp, false}, {Wrap::Clamp, Wrap::Repeat, true}};
    lit.samplings = {{}, samplings[GetParam()]};
    const ReflectiveScene scene(lit);
    const GpuObjects objects(scene);
    std::vector<ShadedPoint> inputs;
    std::vector<glm::vec3> albedos, colours;
    for (int i = 0; i < 600; ++i) {
        const std::uint32_t triangle = random.index(4);
        const float b1 = random.uniform();
        const glm::vec2 b(b1, random.uniform(0.0F, 1.0F - b1));
        const glm::vec3 weights(1.0F - b.x - b.y, b);
        const glm::vec3 position = randomIn(random, -3, 3);
        const glm::vec3 normal = randomUnit(random);
        const ObjectGeometry& geometry = scene.geometry();
        glm::vec2 texcoord(0.0F);
        glm::vec3 color(0.0F);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = geometry.triangles[triangle][corner];
            texcoord += weights[corner] * geometry.texcoords[vertex];
            color += weights[corner] * geometry.colors[vertex];
        }
        const std::uint32_t object = geometry.objectOfTriangle[triangle];
        // From less than a texel to more than the texture.
        const float footprint = std::exp2(random.uniform(-12.0F, 2.0F));
        inputs.push_back({glm::vec4(position, 1), glm::vec4(normal, 0), glm::vec4(color, 0),
                          glm::vec4(texcoord, object, footprint)});
        albedos.push_back(scene.albedoAt(triangle, b, footprint));
        colours.push_back(shadeDiffuse(scene.lights(), position, normal, albedos.back(),
                                       scene.objects()[object].emissive));
    }
    const gl::Pass shade =
        compute("shading", "vec4 position, normal, color, texcoordAndObject;", R"(
    vec4 place = inputs[i].texcoordAndObject;
    Object object = objects[int(place.z)];
    vec3 albedo = albedoOf(object, place.xy, place.w, inputs[i].color.rgb);
    results[2 * i] = vec4(albedo, 0.0);
    results[2 * i + 1] = vec4(shadeDiffuse(inputs[i].position.xyz, inputs[i].normal.xyz, albedo,
                                           object.emissive.rgb), 0.0);)",
                surfaceDefines(scene));
    const auto results = computed(shade, inputs, 2, objects.resources());

    int withinRange = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        // Without a texture nothing but rounding differs. Samplers weigh texels in 256ths: between
        // black and white, half a 256th in either direction.
        const bool hasTexture = inputs[i].texcoordAndObject.z == 0.0F;
        const float tolerance = hasTexture ? 2.0F / 256.0F : 1e-6F;
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(results[2 * i][c], albedos[i][c], tolerance) << i << " " << c;
            // Four lights at most double an albedo's difference.
            ASSERT_NEAR(results[2 * i + 1][c], colours[i][c], 3.0F * tolerance) << i << " " << c;
            withinRange += colours[i][c] > 0.0F && colours[i][c] < 1.0F ? 1 : 0;
        }
    }
    EXPECT_GT(withinRange, 1500);  // of 1800: the test is not of clamped values
}

TEST_F(ReflectionsTest, PutsObjectsWhereTheyAre) {
    scene::Scene scene;
    addPart(scene, squareMesh(), {.metallic = 0.5F, .roughness = 0.2F});
    addPart(scene, squareMesh(), {});
    addPart(scene, squareMesh(), {.metallic = 1.0F, .roughness = 0.0F});
    const ReflectiveScene prepared(scene);
    GpuObjects objects(prepared);
    const glm::mat4 turned =
        glm::rotate(glm::translate(glm::mat4(1.0F), {5, 0, 0}), glm::radians(90.0F), {0, 1, 0}) *
        glm::scale(glm::mat4(1.0F), {2, 3, 4});
    const glm::mat4 mirrored = glm::scale(glm::mat4(1.0F), {1, 1, -1});
    objects.setPoses(std::array{turned, glm::mat4(1.0F), mirrored});
    // The square of ±2 × ±3 now stands across x at 5.
    const scene::Box box = objects.boundsWorld()[0];
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(box.min[axis], glm::vec3(5, -3, -2)[axis], 1e-5F);
        EXPECT_NEAR(box.max[axis], glm::vec3(5, 3, 2)[axis], 1e-5F);
    }

    const gl::Pass read = compute("objects", "", R"(
    results[3 * i] = vec4(normalize(mat3(objects[i].normalFromMesh) * vec3(0, 0, 1)),
                          objects[i].baseColor.r);
    results[3 * i + 1] = objects[i].worldFromMesh * vec4(1, 1, 0, 1);
    results[3 * i + 2] = vec4(objects[i].textureLayer, objects[i].layers.x,
                              objects[i].surface & 0xFFFFu, objects[i].surface >> 16);)",
                                  objectDefines());
    const auto values = computed(read, {3, 1}, 3, objects.resources());
    const auto expectNear = [&](std::size_t i, const glm::vec4& expected) {
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(values[i][c], expected[c], 1e-5F) << i << " " << c;
    };
    const float red = scene.materials[0].baseColor.r;
    expectNear(0, {1, 0, 0, red});
    expectNear(1, {5, 3, -2, 1});
    expectNear(2, {-1, -1, 1, 128 | 51 << 8});  // s and g in 255ths
    expectNear(3, {0, 0, 1, red});
    expectNear(5, {-1, -1, 0, 0});
    expectNear(6, {0, 0, -1, red});  // a mirrored outside is still outside
    expectNear(8, {-1, -1, 2, 255});
}

// Composite against its formula on the host.

constexpr glm::ivec2 kOutputSize{5, 3};

struct CompositeTest : ReflectionsTest {
    /// G-buffer and reflected colours of random values; every third sample reflects nothing, and
    /// its reflected colour is not a number.
    void fill(int supersampling) {
        const glm::ivec2 size = kOutputSize * supersampling;
        gbuffer.emplace(kit::viewOf({}, size));
        target.emplace(size);
        Random random(9);
        diffuse.clear();
        reflected.clear();
        surface.clear();
        std::vector<glm::vec2> normal;  // octahedral: every way, also turned from the eye
        std::vector<float> depth;
        for (int i = 0; i < size.x * size.y; ++i) {
            const bool reflects = i % 3 != 0;
            diffuse.emplace_back(randomIn(random, 0, 1), 1);
            reflected.emplace_back(reflects ? randomIn(random, 0, 2)
                                            : glm::vec3(std::numeric_limits<float>::quiet_NaN()),
                                   1);
            surface.push_back(0);
            if (reflects) {
                const std::uint32_t reflector = 1 + random.index(5);
                const std::uint32_t reflectivity = random.index(256);
                surface.back() = reflector | reflectivity << 16 | random.index(256) << 24;
            }
            normal.push_back({random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)});
            depth.push_back(random.uniform(0.5F, 5.0F));
        }
        gbuffer->diffuse.upload(GL_RGBA, GL_FLOAT, diffuse.data());
        gbuffer->normal.upload(GL_RG, GL_FLOAT, normal.data());
        gbuffer->depth.upload(GL_RED, GL_FLOAT, depth.data());
        gbuffer->surface.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, surface.data());
        target->radiance.upload(GL_RGBA, GL_FLOAT, reflected.data());
    }

    glm::vec3 expected(const HostGBuffer& host, glm::ivec2 pixel, int supersampling, Blend blend,
                       bool showsReflectionOnly) const {
        glm::vec3 sum(0.0F);
        for (const auto [dy, dx] : test::grid(supersampling, supersampling)) {
            const glm::ivec2 at = pixel * supersampling + glm::ivec2(dx, dy);
            const auto i = static_cast<std::size_t>(at.y * kOutputSize.x * supersampling + at.x);
            const glm::vec3 own = showsReflectionOnly ? glm::vec3(0) : host.diffuse[i];
            float s = static_cast<float>(surface[i] >> 16 & 0xFFU) / 255.0F;
            if (blend == Blend::Fresnel) {
                const glm::vec3 toEye = glm::normalize(host.view.eyeWorld - host.positionWorld(at));
                const float cosine = std::max(glm::dot(toEye, host.normalWorld[i]), 0.0F);
                s += (1.0F - s) * std::pow(1.0F - cosine, 5.0F);
            }
            if (showsReflectionOnly) s = 1.0F;
            sum += surface[i] == 0 ? own : (1.0F - s) * own + s * glm::vec3(reflected[i]);
        }
        return sum / static_cast<float>(supersampling * supersampling);
    }

    void expectComposed(int supersampling, Blend blend, bool showsReflectionOnly) const {
        const HostGBuffer host = readGBuffer(*gbuffer);
        Composite composite(shaders, kOutputSize, supersampling, blend);
        composite.render(*gbuffer, *target, showsReflectionOnly);
        const image::ImageF image = composite.read();
        ASSERT_EQ(image.channels(), 3);
        for (const auto [y, x] : test::grid(kOutputSize.y, kOutputSize.x)) {
            const glm::vec3 colour =
                expected(host, {x, y}, supersampling, blend, showsReflectionOnly);
            for (int c = 0; c < 3; ++c) {
                // 10 bits of the diffuse colour, 11 of each half-precision number.
                EXPECT_NEAR(image.at(x, kOutputSize.y - 1 - y, c), colour[c], 2e-3F)
                    << supersampling << " " << x << " " << y << " " << c;
            }
        }
    }

    std::optional<GBuffer> gbuffer;
    std::optional<ReflectionTarget> target;
    std::vector<glm::vec4> diffuse, reflected;
    std::vector<std::uint32_t> surface;
};

TEST_F(CompositeTest, BlendsByReflectivityOrFresnelAndAveragesSamples) {
    struct Case {
        int supersampling;
        Blend blend;
        bool showsReflectionOnly;
    };
    const Case cases[] = {
        {1, Blend::Reflectivity, false}, {1, Blend::Fresnel, false}, {1, Blend::Fresnel, true},
        {2, Blend::Reflectivity, false}, {2, Blend::Fresnel, false}, {3, Blend::Reflectivity, true},
    };
    for (const auto& [supersampling, blend, showsReflectionOnly] : cases) {
        fill(supersampling);
        expectComposed(supersampling, blend, showsReflectionOnly);
    }
}

// [xie2017] Sec. 5.4.3: view, normal and s. A sample whose normal looks at the eye keeps s, one
// that looks across the view takes all of the reflected colour.
TEST_F(CompositeTest, FresnelReflectsMoreAtGrazingViews) {
    fill(1);
    std::vector<float> depth;
    std::vector<glm::vec2> normal;
    Random random(21);
    for (std::size_t i = 0; i < surface.size(); ++i) {
        depth.push_back(random.uniform(0.5F, 4.0F));
        normal.push_back({random.uniform(-0.5F, 0.5F), random.uniform(-0.5F, 0.5F)});
    }
    normal[1] = {1.0F, 0.0F};  // +x: across the view axis
    gbuffer->depth.upload(GL_RED, GL_FLOAT, depth.data());
    gbuffer->normal.upload(GL_RG, GL_FLOAT, normal.data());
    expectComposed(1, Blend::Fresnel, false);
    const HostGBuffer host = readGBuffer(*gbuffer);
    const glm::vec3 toEye = glm::normalize(host.view.eyeWorld - host.positionWorld({1, 0}));
    const float s = reflectivityOf(host, 1);
    EXPECT_GT(s + (1.0F - s) * std::pow(1.0F - glm::dot(host.normalWorld[1], toEye), 5.0F), 0.4F);
}

}  // namespace
}  // namespace gfxrepro::reflections
