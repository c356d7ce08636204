// Surfaces turned into points, and what points lack made up for.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runner/scene/scene.h"

namespace gfxrepro::scene {

/// `count` points on the triangles of a scene, by area: a triangle's share of a low-discrepancy
/// sequence. Normals interpolated (the triangle's where the mesh has none), colours of material
/// times vertex times texture (left out when everything is white), radii so that neighbouring discs
/// touch: √(area / (count · π)) · 1.5. Same seed, same bytes. Throws Error for scenes without area.
PointCloud sampledPoints(const Scene& scene, std::size_t count, std::uint64_t seed);

/// `count` of the points, spread evenly (every point stands for its neighbours in a covariance
/// tree); all of them where there are not more.
PointCloud thinnedPoints(const PointCloud& points, std::size_t count);

/// What completePoints() did.
struct PointRepairs {
    std::size_t dropped = 0;     // positions that are not finite
    std::size_t duplicates = 0;  // points at the place of another: dropped, too
    std::size_t normals = 0;     // estimated: missing, not finite or zero
    std::size_t radii = 0;       // estimated: missing, not finite or not positive
};
/// Normals by local covariance of the 16 nearest neighbours, turned the way of their neighbours
/// (outwards at the topmost point of each connected part); radii as the mean distance to the 6
/// nearest neighbours. In parallel. A single point gets radius 1 and the normal +y, equal points
/// likewise. Throws Error when no point is left.
PointRepairs completePoints(PointCloud& points);

}  // namespace gfxrepro::scene
