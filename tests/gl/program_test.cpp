#include "engine/gl/program.h"
#include "engine/gl/pass.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

/// Needs no device.
struct ShaderSourceTest : FolderTest {
    std::string assembleError(const std::string& file) const {
        return errorText([&] { library.assemble(file, {}); }, folder.path());
    }

    gl::ShaderLibrary library{folder.path()};
};

TEST_F(ShaderSourceTest, PutsDefinesBehindVersionAndFilesInOnce) {
    folder.write("shared/a.glsl", "int a;\n");
    folder.write("shared/b.glsl", "#include \"shared/a.glsl\"\nint b;");
    folder.write("t/x.frag.glsl",
                 "#version 450 core\n"
                 "  #include \"shared/b.glsl\"\n"
                 "#include \"shared/a.glsl\"\r\n"
                 "// #include \"shared/none.glsl\"\n"
                 "#pragma snippet formula\n"
                 "void main() {}\n");
    const gl::ShaderSource source = library.assemble("t/x.frag.glsl",
                                                     {{"kCount", 12},
                                                      {"kBias", -0.5F},
                                                      {"kBase", -3},
                                                      {"kMask", 255U},
                                                      {"kScale", 2.0F},
                                                      {"kType", "vec3"}},
                                                     {{"formula", "float f() {\nreturn 1.0; }\n"}});
    EXPECT_EQ(source.text,
              "#version 450 core\n"
              "#define kBase (-3)\n"
              "#define kBias (-0.5)\n"
              "#define kCount 12\n"
              "#define kMask 255u\n"
              "#define kScale 2.0\n"
              "#define kType vec3\n"
              "int a;\n"
              "int b;\n"
              "// #include \"shared/none.glsl\"\n"
              "float f() {\n"
              "return 1.0; }\n"
              "void main() {}\n");
    std::vector<std::string> places;
    for (const gl::ShaderSource::Line& line : source.lines) {
        places.push_back(line.file + ":" + std::to_string(line.line));
    }
    EXPECT_EQ(places, (std::vector<std::string>{
                          "t/x.frag.glsl:1", "define kBase:0", "define kBias:0", "define kCount:0",
                          "define kMask:0", "define kScale:0", "define kType:0", "shared/a.glsl:1",
                          "shared/b.glsl:2", "t/x.frag.glsl:4", "snippet formula:1",
                          "snippet formula:2", "t/x.frag.glsl:6"}));
}

TEST_F(ShaderSourceTest, KeepsFloatsExactly) {
    folder.write("x.frag.glsl", "#version 450 core\n");
    for (const float value : {0.1F, 1.0F / 3.0F, 1e-30F, 3e30F, 16777216.0F}) {
        const std::string text = library.assemble("x.frag.glsl", {{"k", value}}).text;
        const std::string number = text.substr(text.find("#define k ") + 10);
        EXPECT_EQ(std::stof(number), value) << number;
        EXPECT_THAT(number, HasSubstr("."));  // an integer literal would be an int
    }
}

TEST_F(ShaderSourceTest, NamesMissingFilesWithTheirChain) {
    folder.write("a.frag.glsl", "#version 450 core\n\n#include \"b.glsl\"\n");
    folder.write("b.glsl", "#include \"c.glsl\"\n");
    EXPECT_EQ(assembleError("a.frag.glsl"),
              "b.glsl:1: there is no shader file \"c.glsl\" in DIR\n"
              "  included from a.frag.glsl:3");
    EXPECT_EQ(assembleError("none.frag.glsl"), "there is no shader file \"none.frag.glsl\" in DIR");
}

TEST_F(ShaderSourceTest, RefusesCycles) {
    folder.write("a.frag.glsl", "#version 450 core\n#include \"b.glsl\"\n");
    folder.write("b.glsl", "\n#include \"c.glsl\"\n");
    folder.write("c.glsl", "#include \"b.glsl\"\n");
    EXPECT_EQ(assembleError("a.frag.glsl"),
              "c.glsl:1: include cycle: \"b.glsl\" is being read\n"
              "  included from b.glsl:2\n"
              "  included from a.frag.glsl:2");
}

TEST_F(ShaderSourceTest, RefusesMalformedDirectives) {
    folder.write("a.frag.glsl", "// first\n#version 450 core\n");
    EXPECT_EQ(assembleError("a.frag.glsl"),
              "a.frag.glsl:1: the first line must be '#version 450 core', found '// first'");
    folder.write("empty.frag.glsl", "");
    EXPECT_EQ(assembleError("empty.frag.glsl"),
              "empty.frag.glsl:1: the first line must be '#version 450 core', found ''");
    folder.write("b.frag.glsl", "#version 450 core\n#include <x.glsl>\n");
    EXPECT_EQ(assembleError("b.frag.glsl"),
              "b.frag.glsl:2: '#include' needs a path in double quotes, found '<x.glsl>'");
    folder.write("c.frag.glsl", "#version 450 core\n#include \"v.glsl\"\n");
    folder.write("v.glsl", "#version 450 core\n");
    EXPECT_EQ(assembleError("c.frag.glsl"),
              "v.glsl:1: '#version' is allowed in the first line of a stage's file only\n"
              "  included from c.frag.glsl:2");
    folder.write("d.frag.glsl", "#version 450 core\n#pragma snippet f\n");
    EXPECT_EQ(assembleError("d.frag.glsl"), "d.frag.glsl:2: no snippet 'f' was given; given: none");
    EXPECT_EQ(errorText([&] {
                  library.assemble("d.frag.glsl", {}, {{"g", ""}, {"h", ""}});
              }),
              "d.frag.glsl:2: no snippet 'f' was given; given: g, h");
}

