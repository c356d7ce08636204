// What the bits of a voxel say, beside "full": a quantised normal. 0 is empty.
// By the host: what voxel_value.glsl gives.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "engine/core/error.h"

namespace gfxrepro::voxelization {

inline glm::uvec2 normalLevels(int voxelBits) {
    GFXREPRO_ASSERT(voxelBits == 8 || voxelBits == 16 || voxelBits == 32);
    return voxelBits == 8    ? glm::uvec2(15)
           : voxelBits == 16 ? glm::uvec2(255)
                             : glm::uvec2(65535, 32767);
}

inline std::uint32_t quantised(float value, std::uint32_t maximum) {
    const float clamped = std::clamp(value, 0.0F, 1.0F);
    return static_cast<std::uint32_t>(std::floor(clamped * static_cast<float>(maximum) + 0.5F));
}

inline glm::vec2 signNotZero(const glm::vec2& v) {
    return {v.x < 0.0F ? -1.0F : 1.0F, v.y < 0.0F ? -1.0F : 1.0F};
}

/// Octahedral code of a unit normal in 8, 16 or 32 bits: 15 × 15 levels, 255 × 255 levels (both
/// plus 1), or 65535 × 32767 levels (16 and 15 bits, highest bit set). Odd numbers of levels hold
/// the axes exactly. Never 0.
inline std::uint32_t encodeNormal(const glm::vec3& normal, int voxelBits) {
    const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    const glm::vec3 n = sum > 0.0F ? normal / sum : glm::vec3(0, 0, 1);
    glm::vec2 octahedral(n.x, n.y);
    if (n.z < 0.0F) {
        octahedral = (1.0F - glm::vec2(std::abs(n.y), std::abs(n.x))) * signNotZero(octahedral);
    }
    const glm::uvec2 levels = normalLevels(voxelBits);
    const std::uint32_t x = quantised(octahedral.x * 0.5F + 0.5F, levels.x - 1);
    const std::uint32_t y = quantised(octahedral.y * 0.5F + 0.5F, levels.y - 1);
    return voxelBits == 32 ? 0x80000000U | y << 16 | x : 1U + y * levels.x + x;
}

/// Unit length; `code` must not be 0.
inline glm::vec3 decodeNormal(std::uint32_t code, int voxelBits) {
    const glm::uvec2 levels = normalLevels(voxelBits);
    const glm::uvec2 q = voxelBits == 32 ? glm::uvec2(code & 0xFFFFU, (code >> 16) & 0x7FFFU)
                                         : glm::uvec2((code - 1) % levels.x, (code - 1) / levels.x);
    const glm::vec2 p = glm::vec2(q) / glm::vec2(levels - 1U) * 2.0F - 1.0F;
    glm::vec3 n(p, 1.0F - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0.0F) {
        const glm::vec2 folded = (1.0F - glm::vec2(std::abs(n.y), std::abs(n.x))) * signNotZero(p);
        n = {folded, n.z};
    }
    return glm::normalize(n);
}

}  // namespace gfxrepro::voxelization
