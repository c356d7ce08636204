#pragma once

namespace gfxrepro::gl {

/// What was written so far is seen by all that follows (GL_ALL_BARRIER_BITS); nothing waits for it
/// on the CPU. Between frames that are not finished one by one.
void orderAllMemory();

}  // namespace gfxrepro::gl
