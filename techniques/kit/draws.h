// Draws that are flushed now and then, and the size of dispatches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <type_traits>

#include "runner/gl/gl.h"

namespace gfxrepro::kit {

/// llvmpipe keeps every primitive of a draw in memory until it is flushed, of a triangle about 80
/// bytes, twice.
constexpr std::uint32_t kPrimitivesPerFlush = 1U << 16;

/// Cuts draws into pieces and flushes after `mostTriangles`, so that the memory that a software
/// device takes does not grow with the scene. Small draws share a flush.
class FlushedDraws {
  public:
    explicit FlushedDraws(std::uint32_t mostTriangles = kPrimitivesPerFlush)
        : mostTriangles_(mostTriangles) {}

    /// Calls draw(first, count) for pieces of the triangles [first, first + count).
    template <class Draw>
    void draw(std::uint32_t first, std::uint32_t count, const Draw& draw) {
        for (std::uint32_t done = 0; done < count; done += mostTriangles_) {
            const std::uint32_t piece = std::min(count - done, mostTriangles_);
            draw(first + done, piece);
            unflushed_ += piece;
            if (unflushed_ < mostTriangles_) continue;
            glFlush();
            unflushed_ = 0;
        }
    }

  private:
    std::uint32_t mostTriangles_;
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

/// Work groups of `groupSize` that `count` invocations take.
template <class Count>
GLuint groupsFor(Count count, std::type_identity_t<Count> groupSize) {
    return static_cast<GLuint>((count + groupSize - 1) / groupSize);
}

}  // namespace gfxrepro::kit
