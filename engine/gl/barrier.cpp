#include "engine/gl/barrier.h"

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

}  // namespace gfxrepro::gl
