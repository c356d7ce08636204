// Refinement of a mesh to a wanted number of triangles, without changing its surface.
#pragma once

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// `mesh` with the longest edges halved, longest first, until it has `triangleCount` triangles.
/// All triangles at an edge are split together (welded by position, so seams stay shut and no
/// T-junction arises); attributes are interpolated. Splitting an inner edge adds two triangles and
/// an edge of the boundary one: where the count cannot be met exactly the result is the next that
/// can, never below. Throws Error when the mesh has more triangles already, or none to split.
Mesh refinedTo(Mesh mesh, long long triangleCount);

}  // namespace gfxrepro::scene
