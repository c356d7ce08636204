// Outlook of [xie2017] Sec. 5.5.4: which reflections show, or showed, objects that have moved since
// the key frame.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflection_reuse/reflection_depth_image.h"

namespace gfxrepro::reflection_reuse {

/// Objects are their boxes. Then: the key frame's segments W → R through the box in which a moved
/// object was. Now: the mirror rays of the new view through the box in which it is, and samples of
/// reflectors that moved. A ray's length now is not known before it is traced, so that what stands
/// before the object does not save it from being traced.
class MovedObjects {
  public:
    MovedObjects(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx);

    /// Where the objects are in the key frame.
    void setKeyFrame(const reflections::GpuObjects& objects);
    /// Finds those that are elsewhere now. False: none.
    bool find(const reflections::GpuObjects& objects);

    /// Then; R8UI in the key frame's view, 1: passes a box.
    const gl::Texture& doubtful(const ReflectionDepthImage& key);
    /// Now; writes 1 into `wanted`.
    void want(const reflections::GpuObjects& objects, const reflections::GBuffer& gbuffer,
              float diagonalM, gl::Texture& wanted);
    std::size_t sizeBytes() const;

  private:
    gl::Pass then_, now_;
    gl::Texture doubtful_;
    gl::Framebuffer framebuffer_;
    std::vector<glm::mat4> keyPoses_;
    std::vector<scene::Box> keyBounds_;
    gl::Buffer moved_;
    unsigned movedCount_ = 0;
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::reflection_reuse
