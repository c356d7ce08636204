// A device and the shaders for tests of the voxelization passes.
#pragma once

#include "engine/gl/profiler.h"
#include "tests/gl/suite_device.h"
#include "tests/techniques/technique_recorder.h"

namespace gfxrepro::voxelization {

class GlTest : public test::SuiteDeviceTest {
  protected:
    /// For sources that need no scene.
    technique::SetupContext setupContext() {
        return {device(), shaders(), scenes_, nullptr, {64, 64}, 1, profiler_};
    }
    gl::Profiler& profiler() { return profiler_; }

  private:
    test::NoScenes scenes_;
    gl::Profiler profiler_{true};
};

}  // namespace gfxrepro::voxelization
