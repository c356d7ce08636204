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

// The GL drivers that GLVND, the loader of EGL, would take.

/// Of each driver that a JSON file names to GLVND and that cannot be loaded, a sentence with the
/// file, the library, and the reason that the system's loader gives. Loads each for a moment.
std::vector<std::string> vendorLibraryProblems();

}  // namespace gfxrepro::gl
