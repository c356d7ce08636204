// [xie2017] Algorithm 7 (printed as 8 in the text): a ray against a depth image.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace gfxrepro::clustered_reflections {

enum class March {
    Linear,        // Algorithm 7: a texel a step along the longer axis
    Hierarchical,  // over a pyramid of nearest depths: whole empty tiles are stepped over
};

/// A depth image on the host: what the reference march reads. Rows from the bottom; depth is the
/// distance along the camera's axis in metres, 0 where nothing is.
struct HostMarchImage {
    glm::mat4 clipFromWorld{1.0F};
    glm::ivec2 sizePx{0};
    std::vector<float> depthM;
    float depthAt(const glm::vec2& positionPx) const;  // nearest texel; out of the image: 0
};

struct MarchHit {
    glm::vec2 positionPx{0.0F};  // where the ray first is behind the stored depth
    float fraction = 0.0F;       // u, along the projected ray
    float depthM = 0.0F;         // of the ray there
    int steps = 0;
};

/// The march from begin to end, line by line as printed but for the signs:
/// steps = max(|Δx|·width, |Δy|·height); at fraction u the ray's depth is 1 / (k₁ + k₂·u) with
/// k₁ = 1 / z_begin, k₂ = 1 / z_end − 1 / z_begin; the first sample where it is behind the stored
/// depth is the hit. A ray that projects to a point takes the texel that it lies in.
std::optional<MarchHit> marchOnHost(const HostMarchImage& image, const glm::vec3& beginWorld,
                                    const glm::vec3& endWorld);

}  // namespace gfxrepro::clustered_reflections
