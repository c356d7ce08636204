// What the system's kernel shows of GPUs, whether a driver opens them or not.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gfxrepro::gl {

/// A sentence for each GPU that has a file below `devices`: "/dev/nvidia0: Permission denied", or
/// that no driver gave an OpenGL device for it. Displays of virtual machines without arithmetic of
/// their own, as `drivers` (a folder like /sys/class/drm) names their drivers, are none.
/// Asked where no GPU served.
std::vector<std::string> unusedGpus(const std::filesystem::path& devices = "/dev",
                                    const std::filesystem::path& drivers = "/sys/class/drm");

}  // namespace gfxrepro::gl
