#include "runner/gl/barrier.h"

#include "runner/gl/gl.h"

namespace gfxrepro::gl {

void orderAllMemory() {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace gfxrepro::gl
