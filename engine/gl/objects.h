// Move-only owners of OpenGL names, made with direct state access. A default-constructed one is
// empty. Every constructor and function needs the device's context to be current.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/gl/gl.h"
#include "engine/image/image.h"

namespace gfxrepro::gl {

/// What was written so far is seen by all that follows (GL_ALL_BARRIER_BITS); nothing waits for it
/// on the CPU. Between frames that are not finished one by one.
void orderAllMemory();

/// What the passes did last to a buffer or a texture, and so the barriers that its next use needs
/// (OpenGL 4.5, 7.12.2): GL orders no use after a shader's write, and no shader's write after an
/// earlier shader's read.
class ShaderAccesses {
  public:
    /// Notes a use by a pass. `barrier` is the bit of glMemoryBarrier for that kind of use. Returns
    /// the bit where the use must wait for earlier ones, or 0.
    GLbitfield note(GLbitfield barrier, bool isWrite);
    /// A write by a pass that waits for none of the earlier uses.
    void noteUnorderedWrite();
    /// As note(), for a use by a command (a copy, a clear, a draw's arguments), which GL orders
    /// before what follows it.
    GLbitfield noteCommand(GLbitfield barrier);
    /// noteCommand(), and the barrier where one is needed.
    void await(GLbitfield barrier);

  private:
    GLbitfield unseenBy_ = 0;  // kinds of use that no barrier lets see the last write yet
    bool isReadSince_ = false;
};

namespace detail {
/// A GL name and the function that deletes it.
template <void (*Delete)(GLuint)>
class Name {
  public:
    Name() = default;
    explicit Name(GLuint id) : id_(id) {}
    Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Name& operator=(Name&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Name() {
        if (id_ != 0) Delete(id_);
    }
    GLuint get() const { return id_; }

  private:
    GLuint id_ = 0;
};
void deleteBuffer(GLuint id);
void deleteTexture(GLuint id);
void deleteFramebuffer(GLuint id);
void deleteVertexArray(GLuint id);
void deleteQuery(GLuint id);
void deleteProgram(GLuint id);
}  // namespace detail

class Buffer {
  public:
    Buffer() = default;
    /// Immutable storage of `sizeBytes` (rounded up to whole words), undefined content; updatable
    /// by write(). Throws std::bad_alloc when the device refuses it.
    explicit Buffer(std::size_t sizeBytes);
    template <class T>
    static Buffer of(std::span<const T> values) {
        Buffer buffer(values.size_bytes());
        if (!values.empty()) buffer.writeBytes(0, values.data(), values.size_bytes());
        return buffer;
    }
    template <class T>
    static Buffer of(const std::vector<T>& values) {
        return of(std::span<const T>(values));
    }

    GLuint id() const { return name_.get(); }
    std::size_t sizeBytes() const { return sizeBytes_; }

    template <class T>
    void write(std::span<const T> values, std::size_t offsetBytes = 0) {
        writeBytes(offsetBytes, values.data(), values.size_bytes());
    }
    /// Reads `count` values from `offsetBytes`; waits for the device.
    template <class T>
    std::vector<T> read(std::size_t count, std::size_t offsetBytes = 0) const {
        std::vector<T> values(count);
        readBytes(offsetBytes, values.data(), count * sizeof(T));
        return values;
    }
    /// Fills with one 32-bit value.
    void clear(std::uint32_t value = 0);
    /// GL_SHADER_STORAGE_BUFFER. Throws UnsupportedError beyond GL_MAX_SHADER_STORAGE_BLOCK_SIZE
    /// (128 MiB on llvmpipe).
    void bindStorage(GLuint binding) const;
    /// GL_UNIFORM_BUFFER. Throws UnsupportedError beyond GL_MAX_UNIFORM_BLOCK_SIZE.
    void bindUniform(GLuint binding) const;
    /// What passes did to it; kept by Pass.
    ShaderAccesses& accesses() const { return accesses_; }
    /// Commands see what passes wrote: `barrier` is the bit of glMemoryBarrier for their use of it
    /// (GL_COMMAND_BARRIER_BIT of a draw's arguments, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT, …).
    void awaitPasses(GLbitfield barrier) const { accesses_.await(barrier); }

