// What has been asked of GL. Tests that link gl_calls.cpp call these functions of GL through it.
#pragma once

#include <vector>

namespace gfxrepro::reflections {

enum class GlCall {
    DrawObject,  // glDrawElementsInstancedBaseInstance
    DrawList,    // glDrawElements, glDrawElementsIndirect
    Flush,       // glFlush
    SetView,     // glProgramUniformMatrix4fv: a program is told of a frame's view
    Barrier,     // glMemoryBarrier
    Parameter,   // glTextureParameteri: the driver validates the texture anew
    Write,       // glNamedBufferSubData: into what the device may still read
    Wait,        // what the host cannot go on without: read-backs, results of queries, glFinish
};

/// In order, since the last clear().
std::vector<GlCall>& glCalls();

}  // namespace gfxrepro::reflections
