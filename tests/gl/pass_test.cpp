#include "engine/gl/pass.h"

#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

struct PassTest : GlTest {
    gl::Pass pass(const std::string& file, const std::string& text) const {
        return GlTest::pass({{file, "#version 450 core\n" + text}});
    }

    std::string useError(const gl::Pass& pass, const gl::Resources& resources) const {
        return errorText([&] { pass.use(resources); });
    }
};

constexpr const char* kSum = R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer Left { uint left[]; };
layout(std430, binding = 0) readonly buffer Right { uint right[]; };  // the same number
layout(std140) uniform Scale { uint scale; };
uniform usampler2D offsets[2];
layout(std430) writeonly buffer Sum { uint sums[]; };
layout(r32ui) uniform writeonly uimage2D picture;
uniform int first;
void main() {
    uint i = gl_GlobalInvocationID.x;
    uint offset = texelFetch(offsets[0], ivec2(0), 0).r + 2u * texelFetch(offsets[1], ivec2(0), 0).r;
    sums[i] = (left[i + first] + 10u * right[i + first]) * scale + offset;
    imageStore(picture, ivec2(i, 0), uvec4(sums.length()));
}
)";

struct SumResources {
    gl::Buffer left = gl::Buffer::of(std::vector<std::uint32_t>{9, 1, 2});
    gl::Buffer right = gl::Buffer::of(std::vector<std::uint32_t>{9, 3, 4});
    gl::Buffer scale = gl::Buffer::of(std::vector<std::uint32_t>{100, 0, 0, 0});
    gl::Buffer sum{2 * sizeof(std::uint32_t)};
    gl::Texture seven = texel(7), eight = texel(8);
    gl::Texture picture = gl::Texture::make2D(GL_R32UI, {2, 1});

    static gl::Texture texel(std::uint32_t value) {
        gl::Texture texture = gl::Texture::make2D(GL_R32UI, {1, 1});
        texture.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
        return texture;
    }
};

TEST_F(PassTest, FindsEverySortOfResourceByItsName) {
    const gl::Pass sum = pass("sum.comp.glsl", kSum);
    const SumResources r;
    sum.set("first", 1);
    sum.dispatch({2, 1, 1}, {{"offsets[1]", r.eight},
                             {"Left", r.left},
                             {"Sum", r.sum},
                             {"picture", r.picture},
                             {"Right", r.right},
                             {"offsets[0]", r.seven},
                             {"Scale", r.scale}});
    EXPECT_THAT(r.sum.read<std::uint32_t>(2), ElementsAre(3123, 4223));
    EXPECT_THAT(r.picture.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1),
                ElementsAre(2, 2));
}

TEST_F(PassTest, TakesElementsOfArraysWhoseNamesArePutTogether) {
    const gl::Pass sum = pass("sum.comp.glsl", kSum);
    const SumResources r;
    sum.set("first", 1);
    gl::Resources all{{"Left", r.left}, {"Right", r.right}, {"Scale", r.scale}, {"Sum", r.sum}};
    for (int i = 0; i < 2; ++i) {
        all.add({"offsets[" + std::to_string(i) + "]", i == 0 ? r.seven : r.eight});
    }
    EXPECT_EQ(useError(sum, all), "sum.comp.glsl: the image picture is not given");
    all.add({"picture", r.picture});
    sum.dispatch({2, 1, 1}, all);
    EXPECT_THAT(r.sum.read<std::uint32_t>(2), ElementsAre(3123, 4223));
}

TEST_F(PassTest, LeavesLowSlotsToNumberedCode) {
    const gl::Pass sum = pass("sum.comp.glsl", kSum);
    const SumResources r;
    const gl::Buffer numbered(4);
    for (GLuint slot = 0; slot < 4; ++slot) numbered.bindStorage(slot);
    sum.dispatch({2, 1, 1},
                 gl::Resources{{"Left", r.left}, {"Right", r.right}, {"Sum", r.sum}}.with(
                     {{"Scale", r.scale},
                      {"offsets[0]", r.seven},
                      {"offsets[1]", r.seven},
                      {"picture", r.picture}}));
    for (GLuint slot = 0; slot < 4; ++slot) {
        GLint id = 0;
        glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, slot, &id);
        EXPECT_EQ(static_cast<GLuint>(id), numbered.id());
    }
}