  private:
    void writeBytes(std::size_t offsetBytes, const void* data, std::size_t sizeBytes);
    void readBytes(std::size_t offsetBytes, void* data, std::size_t sizeBytes) const;

    detail::Name<detail::deleteBuffer> name_;
    std::size_t sizeBytes_ = 0;
    mutable bool fitsStorage_ = false;  // the device was asked
    mutable ShaderAccesses accesses_;
};

class Texture {
  public:
    Texture() = default;
    /// Immutable storage. `format` is sized (GL_R32UI, GL_RGBA16F, GL_DEPTH_COMPONENT32F, …);
    /// levels 0: all. Sampled nearest and clamped to the edge until set otherwise. Throws
    /// UnsupportedError naming the limit that the size is beyond, std::bad_alloc.
    static Texture make2D(GLenum format, glm::ivec2 size, int levels = 1);
    static Texture make2DArray(GLenum format, glm::ivec2 size, int layers, int levels = 1);
    static Texture make3D(GLenum format, glm::ivec3 size, int levels = 1);
    static Texture makeCube(GLenum format, int size);
    /// 8-bit image, 1 to 4 channels (3 or 4 when `isSrgb`, which decodes in the sampler);
    /// mipmapped, sampled trilinearly, repeating. The image's top row is at v = 0, as glTF has it.
    static Texture fromImage(const image::Image8& image, bool isSrgb);

    /// One level of a 2D texture as a texture of its own: the same texels, which live as long as
    /// one of the two does. So a level can be read while another one is drawn into.
    Texture viewOfLevel(int level) const;

    GLuint id() const { return name_.get(); }
    GLenum target() const { return target_; }
    GLenum format() const { return format_; }
    glm::ivec3 size() const { return size_; }
    /// All levels, by the bits that the device keeps a texel in.
    std::size_t sizeBytes() const;

    /// A level, whole; `pixelFormat` and `pixelType` say how `data` is laid out.
    void upload(GLenum pixelFormat, GLenum pixelType, const void* data, int level = 0);
    /// Level 0, whole, rows from the bottom as GL stores them; waits for the device.
    template <class T>
    std::vector<T> read(GLenum pixelFormat, GLenum pixelType, int components) const {
        std::vector<T> values(
            static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
            static_cast<std::size_t>(size_.z) * static_cast<std::size_t>(components));
        readBytes(pixelFormat, pixelType, values.data(), values.size() * sizeof(T));
        return values;
    }
    /// A 2D colour texture as an image, rows from the top.
    image::ImageF readImage(int channels) const;

    /// Fills level 0 with zero bits.
    void clearToZero();
    void setFilter(GLenum minification, GLenum magnification);
    void setWrap(GLenum mode);
    void generateMipmaps();
    void bind(GLuint unit) const;
    /// Whole level 0 (all layers) as an image in the texture's own format.
    void bindImage(GLuint unit, GLenum access) const;
    /// One layer of level 0 of an array.
    void bindImageLayer(GLuint unit, int layer, GLenum access) const;
    /// What passes did to it; kept by Pass. A view and its texture have one each.
    ShaderAccesses& accesses() const { return accesses_; }
    /// As Buffer's; GL_FRAMEBUFFER_BARRIER_BIT before it is drawn into.
    void awaitPasses(GLbitfield barrier) const { accesses_.await(barrier); }

  private:
    void readBytes(GLenum pixelFormat, GLenum pixelType, void* data, std::size_t sizeBytes) const;
    static Texture make(GLenum target, GLenum format, glm::ivec3 size, int levels);

