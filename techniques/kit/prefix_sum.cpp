#include "techniques/kit/prefix_sum.h"

#include <string>

namespace gfxrepro::kit {

PrefixSum::PrefixSum(const gl::ShaderLibrary& shaders, const char* type, Total total)
    : pass_(shaders, {"kit/prefix_sum.comp.glsl"},
            {{"GROUP_SIZE", 256U},
             {"TYPE", std::string(type)},
             {"TOTAL", total == Total::Behind ? 1 : 0}}) {}

void PrefixSum::run(const gl::Buffer& values, unsigned count) const {
    pass_.set("count", count);
    pass_.dispatch({1, 1, 1}, {{"Values", values}});
}

}  // namespace gfxrepro::kit
