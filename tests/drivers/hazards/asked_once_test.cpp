// Within frames a driver is not asked for what does not change: one that has threads of its own
// waits for them with each answer.
#include <dlfcn.h>

#include "tests/gl/gl_fixture.h"

namespace {
int askedForLocations = 0;
int askedForLimits = 0;
}  // namespace

#define NEXT(name) reinterpret_cast<decltype(&name)>(::dlsym(RTLD_NEXT, #name))

extern "C" {

GLAPI GLint APIENTRY glGetUniformLocation(GLuint program, const GLchar* name) {
    ++askedForLocations;
    return NEXT(glGetUniformLocation)(program, name);
}

GLAPI void APIENTRY glGetIntegerv(GLenum name, GLint* value) {
    ++askedForLimits;
    NEXT(glGetIntegerv)(name, value);
}

GLAPI void APIENTRY glGetInteger64v(GLenum name, GLint64* value) {
    ++askedForLimits;
    NEXT(glGetInteger64v)(name, value);
}

}  // extern "C"

namespace gfxrepro::test {
namespace {

using AskedOnce = GlTest;

TEST_F(AskedOnce, LocationsOfUniforms) {
    const gl::Program scale = program({{"scale.comp.glsl", R"(#version 450 core
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer To { uint to[]; };
uniform uint scale;
uniform uint steps[2];
void main() { to[0] = scale + 10u * steps[0] + 100u * steps[1]; }
)"}});
    const gl::Buffer to(4);
    to.bindStorage(0);
    askedForLocations = 0;
    for (unsigned frame = 0; frame < 3; ++frame) {
        scale.set("scale", frame);
        scale.set("steps[0]", 5U);
        scale.set("steps[1]", 6U);
        scale.setIfActive("notThere", 1U);
    }
    EXPECT_EQ(askedForLocations, 4);
    scale.use();
    glDispatchCompute(1, 1, 1);
    EXPECT_EQ(to.read<std::uint32_t>(1).front(), 652U);
    EXPECT_FALSE(scale.isActive("notThere"));
}

TEST_F(AskedOnce, LimitsOfBuffersOnlyOfLargeOnes) {
    const gl::Buffer storage(1 << 20), uniforms(1 << 10), large(std::size_t{1} << 25);
    askedForLimits = 0;
    storage.bindStorage(0);
    uniforms.bindUniform(0);
    EXPECT_EQ(askedForLimits, 0);
    large.bindStorage(0);
    large.bindStorage(1);
    EXPECT_EQ(askedForLimits, 1);
}

}  // namespace
}  // namespace gfxrepro::test
