// Passes over every pixel of a target.
#pragma once

#include "engine/gl/objects.h"

namespace gfxrepro::kit {

/// One triangle over the whole viewport of the bound framebuffer, for programs with
/// kit/whole_image.vert.glsl. All channels are written; no depth test, culling, blending or
/// scissors.
class WholeImage {
  public:
    void draw() const {
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_SCISSOR_TEST);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        vertexArray_.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

  private:
    gl::VertexArray vertexArray_;  // empty
};

}  // namespace gfxrepro::kit