TEST_F(PassTest, RefusesMissingDoubledUnknownAndWrongOnesByName) {
    const gl::Pass copy = pass("copy.comp.glsl", R"(
layout(local_size_x = 1) in;
layout(std430) readonly buffer From { uint from[]; };
layout(std430) buffer To { uint to[]; };
uniform usampler2D added;
uniform usampler2D unused;
void main() { to[0] = from[0] + texelFetch(added, ivec2(0), 0).r; }
)");
    const gl::Buffer from(4), to(4);
    const gl::Texture added = SumResources::texel(1);
    EXPECT_EQ(useError(copy, {{"From", from}, {"added", added}}),
              "copy.comp.glsl: the storage block To is not given");
    EXPECT_EQ(useError(copy, {{"From", from}, {"To", to}}),
              "copy.comp.glsl: the sampler added is not given");
    EXPECT_EQ(useError(copy, {{"From", from}, {"To", to}, {"added", added}, {"To", from}}),
              "copy.comp.glsl: To is given twice");
    EXPECT_EQ(useError(copy, {{"From", from}, {"To", to}, {"added", added}, {"Form", from}}),
              "copy.comp.glsl: no stage declares Form");
    EXPECT_EQ(useError(copy, {{"From", added}, {"To", to}, {"added", added}}),
              "copy.comp.glsl: From is a storage block and is given a texture");
    EXPECT_EQ(useError(copy, {{"From", from}, {"To", to}, {"added", to}}),
              "copy.comp.glsl: added is a sampler and is given a buffer");
    EXPECT_EQ(useError(copy, {{"From", from}, {"To", to}, {"added", added}, {"unused", added}}),
              "no error");
    const gl::Resources shared{{"From", from}, {"To", to}, {"added", added}, {"Other", from}};
    EXPECT_EQ(useError(copy, gl::Resources{}.with(shared)), "no error");
    EXPECT_EQ(useError(copy, gl::Resources{{"From", from}}.with(shared)),
              "copy.comp.glsl: From is given twice");
}

/// The barriers between passes as the test reads them from the accesses: GL has no query for them.
GLbitfield owed(const gl::Buffer& buffer, GLbitfield barrier) {
    gl::ShaderAccesses copy = buffer.accesses();
    return copy.note(barrier, false);
}

TEST_F(PassTest, WaitsForWhatQualifiersSayWasWritten) {
    const gl::Pass copy = pass("copy.comp.glsl", R"(
layout(local_size_x = 1) in;
/* not readonly: */ layout(std430) restrict  // and `;` in a comment, readonly;
    readonly buffer From { uint from[]; };
layout(std430) restrict buffer To { uint to[]; };
void main() { to[0] = from[0]; }
)");
    const gl::Buffer a(4), b(4);
    copy.dispatch({1, 1, 1}, {{"From", a}, {"To", b}});
    EXPECT_EQ(owed(a, GL_SHADER_STORAGE_BARRIER_BIT), 0U);
    EXPECT_EQ(owed(b, GL_SHADER_STORAGE_BARRIER_BIT), GLbitfield{GL_SHADER_STORAGE_BARRIER_BIT});
    EXPECT_EQ(owed(b, GL_COMMAND_BARRIER_BIT), GLbitfield{GL_COMMAND_BARRIER_BIT});
    copy.dispatch({1, 1, 1}, {{"From", b}, {"To", a}});
    EXPECT_EQ(owed(b, GL_SHADER_STORAGE_BARRIER_BIT), 0U);
    EXPECT_EQ(owed(b, GL_COMMAND_BARRIER_BIT), GLbitfield{GL_COMMAND_BARRIER_BIT});
    EXPECT_EQ(owed(a, GL_SHADER_STORAGE_BARRIER_BIT), GLbitfield{GL_SHADER_STORAGE_BARRIER_BIT});
}

TEST_F(PassTest, WritesToDifferentPlacesAreNotOrdered) {
    const gl::Pass mark = pass("mark.comp.glsl", R"(
layout(local_size_x = 1) in;
layout(std430) buffer Marks { uint marks[]; };
uniform uint place;
void main() { marks[place] = place; }
)");
    const gl::Buffer marks(3 * 4);
    for (unsigned i = 0; i < 3; ++i) {
        mark.set("place", i);
        mark.dispatch({1, 1, 1}, {gl::Resource("Marks", marks).unordered()});
    }
    EXPECT_EQ(owed(marks, GL_SHADER_STORAGE_BARRIER_BIT),
              GLbitfield{GL_SHADER_STORAGE_BARRIER_BIT});
    EXPECT_THAT(marks.read<std::uint32_t>(3), ElementsAre(0, 1, 2));
}

