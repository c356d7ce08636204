// Composite against its formula on the host.
#include "techniques/reflections/frame.h"

#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

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
        for (int dy = 0; dy < supersampling; ++dy) {
            for (int dx = 0; dx < supersampling; ++dx) {
                const glm::ivec2 at = pixel * supersampling + glm::ivec2(dx, dy);
                const auto i =
                    static_cast<std::size_t>(at.y * kOutputSize.x * supersampling + at.x);
                const glm::vec3 own = showsReflectionOnly ? glm::vec3(0) : host.diffuse[i];
                float s = static_cast<float>(surface[i] >> 16 & 0xFFU) / 255.0F;
                if (blend == Blend::Fresnel) {
                    const glm::vec3 toEye =
                        glm::normalize(host.view.eyeWorld - host.positionWorld(at));
                    const float cosine = std::max(glm::dot(toEye, host.normalWorld[i]), 0.0F);
                    s += (1.0F - s) * std::pow(1.0F - cosine, 5.0F);
                }
                if (showsReflectionOnly) s = 1.0F;
                sum += surface[i] == 0 ? own : (1.0F - s) * own + s * glm::vec3(reflected[i]);
            }
        }
        return sum / static_cast<float>(supersampling * supersampling);
    }

    void expectComposed(int supersampling, Blend blend, bool showsReflectionOnly) const {
        const HostGBuffer host = readGBuffer(*gbuffer);
        Composite composite(shaders, kOutputSize, supersampling, blend);
        composite.render(*gbuffer, *target, showsReflectionOnly);
        const image::ImageF image = composite.read();
        ASSERT_EQ(image.channels(), 3);
        for (int y = 0; y < kOutputSize.y; ++y) {
            for (int x = 0; x < kOutputSize.x; ++x) {
                const glm::vec3 colour =
                    expected(host, {x, y}, supersampling, blend, showsReflectionOnly);
                for (int c = 0; c < 3; ++c) {
                    // 10 bits of the diffuse colour, 11 of each half-precision number.
                    EXPECT_NEAR(image.at(x, kOutputSize.y - 1 - y, c), colour[c], 2e-3F)
                        << supersampling << " " << x << " " << y << " " << c;
                }
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
