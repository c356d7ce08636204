#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/gl/objects.h"

namespace gfxrepro::gl {

namespace {

std::string statusName(GLenum status) {
    switch (status) {
        case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
            return "GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT";
        case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
            return "GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT";
        case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
            return "GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER";
        case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
            return "GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE";
        case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
            return "GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS";
        case GL_FRAMEBUFFER_UNSUPPORTED:
            return "GL_FRAMEBUFFER_UNSUPPORTED";
        default:
            return errorName(status);
    }
}

void checkComplete(GLuint framebuffer) {
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) return;
    throw Error(fmt::format("framebuffer is not complete: {}", statusName(status)));
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

Framebuffer Framebuffer::withoutAttachments(glm::ivec2 size, int samples) {
    const glm::ivec3 wanted(size, samples);
    const glm::ivec3 limit(getInteger(GL_MAX_FRAMEBUFFER_WIDTH),
                           getInteger(GL_MAX_FRAMEBUFFER_HEIGHT),
                           getInteger(GL_MAX_FRAMEBUFFER_SAMPLES));
    if (glm::any(glm::greaterThan(wanted, limit))) {
        throw UnsupportedError(fmt::format(
            "a framebuffer of {} × {} pixels with {} samples is beyond this device's {} × {} with "
            "{} (GL_MAX_FRAMEBUFFER_WIDTH, _HEIGHT, _SAMPLES)",
            wanted.x, wanted.y, wanted.z, limit.x, limit.y, limit.z));
    }
    Framebuffer framebuffer;
    framebuffer.name_ = detail::Name<detail::deleteFramebuffer>(createFramebuffer());
    framebuffer.size_ = size;
    glNamedFramebufferParameteri(framebuffer.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
    glNamedFramebufferParameteri(framebuffer.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
    glNamedFramebufferParameteri(framebuffer.id(), GL_FRAMEBUFFER_DEFAULT_SAMPLES, samples);
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

void VertexArray::setIndices(const Buffer& indices) {
    glVertexArrayElementBuffer(id(), indices.id());
}

void VertexArray::bind() const {
    glBindVertexArray(id());
}

}  // namespace gfxrepro::gl
