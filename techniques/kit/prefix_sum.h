// Prefix sums on the device.
#pragma once

#include <string>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"

namespace gfxrepro::kit {

/// Each value becomes the sum of those before it. One work group, whose invocations take shares of
/// consecutive values: for counts of runs or tiles, of which there are some thousands.
class PrefixSum {
  public:
    enum class Total { None, Behind };

    /// Of values of the GLSL type `type` ("uint", "uvec4").
    PrefixSum(const gl::ShaderLibrary& shaders, const char* type, Total total)
        : pass_(shaders, {"kit/prefix_sum.comp.glsl"},
                {{"GROUP_SIZE", 256U},
                 {"TYPE", std::string(type)},
                 {"TOTAL", total == Total::Behind ? 1 : 0}}) {}
    /// Of the first `count` values. With Total::Behind the sum of all follows them, for which the
    /// buffer must have room.
    void run(const gl::Buffer& values, unsigned count) const {
        pass_.set("count", count);
        pass_.dispatch({1, 1, 1}, {{"Values", values}});
    }

  private:
    gl::Pass pass_;
};

}  // namespace gfxrepro::kit
