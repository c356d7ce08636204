// A head as a CT/MR scanner would give it: the stand-in for the thesis's MRI head of 128³ voxels.
// [zju2005] Sec. 2.4.2, figure 2.7.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/scene/scene.h"

namespace gfxrepro::voxelization {

/// Densities in [0, 1] of resolution³ samples, x fastest; y is up, the face looks along +z. After
/// Shepp and Logan's phantom: nested ellipsoids (skin, bone, fluid, brain, ventricles, eyes) with
/// seeded noise, but with a face, ears and a neck.
std::vector<float> headDensities(int resolution, std::uint64_t seed);

/// RGBA8 3D texture for volume_transparent.frag.glsl: direction of falling density (outwards) · 0.5
/// + 0.5 in RGB, density in A; linear filter, clamped.
gl::Texture makeHeadTexture(int resolution, std::uint64_t seed);

/// The cube that a head must fill so that a brain with these bounds sits in its skull.
scene::Box headBoxAround(const scene::Box& brain);

/// What the head takes of that cube.
scene::Box headBounds(const scene::Box& cube);

}  // namespace gfxrepro::voxelization
