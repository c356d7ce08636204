// Numbers that the search on the device and the one on the host share.
#pragma once

namespace gfxrepro::reflection_reuse {

/// Of the second-order search ([xie2017] Sec. 5.5.4, outlook).
constexpr int kMaxNewtonSteps = 8;
/// Pixels. Linear extrapolation is trusted no farther.
constexpr float kLongestStep = 32.0F;
/// Share of the equations' trace that is added to their diagonal. Far below what moves a match by a
/// hundredth of a pixel; without it, reflections that do not tell two directions apart (a
/// cylinder seen from its focal line) divide by nothing.
constexpr float kDamping = 1e-5F;

/// Pixels, a power of two: how far from a sample with a match one that has lost its own is searched
/// again. What comes back into a reflector's image enters over its border, and by less a frame.
constexpr int kStartReach = 8;

/// Share of the eye's distance by which a match may miss the eye for rounding alone: positions and
/// normals are single precision. Without it a sample that has no neighbour to measure by is never
/// valid, not even where the eye has not moved.
constexpr float kRounding = 1e-5F;

}  // namespace gfxrepro::reflection_reuse
