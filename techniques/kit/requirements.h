// What techniques ask of the case's scene.
#pragma once

#include <string_view>

#include "runner/technique/technique.h"

namespace gfxrepro::kit {

/// The case's scene. Throws Error where it has none.
const scene::Scene& requireScene(const technique::SetupContext& context,
                                 std::string_view technique);

/// The same with triangles, not all of whose points are one.
const scene::Scene& requireTriangles(const technique::SetupContext& context,
                                     std::string_view technique);

}  // namespace gfxrepro::kit
