// [xie2017] Algorithm 7 (printed as 8 in the text) on the host: a ray against a depth image, as
// march.glsl has it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace gfxrepro::clustered_reflections {

/// A depth image on the host: what the reference march reads. Rows from the bottom; depth is the
/// distance along the camera's axis in metres, 0 where nothing is.
struct HostMarchImage {
    glm::mat4 clipFromWorld{1.0F};  // clip w: distance along the axis; clip z from −w to w
    glm::ivec2 sizePx{0};
    std::vector<float> depthM;
    std::vector<std::uint8_t> isOwn;  // texels of the cluster's own reflector; empty: none
    float depthAt(const glm::vec2& positionPx) const;  // nearest texel, clamped to the edge
};

struct MarchHit {
    glm::vec2 positionPx{0.0F};  // where the ray first is behind the stored depth
    float fraction = 0.0F;       // u, along the projected ray as clipped to the frustum
    float depthM = 0.0F;         // of the ray there
    int steps = 0;
};

/// The march from begin to end, line by line as printed but for the signs:
/// steps = max(|Δx|·width, |Δy|·height), at least 1; at fraction u the ray's depth is
/// 1 / (k₁ + k₂·u) with k₁ = 1 / z_begin, k₂ = 1 / z_end − 1 / z_begin; the first sample where it
/// is behind the stored depth is the hit. A ray that projects to a point takes the texel that it
/// lies in, at its second step. What lies outside of the frustum is cut off before, but for half a
/// texel around the image: the outermost rays run along its edge, and rounding must not lose them.
///
/// The own reflector (Sec. 4.7.4, second way) counts once the ray has been seen in front of
/// something by 1/32 of its depth: before, it has not left the surface that it starts from.
std::optional<MarchHit> marchOnHost(const HostMarchImage& image, const glm::vec3& beginWorld,
                                    const glm::vec3& endWorld);

}  // namespace gfxrepro::clustered_reflections
