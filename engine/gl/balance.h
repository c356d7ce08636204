// How fast a device does each kind of work, beside the methods that are compared on it.
#pragma once

#include "engine/gl/device.h"
#include "engine/gl/program.h"

namespace gfxrepro::gl {

/// Of the device whose context is current, in a second or two: each kind of work is doubled until
/// it takes 20 ms or a half of a second is over, and the fastest of three is taken. The shaders are
/// <library>/gl/balance_….
DeviceBalance measureBalance(const ShaderLibrary& library);

}  // namespace gfxrepro::gl
