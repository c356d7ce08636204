// What is drawn of each patch: culling, level and splat mode (zju2005 Sec. 3.2.3.2, 3.3.1).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "techniques/kit/view.h"
#include "techniques/point_splatting/point_model.h"

namespace gfxrepro::point_splatting {

enum class SplatMode : std::uint8_t {
    FullEwa,         // H = J V^r Jᵀ + V^h (Eq. 3)
    Reconstruction,  // H = J V^r Jᵀ: splats that are large on the screen need no low-pass filter
    LowPass,         // H = V^h: small ones are no more than the low-pass filter
    Sprite,          // an opaque square
};

struct SelectionSettings {
    std::optional<SplatMode> mode;  // of all patches; none: adaptive, by each one's size
    bool cullsFrustum = true, cullsCones = true, choosesLevels = true;
    float cMin = 0.3F, cMax = 3.0F;
    float lowPassRadiusPx = 1.0F;  // r_h: the distance between pixels
    /// The level is the coarsest whose largest radius is at most this many pixels at the nearest
    /// corner of the patch's box: `fine` for patches that are curved, have wide cones or lie at the
    /// silhouette (Sec. 3.3.1.2, which gives no thresholds).
    float targetRadiusPx = 3.0F, fineRadiusPx = 0.6F;
    float curvedAbove = 0.02F;  // λ₀ / Σλ; a sphere's cap of 40° has it
    float wideAboveRad = 0.6F;
    /// At the silhouette: where the view ray is so near to a right angle to the mean normal.
    float silhouetteRad = 0.35F;
    /// Of each patch's points, those that have arrived: finer levels are not drawn (Sec. 3.5:
    /// progressive transmission).
    float prefixShare = 1.0F;
};

/// The finest level within `share` of a patch's points, at least the first.
std::uint32_t arrivedLevel(const Patch& patch, std::span<const Level> levels, float share);

/// A pinhole view of points, whose space is the world.
struct PatchView : kit::View {
    float focalPx = 1.0F;  // height / (2·tan(fov / 2))
    float fovRad = 0.7F;   // vertical
};
PatchView patchViewOf(const scene::Camera& camera, glm::ivec2 sizePx);

/// Distance along the view axis of the box's nearest point, at least the near plane's.
float nearestDepth(const scene::Box& box, const PatchView& view);

struct DrawnPatch {
    std::uint32_t patch = 0;
    std::uint32_t level = 0;  // of the patch
    SplatMode mode = SplatMode::FullEwa;
};

/// C_η = √(2 tan²(fov / 2) + 1) of Eq. (13), for a square window.
double cEta(double fovRad);
/// The mode by `ratio` = S_proj / S_h: reconstruction alone above c_max, the low-pass alone where
/// C_η times it is below c_min, else both (from Eq. 13).
SplatMode modeFor(float ratio, float cEta, const SelectionSettings& settings);

/// Why patches are not drawn.
struct SelectionCounts {
    std::uint32_t outside = 0, turnedAway = 0, drawn = 0;
    std::uint64_t points = 0;  // drawn
};

/// The visible patches in the model's order, into `drawn` (cleared). A patch is as far as the
/// nearest of its box's eight corners (Sec. 3.3.1.2); one at the silhouette, by the angle between
/// the view ray and the mean normal (Sec. 3.2.1), is always drawn by full EWA where modes are
/// adaptive (Sec. 3.3.1.3).
SelectionCounts selectPatches(std::span<const Patch> patches, std::span<const Level> levels,
                              const PatchView& view, const SelectionSettings& settings,
                              std::vector<DrawnPatch>& drawn);

}  // namespace gfxrepro::point_splatting
