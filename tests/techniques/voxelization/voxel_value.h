// What the bits of a voxel say, beside "full": a quantised normal or colour. 0 is empty.
// By the host: what voxel_value.glsl gives.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace gfxrepro::voxelization {

/// Octahedral code of a unit normal in 8, 16 or 32 bits: 15 × 15 levels, 255 × 255 levels (both
/// plus 1), or 65535 × 32767 levels (16 and 15 bits, highest bit set). Odd numbers of levels hold
/// the axes exactly. Never 0.
std::uint32_t encodeNormal(const glm::vec3& normal, int voxelBits);
/// Unit length; `code` must not be 0.
glm::vec3 decodeNormal(std::uint32_t code, int voxelBits);

/// Linear colour in 3:3:2, 5:6:5 or 8:8:8 bits (red highest). In 8 and 16 bits black becomes the
/// darkest blue, code 1; in 32 bits the highest byte is 255. Never 0.
std::uint32_t encodeColor(const glm::vec3& color, int voxelBits);
glm::vec3 decodeColor(std::uint32_t code, int voxelBits);

}  // namespace gfxrepro::voxelization
