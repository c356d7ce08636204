#include "techniques/kit/prefix_sum.h"

#include <string>

namespace gfxrepro::kit {

PrefixSum::PrefixSum(const gl::ShaderLibrary& shaders, const char* type, unsigned binding,
                     Total total)
    : program_(shaders, {"kit/prefix_sum.comp.glsl"},
               {{"GROUP_SIZE", 256U},
                {"TYPE", std::string(type)},
                {"VALUES_BINDING", binding},
                {"TOTAL", total == Total::Behind ? 1 : 0}}),
      binding_(binding) {}

void PrefixSum::run(const gl::Buffer& values, unsigned count) const {
    values.bindStorage(binding_);
    program_.use();
    program_.set("count", count);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace gfxrepro::kit
