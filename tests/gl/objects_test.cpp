#include "engine/gl/objects.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"

namespace gfxrepro::test {
namespace {

using gl::Buffer;
using gl::Framebuffer;
using gl::Texture;

TEST_F(GlTest, BufferRoundTrip) {
    std::vector<unsigned> values(1000);
    std::iota(values.begin(), values.end(), 7U);
    Buffer buffer = Buffer::of(values);
    EXPECT_EQ(buffer.sizeBytes(), 4000U);
    EXPECT_EQ(buffer.read<unsigned>(1000), values);

    const std::vector<unsigned> middle{1, 2, 3};
    buffer.write(std::span<const unsigned>(middle), 400);
    EXPECT_EQ(buffer.read<unsigned>(5, 396), (std::vector<unsigned>{106, 1, 2, 3, 110}));

    buffer.clear(5);
    EXPECT_EQ(buffer.read<unsigned>(1000), std::vector<unsigned>(1000, 5));
}

TEST_F(GlTest, BufferOfNothingAndOfOddSize) {
    Buffer empty = Buffer::of(std::vector<float>{});
    EXPECT_NE(empty.id(), 0U);
    EXPECT_EQ(empty.sizeBytes(), 0U);
    empty.clear();
    empty.bindStorage(0);

    Buffer odd = Buffer::of(std::vector<unsigned char>{1, 2, 3, 4, 5});
    EXPECT_EQ(odd.read<unsigned char>(3, 2), (std::vector<unsigned char>{3, 4, 5}));
    odd.clear();
    EXPECT_EQ(odd.read<unsigned char>(5), std::vector<unsigned char>(5, 0));
}

TEST_F(GlTest, NamesAreDeletedOnceAndWithTheirOwner) {
    GLuint id = 0;
    {
        Texture first = Texture::make2D(GL_R8, {4, 4});
        id = first.id();
        Texture second = std::move(first);
        EXPECT_EQ(first.id(), 0U);
        EXPECT_EQ(second.id(), id);
        EXPECT_TRUE(glIsTexture(id));
    }
    EXPECT_FALSE(glIsTexture(id));

    Texture assigned = Texture::make2D(GL_R8, {4, 4});
    const GLuint replaced = assigned.id();
    assigned = Texture::make2D(GL_R8, {8, 8});
    EXPECT_FALSE(glIsTexture(replaced));
    EXPECT_TRUE(glIsTexture(assigned.id()));
    EXPECT_EQ(assigned.size(), glm::ivec3(8, 8, 1));
}

TEST_F(GlTest, TextureRoundTripWithRowsOfOddLength) {
    // 3 × 3 bytes a row: wrong with the default alignment of 4.
    std::vector<unsigned char> pixels(3 * 3 * 3);
    std::iota(pixels.begin(), pixels.end(), static_cast<unsigned char>(1));
    Texture texture = Texture::make2D(GL_RGB8, {3, 3});
    texture.upload(GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    EXPECT_EQ(texture.read<unsigned char>(GL_RGB, GL_UNSIGNED_BYTE, 3), pixels);
}

TEST_F(GlTest, TextureKindsRoundTripAndKnowTheirSize) {
    std::vector<unsigned> texels(4 * 2 * 6);
    std::iota(texels.begin(), texels.end(), 0U);
    Texture array = Texture::make2DArray(GL_R32UI, {4, 2}, 6);
    Texture volume = Texture::make3D(GL_R32UI, {4, 2, 6});
    for (Texture* texture : {&array, &volume}) {
        texture->upload(GL_RED_INTEGER, GL_UNSIGNED_INT, texels.data());
        EXPECT_EQ(texture->read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1), texels);
        EXPECT_EQ(texture->sizeBytes(), 4U * 2 * 6 * 4);
    }
    std::vector<float> faces(2 * 2 * 6);
    std::iota(faces.begin(), faces.end(), 0.5F);
    Texture cube = Texture::makeCube(GL_R32F, 2);
    cube.upload(GL_RED, GL_FLOAT, faces.data());
    EXPECT_EQ(cube.read<float>(GL_RED, GL_FLOAT, 1), faces);
    EXPECT_EQ(cube.size(), glm::ivec3(2, 2, 6));

    // All levels: 8×4, 4×2, 2×1, 1×1; layers do not shrink, a volume's depth does.
    EXPECT_EQ(Texture::make2D(GL_RGBA16F, {8, 4}, 0).sizeBytes(), (32U + 8 + 2 + 1) * 8);
    EXPECT_EQ(Texture::make2DArray(GL_R8, {4, 4}, 3, 0).sizeBytes(), (16U + 4 + 1) * 3);
    EXPECT_EQ(Texture::make3D(GL_R8, {4, 4, 4}, 0).sizeBytes(), 64U + 8 + 1);
    EXPECT_EQ(Texture().sizeBytes(), 0U);
}

TEST_F(GlTest, LevelsAreFilledAndSeenOneByOne) {
    Texture texture = Texture::make2D(GL_R32UI, {4, 2}, 0);
    const std::vector<unsigned> finest{1, 2, 3, 4, 5, 6, 7, 8}, coarser{9, 10}, last{11};
    texture.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, finest.data());
    texture.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, coarser.data(), 1);
    texture.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, last.data(), 2);
    Texture level = texture.viewOfLevel(1);
    EXPECT_EQ(level.size(), glm::ivec3(2, 1, 1));
    EXPECT_EQ(level.read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1), coarser);
    EXPECT_EQ(texture.viewOfLevel(2).read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1), last);
    texture = Texture();  // the texels stay with their views
    EXPECT_EQ(level.read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1), coarser);
}

