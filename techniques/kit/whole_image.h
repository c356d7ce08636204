// Passes over every pixel of a target.
#pragma once

#include "engine/gl/objects.h"

namespace gfxrepro::kit {

/// One triangle over the whole viewport of the bound framebuffer, for programs with
/// kit/whole_image.vert.glsl. All channels are written; no culling, blending or scissors.
class WholeImage {
  public:
    /// Every pixel.
    void draw() const {
        glDisable(GL_DEPTH_TEST);
        drawTriangle();
    }
    /// Chooses, in a depth buffer that was cleared to 0, the pixels whose fragments are not
    /// discarded.
    void drawChoosing() const { drawTested(GL_ALWAYS, GL_TRUE); }
    /// Those pixels alone: the others have no fragment at all.
    void drawChosen() const { drawTested(GL_LEQUAL, GL_FALSE); }

  private:
    void drawTriangle() const {
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glDisable(GL_SCISSOR_TEST);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        vertexArray_.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    void drawTested(GLenum test, GLboolean writes) const {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(test);
        glDepthMask(writes);
        drawTriangle();
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
        glDisable(GL_DEPTH_TEST);
    }

    gl::VertexArray vertexArray_;  // empty
};

}  // namespace gfxrepro::kit
