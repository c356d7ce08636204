#include "engine/gl/balance.h"

#include <cmath>

#include "engine/core/files.h"
#include "engine/gl/gl.h"
#include "engine/gl/pass.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

class Balance : public GlTest {
  protected:
    gl::ShaderLibrary shaders{dataFolder("shaders")};
};

TEST_F(Balance, FragmentsAndInvocationsDoTheSameArithmetic) {
    constexpr glm::ivec2 kSize{16, 16};
    const gl::Program fragments(shaders,
                                {"gl/balance_whole.vert.glsl", "gl/balance_arithmetic.frag.glsl"});
    const gl::Pass compute(shaders, {"gl/balance_arithmetic.comp.glsl"});
    const gl::Texture drawn = gl::Texture::make2D(GL_RGBA32F, kSize);
    const gl::Texture computed = gl::Texture::make2D(GL_RGBA32F, kSize);
    const gl::VertexArray noAttributes;
    glBindVertexArray(noAttributes.id());
    const gl::Texture* const colours[] = {&drawn};
    const gl::Framebuffer framebuffer(colours);
    framebuffer.bind();
    fragments.use();
    fragments.set("rounds", 1000);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    compute.set("rounds", 1000);
    compute.dispatch({2, 2, 1}, {{"colour", computed}});

    const image::ImageF one = drawn.readImage(4), other = computed.readImage(4);
    float largest = 0.0F;
    for (std::size_t i = 0; i < one.values().size(); ++i) {
        EXPECT_NEAR(one.values()[i], other.values()[i], 1e-5F) << i;
        largest = std::max(largest, std::abs(one.values()[i]));
    }
    EXPECT_GT(largest, 1e-3F);  // it has not faded,
    EXPECT_LT(largest, 1.0F);   // nor grown
}

TEST_F(Balance, EveryKindOfWorkHasARate) {
    const gl::DeviceBalance balance = gl::measureBalance(shaders);
    for (const double rate :
         {balance.fragmentGflops, balance.computeGflops, balance.fillGpixelsPerS,
          balance.trianglesMPerS, balance.copyGbytesPerS}) {
        EXPECT_TRUE(std::isfinite(rate));
        EXPECT_GT(rate, 1e-3);
        EXPECT_LT(rate, 1e6);
    }
}

}  // namespace
}  // namespace gfxrepro::test