TEST_F(GlTest, ClearToZeroForEveryKindOfFormat) {
    Texture integers = Texture::make2D(GL_R32UI, {2, 2});
    const std::vector<unsigned> ones(4, ~0U);
    integers.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, ones.data());
    integers.clearToZero();
    EXPECT_EQ(integers.read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1),
              std::vector<unsigned>(4, 0));

    Texture depth = Texture::make2D(GL_DEPTH_COMPONENT32F, {2, 2});
    const std::vector<float> half(4, 0.5F);
    depth.upload(GL_DEPTH_COMPONENT, GL_FLOAT, half.data());
    depth.clearToZero();
    EXPECT_EQ(depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1), std::vector<float>(4, 0.0F));

    Texture colour = Texture::make3D(GL_RGBA16F, {2, 1, 2});
    const std::vector<float> values(16, 2.0F);
    colour.upload(GL_RGBA, GL_FLOAT, values.data());
    colour.clearToZero();
    EXPECT_EQ(colour.read<float>(GL_RGBA, GL_FLOAT, 4), std::vector<float>(16, 0.0F));

    Texture::make2D(GL_DEPTH24_STENCIL8, {2, 2}).clearToZero();  // no error is the test
}

TEST_F(GlTest, ImageTextureKeepsItsFirstRowFirstAndDecodesSrgb) {
    image::Image8 image(1, 2, 3);
    image.at(0, 0, 0) = 255;  // top: red
    image.at(0, 1, 1) = 188;  // bottom: green, 0.5 in linear light
    const Texture texture = Texture::fromImage(image, true);
    EXPECT_EQ(texture.format(), static_cast<GLenum>(GL_SRGB8));
    const gl::Program fetch = program({{"fetch.comp.glsl", R"(#version 450 core
layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler2D image;
layout(std430, binding = 0) writeonly buffer Result { vec4 result[2]; };
void main() {
    result[0] = textureLod(image, vec2(0.5, 0.25), 0.0);
    result[1] = textureLod(image, vec2(0.5, 0.75), 0.0);
}
)"}});
    const Buffer result(32);
    result.bindStorage(0);
    texture.bind(0);
    fetch.use();
    glDispatchCompute(1, 1, 1);
    const std::vector<glm::vec4> texels = result.read<glm::vec4>(2);
    EXPECT_NEAR(texels[0].r, 1.0F, 1e-5F);
    EXPECT_NEAR(texels[0].g, 0.0F, 1e-5F);
    EXPECT_NEAR(texels[1].r, 0.0F, 1e-5F);
    EXPECT_NEAR(texels[1].g, 0.5029F, 2e-3F);  // ((188/255 + 0.055) / 1.055)^2.4, to 8 bits
}

TEST_F(GlTest, FramebufferOfOneLayerLeavesTheOthers) {
    for (const bool isCube : {false, true}) {
        Texture texture =
            isCube ? Texture::makeCube(GL_R32F, 2) : Texture::make2DArray(GL_R32F, {2, 2}, 6);
        const std::vector<float> zeros(24, 0.0F);
        texture.upload(GL_RED, GL_FLOAT, zeros.data());
        const Texture depth = Texture::make2D(GL_DEPTH24_STENCIL8, {2, 2});
        for (const int layer : {1, 4}) {
            const Framebuffer framebuffer = Framebuffer::ofLayer(texture, layer, &depth);
            framebuffer.clearColour(0, glm::vec4(static_cast<float>(layer)));
        }
        std::vector<float> expected = zeros;
        std::fill_n(expected.begin() + 4, 4, 1.0F);
        std::fill_n(expected.begin() + 16, 4, 4.0F);
        EXPECT_EQ(texture.read<float>(GL_RED, GL_FLOAT, 1), expected) << isCube;
    }
}

TEST_F(GlTest, InstancesTakeTheirIndexFromTheirBase) {
    const gl::Program fill = program({{"t.vert.glsl", R"(#version 450 core
layout(location = 0) in vec2 position;
layout(location = 1) in uint index;
flat out uint indexOfInstance;
void main() {
    indexOfInstance = index;
    gl_Position = vec4(position, 0.0, 1.0);
}
)"},
                                      {"t.frag.glsl", R"(#version 450 core
flat in uint indexOfInstance;
layout(location = 0) out uint colour;
void main() { colour = indexOfInstance; }
)"}});
    const Buffer positions = Buffer::of(std::vector<glm::vec2>{{-1, -1}, {3, -1}, {-1, 3}});
    const Buffer elements = Buffer::of(std::vector<unsigned>{0, 1, 2});
    const Buffer indices = Buffer::of(std::vector<unsigned>{7, 4000000000U, 9});
    gl::VertexArray vertexArray;
    vertexArray.setAttribute(0, positions, 2);
    vertexArray.setInstanceIndex(1, indices);
    vertexArray.setIndices(elements);
    const Texture colour = Texture::make2D(GL_R32UI, {2, 2});
    const Framebuffer framebuffer(std::array{&colour});
    framebuffer.bind();
    fill.use();
    vertexArray.bind();
    for (const unsigned base : {1U, 2U, 0U}) {
        glDrawElementsInstancedBaseInstance(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr, 1, base);
        EXPECT_EQ(colour.read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1),
                  std::vector<unsigned>(4, indices.read<unsigned>(3)[base]));
    }
}

TEST_F(GlTest, DrawsATriangleWithKnownPixels) {
    const gl::Program fill = program({{"t.vert.glsl", R"(#version 450 core
layout(location = 0) in vec2 position;
void main() { gl_Position = vec4(position, 0.0, 1.0); }
)"},
                                      {"t.frag.glsl", R"(#version 450 core
layout(location = 0) out vec4 colour;
void main() { colour = vec4(gl_FragCoord.xy, 3.0, 4.0); }
)"}});
    // The lower left half of a 4 × 4 target; the diagonal runs between pixel centres.
    const Buffer positions = Buffer::of(std::vector<glm::vec2>{{-1, -1}, {1.25F, -1}, {-1, 1.25F}});
    const Buffer indices = Buffer::of(std::vector<unsigned>{0, 1, 2});
    gl::VertexArray vertexArray;
    vertexArray.setAttribute(0, positions, 2);
    vertexArray.setIndices(indices);

    const Texture colour = Texture::make2D(GL_RGBA32F, {4, 4});
    const Texture depth = Texture::make2D(GL_DEPTH_COMPONENT32F, {4, 4});
    const Framebuffer framebuffer(std::array{&colour}, &depth);
    framebuffer.bind();
    framebuffer.clearColour(0, {-1, -2, -3, -4});
    framebuffer.clearDepth(1.0F);
    glEnable(GL_DEPTH_TEST);
    fill.use();
    vertexArray.bind();
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);

    const image::ImageF image = colour.readImage(4);
    const std::vector<float> depths = depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1);
    for (const auto [y, x] : test::grid(4, 4)) {
        const int rowFromBottom = 3 - y;
        const bool isInside = x + rowFromBottom < 4;
        const auto row = static_cast<float>(rowFromBottom);
        EXPECT_EQ(image.at(x, y, 0), isInside ? static_cast<float>(x) + 0.5F : -1.0F);
        EXPECT_EQ(image.at(x, y, 1), isInside ? row + 0.5F : -2.0F);
        EXPECT_EQ(image.at(x, y, 3), isInside ? 4.0F : -4.0F);
        EXPECT_EQ(depths[static_cast<std::size_t>(rowFromBottom * 4 + x)], isInside ? 0.5F : 1.0F);
    }
}

TEST_F(GlTest, FragmentsWithoutAttachmentsCountWithAtomics) {
    const gl::Program count =
        program({{"c.vert.glsl", kWholeTargetVertexShader}, {"c.frag.glsl", R"(#version 450 core
layout(binding = 0, r32ui) uniform uimage3D cells;
layout(std430, binding = 1) buffer Total { uint total; };
void main() {
    atomicAdd(total, 1u);
    imageAtomicOr(cells, ivec3(ivec2(gl_FragCoord.xy) / 16, 1), 1u << (int(gl_FragCoord.x) & 15));
}
)"}});
    Texture cells = Texture::make3D(GL_R32UI, {2, 1, 2});
    cells.clearToZero();
    Buffer total(4);
    total.clear();
    const Framebuffer framebuffer = Framebuffer::withoutAttachments({32, 16});
    framebuffer.bind();
    cells.bindImage(0, GL_READ_WRITE);
    total.bindStorage(1);
    count.use();
    const gl::VertexArray vertexArray;
    vertexArray.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    EXPECT_EQ(total.read<unsigned>(1)[0], 32U * 16U);
    EXPECT_EQ(cells.read<unsigned>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1),
              (std::vector<unsigned>{0, 0, 0xFFFF, 0xFFFF}));
}

TEST_F(GlTest, NamesTheLimitThatIsExceeded) {
    const auto text = [](int value) { return std::to_string(value); };
    const gl::DeviceLimits& limits = device.limits();
    const int tooLargePx = limits.maxTextureSizePx + 1;
    EXPECT_EQ(errorText([&] {
                  Texture::make2D(GL_R8, {1, tooLargePx});
              }),
              "a 2D texture of " + text(tooLargePx) +
                  " pixels is beyond this device's GL_MAX_TEXTURE_SIZE = " +
                  text(limits.maxTextureSizePx));
    EXPECT_EQ(errorText([&] {
                  Texture::make2DArray(GL_R8, {1, 1}, limits.maxArrayLayers + 1);
              }),
              "a 2D array texture of " + text(limits.maxArrayLayers + 1) +
                  " layers is beyond this device's GL_MAX_ARRAY_TEXTURE_LAYERS = " +
                  text(limits.maxArrayLayers));
    EXPECT_EQ(errorText([&] {
                  Texture::make3D(GL_R8, {1, 1, limits.max3dTextureSizePx + 1});
              }),
              "a 3D texture of " + text(limits.max3dTextureSizePx + 1) +
                  " pixels is beyond this device's GL_MAX_3D_TEXTURE_SIZE = " +
                  text(limits.max3dTextureSizePx));
    EXPECT_THROW(Texture::makeCube(GL_R8, 1 << 20), UnsupportedError);
    EXPECT_THROW(Framebuffer::withoutAttachments({1 << 20, 1}), UnsupportedError);

    const auto tooLargeBytes = static_cast<std::size_t>(limits.maxStorageBlockBytes) + 4;
    const Buffer large(tooLargeBytes);
    EXPECT_EQ(errorText([&] { large.bindStorage(0); }),
              "a storage buffer of " + std::to_string(tooLargeBytes) +
                  " bytes is beyond this device's GL_MAX_SHADER_STORAGE_BLOCK_SIZE = " +
                  std::to_string(limits.maxStorageBlockBytes));
}

TEST_F(GlTest, RefusesAnIncompleteFramebuffer) {
    const Texture colour = Texture::make2D(GL_RGBA8, {4, 4});
    const Texture array = Texture::make2DArray(GL_RGBA8, {4, 4}, 2);
    EXPECT_EQ(errorText([&] {
                  Framebuffer(std::array{&colour, &array});
              }),
              "framebuffer is not complete: GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS");
}

TEST(ObjectsTest, AnUnknownFormatIsAnError) {
    // Not in the fixture: its debug output would count this error too.
    const gl::Device device = gl::Device::open({testDevice(), gl::DebugOutput::Off});
    EXPECT_EQ(errorText([] {
                  Texture::make2D(GL_RGBA, {4, 4});
              }),
              "glTextureStorage: GL_INVALID_ENUM");
}

TEST_F(GlTest, WorkQueryCountsPrimitivesFragmentsAndInvocations) {
    const Texture colour = Texture::make2D(GL_RGBA8, {16, 8});
    const Texture* colours[] = {&colour};
    const Framebuffer framebuffer(colours);
    framebuffer.bind();
    const gl::Program draw = program({{"whole.vert.glsl", kWholeTargetVertexShader},
                                      {"white.frag.glsl",
                                       "#version 450 core\nlayout(location = 0) out vec4 c;\n"
                                       "void main() { c = vec4(1.0); }\n"}});
    const gl::Program compute = program({{"nothing.comp.glsl",
                                          "#version 450 core\nlayout(local_size_x = 4) in;\n"
                                          "layout(std430, binding = 0) buffer B { uint n; };\n"
                                          "void main() { atomicAdd(n, 1u); }\n"}});
    const gl::VertexArray none;
    const Buffer count = Buffer::of(std::vector<unsigned>{0});
    count.bindStorage(0);
    const gl::WorkQuery query(device.hasExtension("GL_ARB_pipeline_statistics_query"));
    const gl::SampleQuery samples;
    query.begin();
    samples.begin();  // another query inside is no matter
    none.bind();
    draw.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    samples.end();
    compute.use();
    glDispatchCompute(3, 1, 1);
    query.end();
    EXPECT_EQ(samples.result(), 2U * 16 * 8);
    const std::optional<gl::Work> work = query.result();
    ASSERT_TRUE(work);
    EXPECT_EQ(work->primitives, 2U);
    EXPECT_GE(work->fragments, 2U * 16 * 8);
    EXPECT_EQ(work->invocations, 12U);
    EXPECT_FALSE(gl::WorkQuery(false).result());
}

}  // namespace
}  // namespace gfxrepro::test
