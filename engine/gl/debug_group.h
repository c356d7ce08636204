// A name for what is drawn, in the tools that look at OpenGL's commands.
#pragma once

#include "engine/gl/device.h"
#include "engine/gl/gl.h"

namespace gfxrepro::gl {

/// The commands issued in its life are a group of that name (KHR_debug); none without a device.
class DebugGroup {
  public:
    DebugGroup(const Device& device, const char* name) : isOn_(!device.isNone()) {
        if (isOn_) glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
    }
    ~DebugGroup() {
        if (isOn_) glPopDebugGroup();
    }
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;

  private:
    bool isOn_;
};

}  // namespace gfxrepro::gl