    detail::Name<detail::deleteTexture> name_;
    GLenum target_ = 0;
    GLenum format_ = 0;
    glm::ivec3 size_{0};
    mutable ShaderAccesses accesses_;
};

class Framebuffer {
  public:
    Framebuffer() = default;
    /// Colour attachments in order; `depth` may be null. Throws Error when it is not complete.
    explicit Framebuffer(std::span<const Texture* const> colours, const Texture* depth = nullptr);
    /// One layer of an array or one face of a cube map (+x, −x, +y, …) as the colour attachment;
    /// `depth`, which may be null, is a 2D texture. Throws Error when it is not complete.
    static Framebuffer ofLayer(const Texture& colour, int layer, const Texture* depth = nullptr);
    /// No attachments: for draws that write images only. Throws UnsupportedError beyond the
    /// device's limits.
    static Framebuffer withoutAttachments(glm::ivec2 size);

    GLuint id() const { return name_.get(); }
    /// Binds for drawing and sets the viewport to the whole.
    void bind() const;
    void clearColour(int attachment, const glm::vec4& value) const;
    void clearDepth(float depth) const;

  private:
    detail::Name<detail::deleteFramebuffer> name_;
    glm::ivec2 size_{0};
};

/// Counts what the draws between begin() and end() do.
template <GLenum Target>
class Query {
  public:
    Query() {
        GLuint id = 0;
        glCreateQueries(Target, 1, &id);
        name_ = detail::Name<detail::deleteQuery>(id);
    }
    void begin() const { glBeginQuery(Target, name_.get()); }
    void end() const { glEndQuery(Target); }
    /// Of the last begin() … end(); waits for the device.
    std::uint64_t result() const {
        GLuint64 count = 0;
        glGetQueryObjectui64v(name_.get(), GL_QUERY_RESULT, &count);
        return count;
    }

  private:
    detail::Name<detail::deleteQuery> name_;
};
/// Of samples that pass all tests.
using SampleQuery = Query<GL_SAMPLES_PASSED>;
/// Of primitives that are handed to the rasterizer, before clipping.
using PrimitiveQuery = Query<GL_PRIMITIVES_GENERATED>;

class VertexArray {
  public:
    /// Makes an empty array object (for draws without attributes).
    VertexArray();
    static VertexArray none() { return VertexArray(nullptr); }

    GLuint id() const { return name_.get(); }
    /// Float attribute `location` of `components` values a vertex, tightly packed in `buffer`.
    void setAttribute(GLuint location, const Buffer& buffer, int components);
    /// One 32-bit unsigned integer an instance.
    void setInstanceIndex(GLuint location, const Buffer& buffer);
    /// A matrix an instance: a location a column of `components` floats, 16 bytes from the next,
    /// the first at `offsetBytes` of records of `strideBytes`.
    void setInstanceColumns(GLuint location, const Buffer& records, GLuint columns, int components,
                            std::size_t strideBytes, std::size_t offsetBytes);
    /// 32-bit indices.
    void setIndices(const Buffer& indices);
    void bind() const;

  private:
    explicit VertexArray(std::nullptr_t) {}
    detail::Name<detail::deleteVertexArray> name_;
};

// How much work a stretch of commands is, for guarding times against unequal work.

/// What the commands between begin() and end() made the device do.
struct Work {
    std::uint64_t primitives = 0;   // handed to the pipeline by draws
    std::uint64_t fragments = 0;    // fragment shader invocations
    std::uint64_t invocations = 0;  // of compute shaders

    bool operator==(const Work&) const = default;
};

/// Counts Work by pipeline statistics, which no SampleQuery or PrimitiveQuery inside disturbs.
/// Devices without ARB_pipeline_statistics_query count nothing.
class WorkQuery {
  public:
    explicit WorkQuery(bool isSupported);
    void begin() const;
    void end() const;
    /// Of the last begin() … end(); waits for the device. Null where it is not supported.
    std::optional<Work> result() const;

  private:
    std::array<detail::Name<detail::deleteQuery>, 3> names_;
};

}  // namespace gfxrepro::gl