TEST_F(ShaderSourceTest, TranslatesTheLogsOfBothDrivers) {
    const gl::ShaderSource source{
        .lines = {{"a.frag.glsl", 1}, {"define k", 0}, {"shared/b.glsl", 7}}};
    EXPECT_EQ(gl::translateLog("0:3(12): error: `x' undeclared\n0:1(1): warning: odd\n", source),
              "shared/b.glsl:7: error: `x' undeclared\na.frag.glsl:1: warning: odd");
    EXPECT_EQ(gl::translateLog("0(3) : error C1503: undefined variable \"x\"\n", source),
              "shared/b.glsl:7: error C1503: undefined variable \"x\"");
    EXPECT_EQ(gl::translateLog("0:2(5): error: syntax error", source),
              "define k: error: syntax error");
    // What names no line of the text stays as it is.
    EXPECT_EQ(gl::translateLog("0:4(1): error: end\nerror: no main", source),
              "0:4(1): error: end\nerror: no main");
}

TEST_F(GlTest, TranslatesADriversErrorToFileAndLine) {
    folder.write("shared/f.glsl", "\nvoid f() { undefinedName; }\n");
    folder.write("t/x.frag.glsl",
                 "#version 450 core\n#include \"shared/f.glsl\"\nvoid main() { f(); }\n");
    // After the place the driver speaks.
    EXPECT_THAT(errorText([&] {
                    gl::Program(library, {"t/x.frag.glsl"}, {{"kUnused", 1}});
                }),
                AllOf(StartsWith("cannot compile t/x.frag.glsl:\nshared/f.glsl:2: error"),
                      HasSubstr("undefinedName")));
}

TEST_F(GlTest, NamesTheFilesThatDoNotLink) {
    folder.write(
        "x.vert.glsl",
        "#version 450 core\nout vec2 v;\nvoid main() { gl_Position = vec4(v = vec2(1), 0, 1); }\n");
    folder.write("x.frag.glsl",
                 "#version 450 core\nin vec3 v;\nout vec4 c;\nvoid main() { c = vec4(v, 1); }\n");
    EXPECT_THAT(errorText([&] {
                    gl::Program(library, {"x.vert.glsl", "x.frag.glsl"});
                }),
                AllOf(StartsWith("cannot link x.vert.glsl + x.frag.glsl:\n"), HasSubstr("error")));
}

TEST_F(GlTest, RefusesAFileWithoutAStage) {
    folder.write("x.glsl", "#version 450 core\n");
    EXPECT_EQ(errorText([&] { gl::Program(library, {"x.glsl"}); }),
              "x.glsl: a stage's file ends in .vert.glsl, .tesc.glsl, .tese.glsl, .geom.glsl, "
              ".frag.glsl or .comp.glsl");
}

TEST_F(GlTest, SetsUniformsOfEveryType) {
    const gl::Program sum = program({{"sum.comp.glsl", R"(#version 450 core
layout(local_size_x = 1) in;
layout(std430, binding = kResult) writeonly buffer Result { float result[]; };
uniform int i;
uniform uint u;
uniform float f;
uniform vec2 v2;
uniform vec3 v3;
uniform vec4 v4;
uniform ivec2 i2;
uniform ivec3 i3;
uniform uvec3 u3;
uniform mat4 m;
uniform float unused;
void main() {
    float values[] = float[](float(i), float(u), f, v2.y, v3.z, v4.w, float(i2.y), float(i3.z),
                             float(u3.z), m[3][1]);
    for (int k = 0; k < values.length(); ++k) result[k] = values[k];
}
)"}},
                                    {{"kResult", 2}});
    glm::mat4 matrix(0.0F);
    matrix[3][1] = 10.0F;
    sum.set("i", -1);
    sum.set("u", 4000000000U);
    sum.set("f", 3.5F);
    sum.set("v2", glm::vec2(0, 4));
    sum.set("v3", glm::vec3(0, 0, 5));
    sum.set("v4", glm::vec4(0, 0, 0, 6));
    sum.set("i2", glm::ivec2(0, -7));
    sum.set("i3", glm::ivec3(0, 0, -8));
    sum.set("u3", glm::uvec3(0, 0, 9));
    sum.set("m", matrix);
    EXPECT_TRUE(sum.isActive("m"));
    EXPECT_FALSE(sum.isActive("unused"));
    EXPECT_FALSE(sum.isActive("absent"));
    sum.setIfActive("absent", 1);

    const gl::Buffer result(40);
    result.bindStorage(2);
    sum.use();
    glDispatchCompute(1, 1, 1);
    EXPECT_EQ(result.read<float>(10), (std::vector<float>{-1, 4e9F, 3.5F, 4, 5, 6, -7, -8, 9, 10}));
}

TEST_F(GlTest, AnInactiveUniformIsNamedWithItsFile) {
    const gl::Program empty = program(
        {{"e.comp.glsl", "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n"}});
    EXPECT_EQ(errorText([&] { empty.set("absent", 1); }),
              "e.comp.glsl uses no uniform 'absent' that it is given");
}

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
