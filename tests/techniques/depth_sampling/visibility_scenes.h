// Small scenes for the tests of visibility redundancy.
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "techniques/depth_sampling/visibility.h"

namespace gfxrepro::depth_sampling {

/// One-sided and double-sided triangles at random, a box and its mirror image turned and moved, all
/// within about [−1, 1]³.
scene::Scene clutter(std::uint64_t seed);

/// Three views of clutter() from the corners of a triangle before it; their frustums cut it at the
/// sides, in front and behind.
std::vector<kit::View> threeViews(int sizePx);

/// A square of half size `half` facing +z.
scene::Mesh squareAt(const glm::vec3& centre, float half);

/// After [xie2017] Fig. 11: a wide square A at z = 2, behind it small ones B (z = 0) and C (z = −2)
/// on the axis, and a wall D behind all. A hides C from everywhere; B hides it from the centre too.
struct FourObjects {
    scene::Scene scene;

    FourObjects();
    /// From 10 m before the axis, 3 m · `side` beside it.
    kit::View viewFrom(float side) const;
    SurfacePoint middleOfA() const { return {{0.03F, 0.05F, 2.0F}, 2}; }
    SurfacePoint middleOfB() const { return {{0.03F, 0.05F, 0.0F}, 4}; }
    SurfacePoint middleOfC() const { return {{0.03F, 0.05F, -2.0F}, 6}; }
};

}  // namespace gfxrepro::depth_sampling
