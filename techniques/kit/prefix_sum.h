// Prefix sums on the device.
#pragma once

#include "runner/gl/objects.h"
#include "runner/gl/program.h"

namespace gfxrepro::kit {

/// Each value becomes the sum of those before it. One work group, whose invocations take shares of
/// consecutive values: for counts of runs or tiles, of which there are some thousands.
class PrefixSum {
  public:
    enum class Total { None, Behind };

    /// Of values of the GLSL type `type` ("uint", "uvec4"); `binding` is the storage binding that
    /// it takes.
    PrefixSum(const gl::ShaderLibrary& shaders, const char* type, unsigned binding, Total total);
    /// Of the first `count` values. With Total::Behind the sum of all follows them, for which the
    /// buffer must have room. Ends with a barrier for storage and for
    /// reading back.
    void run(const gl::Buffer& values, unsigned count) const;

  private:
    gl::Program program_;
    unsigned binding_;
};

}  // namespace gfxrepro::kit