TEST(ShaderAccesses, AskForABarrierBehindWritesAndBeforeWritesOverWhatWasRead) {
    constexpr GLbitfield kStorage = GL_SHADER_STORAGE_BARRIER_BIT;
    constexpr GLbitfield kFetch = GL_TEXTURE_FETCH_BARRIER_BIT;
    gl::ShaderAccesses accesses;
    EXPECT_EQ(accesses.note(kStorage, false), 0U);
    EXPECT_EQ(accesses.note(kFetch, false), 0U);
    EXPECT_EQ(accesses.note(kStorage, true), kStorage);  // over what was read
    EXPECT_EQ(accesses.note(kStorage, true), kStorage);  // over what was written
    EXPECT_EQ(accesses.note(kFetch, false), kFetch);
    EXPECT_EQ(accesses.note(kFetch, false), 0U);
    EXPECT_EQ(accesses.note(kStorage, false), kStorage);
    EXPECT_EQ(accesses.noteCommand(GL_COMMAND_BARRIER_BIT), GLbitfield{GL_COMMAND_BARRIER_BIT});
    EXPECT_EQ(accesses.noteCommand(GL_COMMAND_BARRIER_BIT), 0U);
    accesses.noteUnorderedWrite();
    EXPECT_EQ(accesses.note(kFetch, false), kFetch);
}

TEST_F(PassTest, ChainsReadWhatCameBefore) {
    const gl::Pass twice = pass("twice.comp.glsl", R"(
layout(local_size_x = 64) in;
layout(std430) readonly buffer From { uint from[]; };
layout(std430) buffer To { uint to[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    to[i] = from[from.length() - 1 - i] * 2u;
}
)");
    gl::Buffer a = gl::Buffer::of(std::vector<std::uint32_t>(4096, 1)), b(4096 * 4);
    for (int i = 0; i < 8; ++i) {
        twice.dispatch({64, 1, 1}, {{"From", a}, {"To", b}});
        std::swap(a, b);
    }
    EXPECT_THAT(a.read<std::uint32_t>(4096), Each(256));
}

TEST_F(PassTest, DispatchesAsManyGroupsAsAPassWrote) {
    const gl::Pass write = pass("write.comp.glsl", R"(
layout(local_size_x = 1) in;
layout(std430) writeonly buffer Arguments { uint arguments[4]; };
void main() { arguments = uint[](0u, 3u, 1u, 1u); }
)");
    const gl::Pass count = pass("count.comp.glsl", R"(
layout(local_size_x = 1) in;
layout(std430) buffer Count { uint count; };
void main() { atomicAdd(count, 1u); }
)");
    gl::Buffer arguments(4 * 4), counted(4);
    counted.clear();
    write.dispatch({1, 1, 1}, {{"Arguments", arguments}});
    count.dispatchIndirect(arguments, 4, {{"Count", counted}});
    EXPECT_THAT(counted.read<std::uint32_t>(1), ElementsAre(3));
}

TEST_F(PassTest, DrawsIntoALayerOfAnImage) {
    folder.write("whole.vert.glsl", kWholeTargetVertexShader);
    folder.write("mark.frag.glsl", R"(#version 450 core
layout(r32ui) uniform writeonly uimage2D layer;
void main() { imageStore(layer, ivec2(gl_FragCoord.xy), uvec4(5u)); }
)");
    const gl::Pass mark(library, {"whole.vert.glsl", "mark.frag.glsl"});
    gl::Texture layers = gl::Texture::make2DArray(GL_R32UI, {1, 1}, 3);
    layers.clearToZero();
    const auto target = gl::Framebuffer::withoutAttachments({1, 1});
    const gl::VertexArray none;
    target.bind();
    none.bind();
    mark.use({{"layer", layers, 1}});
    glDrawArrays(GL_TRIANGLES, 0, 3);
    EXPECT_THAT(layers.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1),
                ElementsAre(0, 5, 0));
}

}  // namespace
}  // namespace gfxrepro::test
