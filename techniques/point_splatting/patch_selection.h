// What is drawn of each patch: culling, level, splat mode (zju2005 Sec. 3.2.3.2, 3.3.1).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "techniques/point_splatting/linear_tree.h"

namespace gfxrepro::point_splatting {

enum class SplatMode : std::uint8_t {
    FullEwa,         // H = J V^r Jᵀ + V^h (Eq. 3)
    Reconstruction,  // H = J V^r Jᵀ: the low-pass filter left out, for splats large on the screen
    LowPass,         // H = V^h: the reconstruction filter left out, for small ones
    Sprite,          // an opaque square
};

/// Which mode a whole model is drawn with.
enum class SplatMethod { Adaptive, FullEwa, Reconstruction, LowPass, Sprites };

struct SelectionSettings {
    SplatMethod method = SplatMethod::Adaptive;
    bool cullsFrustum = true, cullsCones = true;
    float cMin = 0.3F, cMax = 3.0F;
    /// The level is the coarsest whose largest radius projects to at most this many pixels at the
    /// box's nearest corner; `fineTargetPx` for patches that are curved (curvature above
    /// `curvedAbove`), have wide cones or lie at the silhouette. Thresholds are not given by the
    /// thesis.
    float targetRadiusPx = 1.5F;
    float fineTargetPx = 0.75F;
    float curvedAbove = 0.02F;
    bool choosesLevels = true;  // else the last level of every patch
};

struct PatchView {
    glm::mat4 viewFromModel{1.0F};
    glm::mat4 clipFromView{1.0F};
    glm::vec3 eyeModel{0.0F};
    glm::ivec2 sizePx{0};
    float focalPx = 1.0F;  // pixels: sizePx.y / (2·tan(fov / 2))
    float fovRad = 0.7F;   // of the square window's side: C_η of Eq. (13)
    float nearM = 0.01F;
};

struct DrawnPatch {
    std::uint32_t patch = 0;
    std::uint32_t level = 0;  // of the patch
    SplatMode mode = SplatMode::FullEwa;
    bool isSilhouette = false;
};

/// S_proj / S_h of the mean radius and C_η: the mode by c_min and c_max (Eq. 11–13).
SplatMode modeFor(float projectedRatio, float cEta, const SelectionSettings& settings);

/// Visible patches, in the models' order. No allocation beyond `drawn`, no tree traversal.
void selectPatches(std::span<const Patch> patches, std::span<const Level> levels,
                   const PatchView& view, const SelectionSettings& settings,
                   std::vector<DrawnPatch>& drawn);

}  // namespace gfxrepro::point_splatting
