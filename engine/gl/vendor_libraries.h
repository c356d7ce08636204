// The GL drivers that GLVND, the loader of EGL, would take.
#pragma once

#include <string>
#include <vector>

namespace gfxrepro::gl {

/// Of each driver that a JSON file names to GLVND and that cannot be loaded, a sentence with the
/// file, the library, and the reason that the system's loader gives. Loads each for a moment.
std::vector<std::string> vendorLibraryProblems();

}  // namespace gfxrepro::gl
