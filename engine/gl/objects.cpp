#include "engine/gl/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "engine/core/error.h"

namespace gfxrepro::gl {

void orderAllMemory() {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

GLbitfield ShaderAccesses::note(GLbitfield barrier, bool isWrite) {
    const GLbitfield needed = isWrite && isReadSince_ ? barrier : noteCommand(barrier);
    if (isWrite) noteUnorderedWrite();
    if (!isWrite) isReadSince_ = true;
    return needed;
}

void ShaderAccesses::noteUnorderedWrite() {
    unseenBy_ = GL_ALL_BARRIER_BITS;
    isReadSince_ = false;
}

GLbitfield ShaderAccesses::noteCommand(GLbitfield barrier) {
    const GLbitfield needed = unseenBy_ & barrier;
    unseenBy_ &= ~barrier;
    return needed;
}

void ShaderAccesses::await(GLbitfield barrier) {
    if (noteCommand(barrier) != 0) glMemoryBarrier(barrier);
}

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

Texture Texture::makeCube(GLenum format, int size) {
    checkLimit("a cube map", size, "pixels", getInteger(GL_MAX_CUBE_MAP_TEXTURE_SIZE),
               "GL_MAX_CUBE_MAP_TEXTURE_SIZE");
    return make(GL_TEXTURE_CUBE_MAP, format, {size, size, 6}, 1);
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

namespace {

void checkComplete(GLuint framebuffer) {
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) return;
    throw Error(fmt::format("framebuffer is not complete: {}", errorName(status)));
}

GLuint createFramebuffer() {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    return id;
}

void attachDepth(GLuint framebuffer, const Texture& depth) {
    const bool hasStencil =
        depth.format() == GL_DEPTH24_STENCIL8 || depth.format() == GL_DEPTH32F_STENCIL8;
    glNamedFramebufferTexture(
        framebuffer, hasStencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth.id(), 0);
}

GLuint createVertexArray() {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    return id;
}

}  // namespace

Framebuffer::Framebuffer(std::span<const Texture* const> colours, const Texture* depth)
    : name_(createFramebuffer()) {
    GFXREPRO_ASSERT(!colours.empty() || depth != nullptr);
    std::vector<GLenum> drawBuffers;
    for (const Texture* colour : colours) {
        const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + drawBuffers.size());
        glNamedFramebufferTexture(id(), attachment, colour->id(), 0);
        drawBuffers.push_back(attachment);
    }
    glNamedFramebufferDrawBuffers(id(), static_cast<GLsizei>(drawBuffers.size()),
                                  drawBuffers.data());
    if (depth != nullptr) attachDepth(id(), *depth);
    size_ = (colours.empty() ? depth : colours.front())->size();
    checkComplete(id());
}

Framebuffer Framebuffer::ofLayer(const Texture& colour, int layer, const Texture* depth) {
    Framebuffer framebuffer;
    framebuffer.name_ = detail::Name<detail::deleteFramebuffer>(createFramebuffer());
    framebuffer.size_ = colour.size();
    glNamedFramebufferTextureLayer(framebuffer.id(), GL_COLOR_ATTACHMENT0, colour.id(), 0, layer);
    if (depth != nullptr) attachDepth(framebuffer.id(), *depth);
    checkComplete(framebuffer.id());
    return framebuffer;
}

Framebuffer Framebuffer::withoutAttachments(glm::ivec2 size) {
    checkLimit("a framebuffer", size.x, "pixels", getInteger(GL_MAX_FRAMEBUFFER_WIDTH),
               "GL_MAX_FRAMEBUFFER_WIDTH");
    checkLimit("a framebuffer", size.y, "pixels", getInteger(GL_MAX_FRAMEBUFFER_HEIGHT),
               "GL_MAX_FRAMEBUFFER_HEIGHT");
    Framebuffer framebuffer;
    framebuffer.name_ = detail::Name<detail::deleteFramebuffer>(createFramebuffer());
    framebuffer.size_ = size;
    glNamedFramebufferParameteri(framebuffer.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
    glNamedFramebufferParameteri(framebuffer.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
    checkComplete(framebuffer.id());
    return framebuffer;
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::clearColour(int attachment, const glm::vec4& value) const {
    glClearNamedFramebufferfv(id(), GL_COLOR, attachment, &value.x);
}

void Framebuffer::clearDepth(float depth) const {
    glClearNamedFramebufferfv(id(), GL_DEPTH, 0, &depth);
}

VertexArray::VertexArray() : name_(createVertexArray()) {}

void VertexArray::setAttribute(GLuint location, const Buffer& buffer, int components) {
    const auto strideBytes = static_cast<GLsizei>(sizeof(float)) * components;
    glVertexArrayVertexBuffer(id(), location, buffer.id(), 0, strideBytes);
    glVertexArrayAttribFormat(id(), location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(id(), location, location);
    glEnableVertexArrayAttrib(id(), location);
}

void VertexArray::setInstanceIndex(GLuint location, const Buffer& buffer) {
    glVertexArrayVertexBuffer(id(), location, buffer.id(), 0, sizeof(GLuint));
    glVertexArrayAttribIFormat(id(), location, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayAttribBinding(id(), location, location);
    glVertexArrayBindingDivisor(id(), location, 1);
    glEnableVertexArrayAttrib(id(), location);
}

void VertexArray::setInstanceColumns(GLuint location, const Buffer& records, GLuint columns,
                                     int components, std::size_t strideBytes,
                                     std::size_t offsetBytes) {
    glVertexArrayVertexBuffer(id(), location, records.id(), static_cast<GLintptr>(offsetBytes),
                              static_cast<GLsizei>(strideBytes));
    glVertexArrayBindingDivisor(id(), location, 1);
    for (GLuint column = 0; column < columns; ++column) {
        glVertexArrayAttribFormat(id(), location + column, components, GL_FLOAT, GL_FALSE,
                                  column * 4 * sizeof(float));
        glVertexArrayAttribBinding(id(), location + column, location);
        glEnableVertexArrayAttrib(id(), location + column);
    }
}

void VertexArray::setIndices(const Buffer& indices) {
    glVertexArrayElementBuffer(id(), indices.id());
}

void VertexArray::bind() const {
    glBindVertexArray(id());
}

namespace {
constexpr GLenum kWorkTargets[] = {GL_PRIMITIVES_SUBMITTED, GL_FRAGMENT_SHADER_INVOCATIONS,
                                   GL_COMPUTE_SHADER_INVOCATIONS};
}  // namespace

WorkQuery::WorkQuery(bool isSupported) {
    for (std::size_t i = 0; isSupported && i < names_.size(); ++i) {
        GLuint id = 0;
        glGenQueries(1, &id);  // Mesa 22.3's glCreateQueries does not know these targets
        names_[i] = detail::Name<detail::deleteQuery>(id);
    }
}

void WorkQuery::begin() const {
    for (std::size_t i = 0; names_[0].get() != 0 && i < names_.size(); ++i) {
        glBeginQuery(kWorkTargets[i], names_[i].get());
    }
}

void WorkQuery::end() const {
    for (std::size_t i = 0; names_[0].get() != 0 && i < names_.size(); ++i) {
        glEndQuery(kWorkTargets[i]);
    }
}

std::optional<Work> WorkQuery::result() const {
    if (names_[0].get() == 0) return std::nullopt;
    GLuint64 counts[3] = {};
    for (std::size_t i = 0; i < names_.size(); ++i) {
        glGetQueryObjectui64v(names_[i].get(), GL_QUERY_RESULT, &counts[i]);
    }
    return Work{counts[0], counts[1], counts[2]};
}

}  // namespace gfxrepro::gl
