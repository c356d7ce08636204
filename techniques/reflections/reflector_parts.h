// Reflectors of [xie2017] Sec. 4.3, step 1. Departure [xie2017] Sec. 4.3: smooth connected parts of
// objects, where the thesis has whole ones, so that samples far apart share no cluster.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::reflections {

/// Between triangles whose planes turn by more than this, about 50°, a surface is not smooth: above
/// a tube of eight sides, below a box.
constexpr float kCreaseCosine = 0.64F;
/// Parts of a smaller share of their object's area are joined with what they border on most.
constexpr float kLeastPartShare = 0.05F;

/// The parts of a mesh, 0, 1, … in the order of first triangles. A part is connected by edges
/// (vertices at the same place are one), has no crease inside, and bends to one side: inside of a
/// bowl and outside are two, however smooth its rim is. The side is the sign of the mean curvature,
/// by majority over neighbouring triangles; normals say which side is out. Small parts that border
/// on nothing are one part together.
struct Parts {
    std::vector<std::uint32_t> ofTriangle;
    std::vector<std::uint8_t> isConcave;  // by part: most of its area
};
Parts partsOf(const scene::Mesh& mesh);

/// Of an instance that splitIntoParts() has made or left as it is.
struct PartOrigin {
    int instance = 0;  // which one it was
    bool isConcave = false;
};

/// Makes an instance of each part of the instances whose mesh `splits` accepts; motions go with
/// them.
std::vector<PartOrigin> splitIntoParts(scene::Scene& scene,
                                       const std::function<bool(const scene::Mesh&)>& splits);

}  // namespace gfxrepro::reflections
