// Draws that are flushed now and then, what they test, and the size of dispatches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <type_traits>

#include "engine/gl/device.h"
#include "engine/gl/gl.h"

namespace gfxrepro::kit {

/// Cuts draws into pieces and flushes them where the device is a software one: llvmpipe keeps every
/// primitive of a draw in memory until it is flushed, of a triangle about 80 bytes, twice. Small
/// draws share a flush. Other devices get each draw whole, and no flush.
class FlushedDraws {
  public:
    static constexpr std::uint32_t kPrimitivesPerFlush = 1U << 16;

    explicit FlushedDraws(bool splits = gl::isSoftwareContext(),
                          std::uint32_t perFlush = kPrimitivesPerFlush)
        : mostPrimitives_(splits ? perFlush : kMostOfADraw) {}

    /// As many primitives a caller may put into one draw that it cuts itself.
    std::uint32_t mostPrimitives() const { return mostPrimitives_; }
    /// After such a draw.
    void drawn(std::uint32_t count) {
        unflushed_ += count;
        if (mostPrimitives_ == kMostOfADraw || unflushed_ < mostPrimitives_) return;
        glFlush();
        unflushed_ = 0;
    }

    /// Calls draw(first, count) for pieces of the triangles [first, first + count).
    template <class Draw>
    void draw(std::uint32_t first, std::uint32_t count, const Draw& draw) {
        for (std::uint32_t done = 0; done < count; done += mostPrimitives_) {
            const std::uint32_t piece = std::min(count - done, mostPrimitives_);
            draw(first + done, piece);
            drawn(piece);
        }
    }

  private:
    // Of triangles GL counts the indices, in a signed number.
    static constexpr std::uint32_t kMostOfADraw = (1U << 31) / 3;

    std::uint32_t mostPrimitives_;
    std::uint32_t unflushed_ = 0;
};

/// Where triangle `first` begins in a buffer of 32-bit indices, as draws take it.
inline const void* indexOffset(std::uint32_t first) {
    return reinterpret_cast<const void*>(static_cast<std::size_t>(first) * sizeof(glm::uvec3));
}

/// Triangles of the vertex array that is bound, by 32-bit indices.
inline void drawTriangles(std::uint32_t first, std::uint32_t count) {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                   indexOffset(first));
}

/// For draws of which the nearest fragment stays: all channels and depths are written; no culling,
/// blending or scissors.
inline void setNearestWins(GLenum nearer = GL_LESS) {
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(nearer);
    glDepthMask(GL_TRUE);
}

/// Work groups of `groupSize` that `count` invocations take.
template <class Count>
GLuint groupsFor(Count count, std::type_identity_t<Count> groupSize) {
    return static_cast<GLuint>((count + groupSize - 1) / groupSize);
}

}  // namespace gfxrepro::kit
