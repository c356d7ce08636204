// The checker finds each hazard where it is, and nothing where it is not.
#include "tests/drivers/hazards/hazards.h"

#include "engine/gl/profiler.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

constexpr const char* kWrite = R"(#version 450 core
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer To { uint to[]; };
void main() { to[0] = 7u; }
)";
constexpr const char* kRead = R"(#version 450 core
layout(local_size_x = 1) in;
// buffer From;
layout(std430, binding = 0) readonly buffer From { uint from[]; };
layout(std430, binding = 1) buffer Copy { uint copy[]; };
void main() { copy[0] = from[0]; }
)";
constexpr const char* kStore = R"(#version 450 core
layout(local_size_x = 1) in;
layout(r32ui, binding = 0) uniform writeonly uimage2D picture;
void main() { imageStore(picture, ivec2(0), uvec4(7u)); }
)";
constexpr const char* kSample = R"(#version 450 core
layout(binding = 0) uniform usampler2D picture;
layout(location = 0) out uint value;
void main() { value = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).r; }
)";

struct Hazards : GlTest {
    void SetUp() override { hazards::take(); }

    static void dispatch(const gl::Program& program) {
        program.use();
        glDispatchCompute(1, 1, 1);
    }
    void draw(const gl::Program& program) const {
        program.use();
        noAttributes.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    gl::Program fragments(const char* text) const {
        return program({{"whole.vert.glsl", kWholeTargetVertexShader}, {"f.frag.glsl", text}});
    }

    gl::VertexArray noAttributes;
    gl::Buffer first{4}, second{4};
};

TEST_F(Hazards, AWriteIsNotSeenWithoutItsBarrier) {
    const gl::Program write = program({{"write.comp.glsl", kWrite}});
    const gl::Program read = program({{"read.comp.glsl", kRead}});
    first.bindStorage(0);
    second.bindStorage(1);
    dispatch(write);
    glFinish();
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    dispatch(read);
    EXPECT_THAT(hazards::take(), ElementsAre("read.comp.glsl: From is what write.comp.glsl wrote, "
                                             "without GL_SHADER_STORAGE_BARRIER_BIT"));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    dispatch(write);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    dispatch(read);
    dispatch(read);  // whose writes go on
    EXPECT_THAT(hazards::take(), IsEmpty());
}

TEST_F(Hazards, AWriteDoesNotWaitForReadsWithoutItsBarrier) {
    const gl::Program write = program({{"write.comp.glsl", kWrite}});
    const gl::Program read = program({{"read.comp.glsl", kRead}});
    first.bindStorage(0);
    second.bindStorage(1);
    dispatch(read);
    dispatch(write);
    EXPECT_THAT(
        hazards::take(),
        ElementsAre(
            "write.comp.glsl: To is written behind reads, without GL_SHADER_STORAGE_BARRIER_BIT"));
    dispatch(write);  // goes on
    EXPECT_THAT(hazards::take(), IsEmpty());
}

TEST_F(Hazards, PassesOrderThemselves) {
    const gl::Pass write = pass({{"write.comp.glsl", kWrite}});
    const gl::Pass read = pass({{"read.comp.glsl", kRead}});
    for (int i = 0; i < 2; ++i) {
        write.dispatch({1, 1, 1}, {{"To", first}});
        read.dispatch({1, 1, 1}, {{"From", first}, {"Copy", second}});
        read.dispatch({1, 1, 1}, {{"From", second}, {"Copy", first}});
    }
    EXPECT_THAT(first.read<std::uint32_t>(1), ElementsAre(7));
    EXPECT_THAT(hazards::take(), IsEmpty());
}

TEST_F(Hazards, CommandsNeedBarriersOfTheirOwn) {
    const gl::Program write = program({{"write.comp.glsl", kWrite}});
    gl::Buffer arguments(3 * sizeof(std::uint32_t));
    arguments.bindStorage(0);
    const auto writeAll = [&] {
        dispatch(write);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        hazards::take();
    };
    const std::vector<std::uint32_t> ones{1, 1, 1};
    writeAll();
    arguments.write<std::uint32_t>(ones);
    arguments.clear();
    EXPECT_THAT(hazards::take(),
                ElementsAre("glNamedBufferSubData: the buffer is what write.comp.glsl wrote, "
                            "without GL_BUFFER_UPDATE_BARRIER_BIT",
                            "glClearNamedBufferData: the buffer is what write.comp.glsl wrote, "
                            "without GL_BUFFER_UPDATE_BARRIER_BIT"));
    arguments.clear();  // behind which there is no write of a shader
    arguments.read<std::uint32_t>(1);
    EXPECT_THAT(hazards::take(), IsEmpty());

    writeAll();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
    first.bindStorage(0);
    glDispatchComputeIndirect(0);
    EXPECT_THAT(hazards::take(),
                ElementsAre("write.comp.glsl: the arguments is what write.comp.glsl wrote, without "
                            "GL_COMMAND_BARRIER_BIT"));
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
    glDispatchComputeIndirect(0);
    EXPECT_THAT(hazards::take(), IsEmpty());
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

TEST_F(Hazards, PicturesAndVerticesNeedBarriersOfTheirOwn) {
    const gl::Program store = program({{"store.comp.glsl", kStore}});
    const gl::Program sample = fragments(kSample);
    const gl::Texture from = gl::Texture::make2D(GL_R32UI, {1, 1});
    const gl::Texture to = gl::Texture::make2D(GL_R32UI, {1, 1});
    const gl::Texture* const target = &to;
    const gl::Framebuffer framebuffer({&target, 1});
    from.bindImage(0, GL_WRITE_ONLY);
    from.bind(0);
    framebuffer.bind();
    dispatch(store);
    draw(sample);
    EXPECT_THAT(hazards::take(),
                ElementsAre("f.frag.glsl + whole.vert.glsl: picture is what store.comp.glsl wrote, "
                            "without GL_TEXTURE_FETCH_BARRIER_BIT"));
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    draw(sample);
    EXPECT_THAT(hazards::take(), IsEmpty());

    to.bindImage(0, GL_WRITE_ONLY);
    dispatch(store);
    draw(sample);
    EXPECT_THAT(hazards::take(),
                ElementsAre("f.frag.glsl + whole.vert.glsl: the picture drawn into is what "
                            "store.comp.glsl wrote, without GL_FRAMEBUFFER_BARRIER_BIT"));

    const gl::Program write = program({{"write.comp.glsl", kWrite}});
    gl::Buffer vertices(12 * sizeof(float));
    gl::VertexArray array;
    array.setAttribute(0, vertices, 4);
    array.setIndices(vertices);
    vertices.bindStorage(0);
    dispatch(write);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
    sample.use();
    array.bind();
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);
    EXPECT_THAT(hazards::take(),
                ElementsAre("f.frag.glsl + whole.vert.glsl: a vertex attribute is what "
                            "write.comp.glsl wrote, without GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT",
                            "f.frag.glsl + whole.vert.glsl: the indices is what write.comp.glsl "
                            "wrote, without GL_ELEMENT_ARRAY_BARRIER_BIT"));
}

TEST_F(Hazards, WhatIsDrawnIntoIsReadBehindATextureBarrierAlone) {
    const gl::Program sample = fragments(kSample);
    const gl::Texture both = gl::Texture::make2D(GL_R32UI, {2, 2}, 2);
    const gl::Texture* const target = &both;
    const gl::Framebuffer framebuffer({&target, 1});
    both.bind(0);
    framebuffer.bind();
    const std::string feedback =
        "f.frag.glsl + whole.vert.glsl: picture is drawn into, without glTextureBarrier";
    draw(sample);
    EXPECT_THAT(hazards::take(), ElementsAre(feedback));
    glTextureBarrier();
    draw(sample);
    EXPECT_THAT(hazards::take(), IsEmpty());
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw(sample);  // what the last one drew
    EXPECT_THAT(hazards::take(), ElementsAre(feedback));
    framebuffer.bind();  // is no other
    draw(sample);
    EXPECT_THAT(hazards::take(), ElementsAre(feedback));
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

    const gl::Texture half = both.viewOfLevel(1);
    half.bind(0);
    draw(sample);
    EXPECT_THAT(hazards::take(), IsEmpty());
    const gl::Texture same = both.viewOfLevel(0);
    same.bind(0);
    draw(sample);
    EXPECT_THAT(hazards::take(), ElementsAre(feedback));
    const gl::Texture* const small = &half;
    const gl::Framebuffer other({&small, 1});
    other.bind();
    draw(sample);
    EXPECT_THAT(hazards::take(), IsEmpty());
}

TEST_F(Hazards, ADepthThatIsOnlyTestedMayBeRead) {
    const gl::Program sample = fragments(R"(#version 450 core
layout(binding = 0) uniform sampler2D depth;
layout(location = 0) out float value;
void main() { value = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r; }
)");
    const gl::Texture colour = gl::Texture::make2D(GL_R32F, {1, 1});
    const gl::Texture depth = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, {1, 1});
    const gl::Texture* const target = &colour;
    const gl::Framebuffer framebuffer({&target, 1}, &depth);
    framebuffer.bind();
    depth.bind(0);
    glEnable(GL_DEPTH_TEST);
    draw(sample);
    EXPECT_THAT(
        hazards::take(),
        ElementsAre(
            "f.frag.glsl + whole.vert.glsl: depth is drawn into, without glTextureBarrier"));
    glTextureBarrier();
    glDepthMask(GL_FALSE);
    draw(sample);
    draw(sample);
    EXPECT_THAT(hazards::take(), IsEmpty());
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

TEST_F(Hazards, NothingIsReadBackWithinAFrame) {
    const gl::Program write = program({{"write.comp.glsl", kWrite}});
    first.bindStorage(0);
    const gl::PrimitiveQuery query;
    const auto readAll = [&] {
        dispatch(write);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        query.begin();
        query.end();
        first.read<std::uint32_t>(1);
        query.result();
    };
    readAll();
    EXPECT_THAT(hazards::take(), IsEmpty());
    {
        const gl::DebugGroup frame(device, "frame");
        const gl::DebugGroup pass(device, "pass");
        readAll();
    }
    EXPECT_THAT(
        hazards::take(),
        ElementsAre("glGetNamedBufferSubData: reads back within a frame, behind write.comp.glsl",
                    "glGetQueryObjectui64v: reads back within a frame, behind write.comp.glsl"));
}

TEST_F(Hazards, NothingIsLeftUnbound) {
    const gl::Program write = program({{"write.comp.glsl", kWrite}});
    const gl::Program store = program({{"store.comp.glsl", kStore}});
    const gl::Program sample = fragments(kSample);
    const gl::Program scaled = program({{"scaled.comp.glsl", R"(#version 450 core
layout(local_size_x = 1) in;
layout(std140, binding = 3) uniform Scale { uint scale; };
layout(std430, binding = 0) buffer To { uint to[]; };
void main() { to[0] = scale; }
)"}});
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, 0);
    dispatch(write);
    EXPECT_THAT(hazards::take(), ElementsAre("write.comp.glsl: the block To has no buffer"));
    dispatch(store);
    EXPECT_THAT(hazards::take(), ElementsAre("store.comp.glsl: the image picture has no texture"));
    const gl::Framebuffer nothing = gl::Framebuffer::withoutAttachments({1, 1});
    nothing.bind();
    draw(sample);
    EXPECT_THAT(hazards::take(),
                ElementsAre("f.frag.glsl + whole.vert.glsl: the sampler picture has no texture"));
    first.bindStorage(0);
    dispatch(scaled);
    EXPECT_THAT(hazards::take(), ElementsAre("scaled.comp.glsl: the block Scale has no buffer"));
}

}  // namespace
}  // namespace gfxrepro::test
