#include "engine/gl/profiler.h"

#include <array>
#include <thread>

#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

using gl::PassTime;

std::vector<std::string> names(const std::vector<PassTime>& times) {
    std::vector<std::string> result;
    for (const PassTime& time : times) {
        result.push_back((time.clock == PassTime::Clock::Gpu ? "gpu " : "cpu ") + time.pass);
    }
    return result;
}

TEST_F(GlTest, ScopesNestAndSumInTheOrderOfTheirBeginning) {
    gl::Profiler profiler(device.info().isSoftware);
    gl::Texture target = gl::Texture::make2D(GL_RGBA32F, {512, 512});
    {
        const gl::GpuScope frame(profiler, "frame");
        for (int i = 0; i < 3; ++i) {
            const gl::GpuScope clear(profiler, "clear");
            target.clearToZero();
        }
        const gl::CpuScope read(profiler, "clear");  // the same name on another clock
    }
    const std::vector<PassTime> times = profiler.collect();
    EXPECT_EQ(names(times), (std::vector<std::string>{"gpu frame", "gpu clear", "cpu clear"}));
    for (const PassTime& time : times) EXPECT_GE(time.timeMs, 0.0);
    // The stamps of one clock are in order, so the whole is no shorter than its parts together.
    EXPECT_GT(times[1].timeMs, 0.0);
    EXPECT_GE(times[0].timeMs, times[1].timeMs);

    EXPECT_TRUE(profiler.collect().empty());
}

TEST_F(GlTest, CpuScopeTakesAtLeastItsSleep) {
    gl::Profiler profiler(device.info().isSoftware);
    for (int i = 0; i < 2; ++i) {
        const gl::CpuScope scope(profiler, "sleep");
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const std::vector<PassTime> times = profiler.collect();
    ASSERT_EQ(times.size(), 1U);
    EXPECT_GE(times[0].timeMs, 10.0);
    // Nothing was done meanwhile, by no thread.
    EXPECT_GE(times[0].processTimeMs, 0.0);
    EXPECT_LT(times[0].processTimeMs, times[0].timeMs);
}

TEST_F(GlTest, AScopeHoldsThePixelWorkOfItsDraw) {
    // llvmpipe rasterizes when it flushes: without finishing at the stamps, the draw's time would
    // fall into the next scope. 512² pixels of 256 steps are far more work than an empty scope.
    const gl::Program busy =
        program({{"b.vert.glsl", kWholeTargetVertexShader}, {"b.frag.glsl", R"(#version 450 core
layout(location = 0) out vec4 colour;
uniform int steps;
void main() {
    float x = gl_FragCoord.x;
    for (int i = 0; i < steps; ++i) x = fract(x * 1.37 + 0.11);
    colour = vec4(x);
}
)"}});
    const gl::Texture target = gl::Texture::make2D(GL_RGBA8, {512, 512});
    const gl::Framebuffer framebuffer(std::array{&target});
    framebuffer.bind();
    busy.set("steps", 256);
    busy.use();
    const gl::VertexArray vertexArray;
    vertexArray.bind();
    gl::Profiler profiler(device.info().isSoftware);
    {
        const gl::GpuScope scope(profiler, "draw");
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    { const gl::GpuScope scope(profiler, "nothing"); }
    const std::vector<PassTime> times = profiler.collect();
    ASSERT_EQ(names(times), (std::vector<std::string>{"gpu draw", "gpu nothing"}));
    EXPECT_GT(times[0].timeMs, times[1].timeMs);
    if (device.info().isSoftware) EXPECT_GT(times[0].processTimeMs, times[1].processTimeMs);
}

TEST_F(GlTest, AScopeHoldsTheVertexWorkOfItsDraw) {
    // A software device runs the vertices in the draw call, so the scope around the call is longer
    // than the call, unless its first stamp is taken late. Nothing is rasterized.
    const gl::Program busy = program({{"v.vert.glsl", R"(#version 450 core
void main() {
    float x = float(gl_VertexID);
    for (int i = 0; i < 64; ++i) x = fract(x * 1.37 + 0.11);
    gl_Position = vec4(x, 0.0, 0.0, 1.0);
}
)"},
                                      {"v.frag.glsl", "#version 450 core\nvoid main() {}\n"}});
    const gl::Texture target = gl::Texture::make2D(GL_RGBA8, {512, 512});
    const gl::Framebuffer framebuffer(std::array{&target});
    framebuffer.bind();
    framebuffer.clearColour(0, glm::vec4(0));
    busy.use();
    const gl::VertexArray vertexArray;
    vertexArray.bind();
    gl::Profiler profiler(device.info().isSoftware);
    {
        const gl::GpuScope scope(profiler, "draw");
        const gl::CpuScope call(profiler, "draw call");
        glDrawArrays(GL_TRIANGLES, 0, 300000);
    }
    const std::vector<PassTime> times = profiler.collect();
    ASSERT_EQ(names(times), (std::vector<std::string>{"gpu draw", "cpu draw call"}));
    EXPECT_GE(times[0].timeMs, times[1].timeMs);
}

TEST_F(GlTest, QueriesGoWithTheirScopes) {
    gl::Profiler profiler(device.info().isSoftware);
    { const gl::GpuScope scope(profiler, "a"); }
    EXPECT_EQ(profiler.collect().size(), 1U);
    for (GLuint id = 1; id < 8; ++id) EXPECT_FALSE(glIsQuery(id));
}

}  // namespace
}  // namespace gfxrepro::test
