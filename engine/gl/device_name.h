// How a command line names a device.
#pragma once

#include <string>

namespace gfxrepro::gl {

/// Throws UsageError unless `name` is auto, gpu, software, none, an index or a UUID.
void requireDeviceName(const std::string& name);

}  // namespace gfxrepro::gl
