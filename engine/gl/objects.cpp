#include "engine/gl/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "engine/core/error.h"

namespace gfxrepro::gl {

namespace detail {
void deleteBuffer(GLuint id) {
    glDeleteBuffers(1, &id);
}
void deleteTexture(GLuint id) {
    glDeleteTextures(1, &id);
}
void deleteFramebuffer(GLuint id) {
    glDeleteFramebuffers(1, &id);
}
void deleteVertexArray(GLuint id) {
    glDeleteVertexArrays(1, &id);
}
void deleteQuery(GLuint id) {
    glDeleteQueries(1, &id);
}
void deleteProgram(GLuint id) {
    glDeleteProgram(id);
}
}  // namespace detail

namespace {

/// Throws UnsupportedError when `value` (of `unit`) is beyond the device's limit.
void checkLimit(const char* what, long long value, const char* unit, long long limit,
                const char* limitName) {
    if (value <= limit) return;
    throw UnsupportedError(fmt::format("{} of {} {} is beyond this device's {} = {}", what, value,
                                       unit, limitName, limit));
}

GLintptr bytes(std::size_t value) {
    return static_cast<GLintptr>(value);
}

}  // namespace

// ---- Buffer ----

Buffer::Buffer(std::size_t sizeBytes) : sizeBytes_(sizeBytes) {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    name_ = detail::Name<detail::deleteBuffer>(id);
    // Whole words, at least one: GL refuses empty storage, and clear() writes words.
    const std::size_t storageBytes = std::max<std::size_t>((sizeBytes + 3) / 4 * 4, 4);
    glNamedBufferStorage(id, bytes(storageBytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
    checkError("glNamedBufferStorage");
}

void Buffer::writeBytes(std::size_t offsetBytes, const void* data, std::size_t sizeBytes) {
    GFXREPRO_ASSERT(offsetBytes <= sizeBytes_ && sizeBytes <= sizeBytes_ - offsetBytes);
    awaitPasses(GL_BUFFER_UPDATE_BARRIER_BIT);
    glNamedBufferSubData(id(), bytes(offsetBytes), bytes(sizeBytes), data);
}

void Buffer::readBytes(std::size_t offsetBytes, void* data, std::size_t sizeBytes) const {
    GFXREPRO_ASSERT(offsetBytes <= sizeBytes_ && sizeBytes <= sizeBytes_ - offsetBytes);
    // Shader writes are seen by later reads only behind a barrier.
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(id(), bytes(offsetBytes), bytes(sizeBytes), data);
}

void Buffer::clear(std::uint32_t value) {
    awaitPasses(GL_BUFFER_UPDATE_BARRIER_BIT);
    accesses_ = {};  // what follows sees the clear, which is after all that was
    glClearNamedBufferData(id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

// Bound again and again within frames, so the device is asked only beyond what every one has (16
// MiB of storage, 16 KiB of uniforms), and once: a driver that has threads would wait for them.
constexpr std::size_t kStorageBytesOfAll = std::size_t{1} << 24;
constexpr std::size_t kUniformBytesOfAll = std::size_t{1} << 14;

void Buffer::bindStorage(GLuint binding) const {
    if (sizeBytes_ > kStorageBytesOfAll && !fitsStorage_) {
        checkLimit("a storage buffer", static_cast<long long>(sizeBytes_), "bytes",
                   getInteger64(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
                   "GL_MAX_SHADER_STORAGE_BLOCK_SIZE");
        fitsStorage_ = true;
    }
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

void Buffer::bindUniform(GLuint binding) const {
    if (sizeBytes_ > kUniformBytesOfAll) {
        checkLimit("a uniform buffer", static_cast<long long>(sizeBytes_), "bytes",
                   getInteger(GL_MAX_UNIFORM_BLOCK_SIZE), "GL_MAX_UNIFORM_BLOCK_SIZE");
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

// ---- Texture ----

namespace {

/// The length of a whole mipmap chain, down to one texel.
int fullLevels(int largestSizePx) {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(largestSizePx)));
}

int levelParameter(GLuint id, GLenum name) {
    GLint value = 0;
    glGetTextureLevelParameteriv(id, 0, name, &value);
    return value;
}

bool isInteger(GLuint id) {
    const int type = levelParameter(id, GL_TEXTURE_RED_TYPE);
    return type == GL_INT || type == GL_UNSIGNED_INT;
}

}  // namespace

Texture Texture::make(GLenum target, GLenum format, glm::ivec3 size, int levels) {
    GFXREPRO_ASSERT(size.x > 0 && size.y > 0 && size.z > 0 && levels >= 0);
    const bool is3d = target == GL_TEXTURE_3D;
    const int largest = std::max({size.x, size.y, is3d ? size.z : 1});
    if (levels == 0) levels = fullLevels(largest);

    GLuint id = 0;
    glCreateTextures(target, 1, &id);
    Texture texture;
    texture.name_ = detail::Name<detail::deleteTexture>(id);
    texture.target_ = target;
    texture.format_ = format;
    texture.size_ = size;
    if (is3d || target == GL_TEXTURE_2D_ARRAY) {
        glTextureStorage3D(id, levels, format, size.x, size.y, size.z);
    } else {
        glTextureStorage2D(id, levels, format, size.x, size.y);
    }
    checkError("glTextureStorage");
    // A sampler without mipmaps must not ask for them: the default minification filter does, and
    // integer textures allow nothing but nearest.
    texture.setFilter(GL_NEAREST, GL_NEAREST);
    texture.setWrap(GL_CLAMP_TO_EDGE);
    return texture;
}

Texture Texture::make2D(GLenum format, glm::ivec2 size, int levels) {
    checkLimit("a 2D texture", std::max(size.x, size.y), "pixels", getInteger(GL_MAX_TEXTURE_SIZE),
               "GL_MAX_TEXTURE_SIZE");
    return make(GL_TEXTURE_2D, format, {size, 1}, levels);
}

Texture Texture::make2DArray(GLenum format, glm::ivec2 size, int layers, int levels) {
    checkLimit("a 2D array texture", std::max(size.x, size.y), "pixels",
               getInteger(GL_MAX_TEXTURE_SIZE), "GL_MAX_TEXTURE_SIZE");
    checkLimit("a 2D array texture", layers, "layers", getInteger(GL_MAX_ARRAY_TEXTURE_LAYERS),
               "GL_MAX_ARRAY_TEXTURE_LAYERS");
    return make(GL_TEXTURE_2D_ARRAY, format, {size, layers}, levels);
}

Texture Texture::make3D(GLenum format, glm::ivec3 size, int levels) {
    checkLimit("a 3D texture", std::max({size.x, size.y, size.z}), "pixels",
               getInteger(GL_MAX_3D_TEXTURE_SIZE), "GL_MAX_3D_TEXTURE_SIZE");
    return make(GL_TEXTURE_3D, format, size, levels);
}

Texture Texture::makeCube(GLenum format, int size, int levels) {
    checkLimit("a cube map", size, "pixels", getInteger(GL_MAX_CUBE_MAP_TEXTURE_SIZE),
               "GL_MAX_CUBE_MAP_TEXTURE_SIZE");
    return make(GL_TEXTURE_CUBE_MAP, format, {size, size, 6}, levels);
}

Texture Texture::viewOfLevel(int level) const {
    GFXREPRO_ASSERT(target_ == GL_TEXTURE_2D && level >= 0);
    GLuint id = 0;
    glGenTextures(1, &id);  // not glCreateTextures: a view's name has no target yet
    Texture view;
    view.name_ = detail::Name<detail::deleteTexture>(id);
    view.target_ = target_;
    view.format_ = format_;
    view.size_ = {std::max(size_.x >> level, 1), std::max(size_.y >> level, 1), 1};
    glTextureView(id, target_, this->id(), format_, static_cast<GLuint>(level), 1, 0, 1);
    checkError("glTextureView");
    view.setFilter(GL_NEAREST, GL_NEAREST);
    view.setWrap(GL_CLAMP_TO_EDGE);
    return view;
}

Texture Texture::fromImage(const image::Image8& image, bool isSrgb) {
    const int channels = image.channels();
    GFXREPRO_ASSERT(channels <= 4 && (!isSrgb || channels >= 3));
    constexpr GLenum kPixelFormats[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    constexpr GLenum kLinear[] = {GL_R8, GL_RG8, GL_RGB8, GL_RGBA8};
    constexpr GLenum kSrgb[] = {0, 0, GL_SRGB8, GL_SRGB8_ALPHA8};
    Texture texture =
        make2D((isSrgb ? kSrgb : kLinear)[channels - 1], {image.width(), image.height()}, 0);
    texture.upload(kPixelFormats[channels - 1], GL_UNSIGNED_BYTE, image.values().data());
    texture.generateMipmaps();
    texture.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    texture.setWrap(GL_REPEAT);
    return texture;
}

std::size_t Texture::sizeBytes() const {
    if (id() == 0) return 0;
    std::size_t texelBits = 0;
    for (const GLenum component :
         {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
          GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE, GL_TEXTURE_SHARED_SIZE}) {
        texelBits += static_cast<std::size_t>(levelParameter(id(), component));
    }
    GLint levels = 0;
    glGetTextureParameteriv(id(), GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
    std::size_t texels = 0;
    for (int level = 0; level < levels; ++level) {
        const glm::ivec3 reduced = glm::max(size_ >> level, glm::ivec3(1));
        const int depth = target_ == GL_TEXTURE_3D ? reduced.z : size_.z;
        texels += static_cast<std::size_t>(reduced.x) * static_cast<std::size_t>(reduced.y) *
                  static_cast<std::size_t>(depth);
    }
    return texels * texelBits / 8;
}

void Texture::upload(GLenum pixelFormat, GLenum pixelType, const void* data, int level) {
    awaitPasses(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const int width = std::max(size_.x >> level, 1), height = std::max(size_.y >> level, 1);
    if (target_ == GL_TEXTURE_2D) {
        glTextureSubImage2D(id(), level, 0, 0, width, height, pixelFormat, pixelType, data);
    } else {
        const int depth = target_ == GL_TEXTURE_3D ? std::max(size_.z >> level, 1) : size_.z;
        glTextureSubImage3D(id(), level, 0, 0, 0, width, height, depth, pixelFormat, pixelType,
                            data);
    }
    checkError("glTextureSubImage");
}

void Texture::readBytes(GLenum pixelFormat, GLenum pixelType, void* data,
                        std::size_t sizeBytes) const {
    // Image stores are seen by later reads only behind a barrier.
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    checkLimit("reading a texture", static_cast<long long>(sizeBytes), "bytes",
               std::numeric_limits<GLsizei>::max(), "largest transfer");
    const auto bufferBytes = static_cast<GLsizei>(sizeBytes);
    glGetTextureImage(id(), 0, pixelFormat, pixelType, bufferBytes, data);
    checkError("glGetTextureImage");
}

image::ImageF Texture::readImage(int channels) const {
    GFXREPRO_ASSERT(target_ == GL_TEXTURE_2D && channels >= 1 && channels <= 4);
    constexpr GLenum kPixelFormats[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    const std::vector<float> rowsFromBottom =
        read<float>(kPixelFormats[channels - 1], GL_FLOAT, channels);
    image::ImageF image(size_.x, size_.y, channels);
    const auto rowValues = static_cast<std::ptrdiff_t>(size_.x) * channels;
    for (int y = 0; y < size_.y; ++y) {
        std::copy_n(rowsFromBottom.begin() + (size_.y - 1 - y) * rowValues, rowValues,
                    image.row(y).begin());
    }
    return image;
}

void Texture::clearToZero() {
    awaitPasses(GL_TEXTURE_UPDATE_BARRIER_BIT);
    const bool hasDepth = levelParameter(id(), GL_TEXTURE_DEPTH_SIZE) > 0;
    const bool hasStencil = levelParameter(id(), GL_TEXTURE_STENCIL_SIZE) > 0;
    if (hasDepth && hasStencil) {
        glClearTexImage(id(), 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, nullptr);
    } else if (hasDepth) {
        glClearTexImage(id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    } else if (isInteger(id())) {
        glClearTexImage(id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    } else {
        glClearTexImage(id(), 0, GL_RED, GL_FLOAT, nullptr);
    }
    checkError("glClearTexImage");
}

void Texture::setFilter(GLenum minification, GLenum magnification) {
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minification));
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnification));
}

void Texture::setWrap(GLenum mode) {
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
        glTextureParameteri(id(), axis, static_cast<GLint>(mode));
    }
}

void Texture::generateMipmaps() {
    awaitPasses(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGenerateTextureMipmap(id());
}

void Texture::bind(GLuint unit) const {
    glBindTextureUnit(unit, id());
}

void Texture::bindImage(GLuint unit, GLenum access) const {
    glBindImageTexture(unit, id(), 0, GL_TRUE, 0, access, format_);
}

void Texture::bindImageLayer(GLuint unit, int layer, GLenum access) const {
    glBindImageTexture(unit, id(), 0, GL_FALSE, layer, access, format_);
}

SampleQuery::SampleQuery() {
    GLuint id = 0;
    glCreateQueries(GL_SAMPLES_PASSED, 1, &id);
    name_ = detail::Name<detail::deleteQuery>(id);
}

void SampleQuery::begin() const {
    glBeginQuery(GL_SAMPLES_PASSED, name_.get());
}

void SampleQuery::end() const {
    glEndQuery(GL_SAMPLES_PASSED);
}

std::uint64_t SampleQuery::result() const {
    GLuint64 count = 0;
    glGetQueryObjectui64v(name_.get(), GL_QUERY_RESULT, &count);
    return count;
}

PrimitiveQuery::PrimitiveQuery() {
    GLuint id = 0;
    glCreateQueries(GL_PRIMITIVES_GENERATED, 1, &id);
    name_ = detail::Name<detail::deleteQuery>(id);
}

void PrimitiveQuery::begin() const {
    glBeginQuery(GL_PRIMITIVES_GENERATED, name_.get());
}

void PrimitiveQuery::end() const {
    glEndQuery(GL_PRIMITIVES_GENERATED);
}

std::uint64_t PrimitiveQuery::result() const {
    GLuint64 count = 0;
    glGetQueryObjectui64v(name_.get(), GL_QUERY_RESULT, &count);
    return count;
}

}  // namespace gfxrepro::gl
