// A reconstructed mesh with fewer triangles ([xie2017] names it as future work).
#pragma once

#include "engine/scene/scene.h"

namespace gfxrepro::soft_shadows {

struct SimplificationSettings {
    float triangleRatio = 0.1F;  // of the triangles, at least that many stay
    /// How far the surface may move, in metres: it ends the simplification even where more
    /// triangles than asked for are left.
    float maxErrorM = 0.01F;
};

struct SimplifiedMesh {
    scene::Mesh mesh;
    float errorM = 0.0F;  // the simplifier's estimate (quadric error) of how far the surface moved
};

/// Collapses edges (meshoptimizer). Vertices on borders stay where they are: where a reconstruction
/// ends, it ends at a discontinuity or at the next sample's own quad.
/// The result's vertices are some of the mesh's, in the order of first use; attributes other than
/// positions are dropped.
SimplifiedMesh simplified(const scene::Mesh& mesh, const SimplificationSettings& settings);

}  // namespace gfxrepro::soft_shadows
