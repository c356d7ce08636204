#pragma once

#include "engine/gl/gl.h"

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

}  // namespace gfxrepro::gl
