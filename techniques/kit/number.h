// Parameters that are floats.
#pragma once

#include <fmt/format.h>

#include <string>

#include "engine/core/params.h"

namespace gfxrepro::kit {

/// A declared number. Of a fallback of 0.7 that, not what a float makes of it, goes into manifests.
inline float number(Params& params, const char* name, float fallback, const ParamSpec& spec) {
    const double written = std::stod(fmt::format("{:g}", fallback));
    return static_cast<float>(params.getDouble(name, written, spec));
}

}  // namespace gfxrepro::kit
