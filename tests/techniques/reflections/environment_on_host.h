// An environment map read back, and what it shows in a direction.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// A face and a place on it, 0 to 1, by the table of the OpenGL specification (Sec. 8.13).
struct PlaceOnCube {
    int face = 0;
    glm::vec2 place{0.0F};
};
inline PlaceOnCube placeOnCube(const glm::vec3& d) {
    const glm::vec3 size = glm::abs(d);
    int face = 0;
    float s = 0.0F, t = 0.0F, major = 0.0F;
    if (size.x >= size.y && size.x >= size.z) {
        face = d.x >= 0.0F ? 0 : 1;
        s = d.x >= 0.0F ? -d.z : d.z;
        t = -d.y;
        major = size.x;
    } else if (size.y >= size.z) {
        face = d.y >= 0.0F ? 2 : 3;
        s = d.x;
        t = d.y >= 0.0F ? d.z : -d.z;
        major = size.y;
    } else {
        face = d.z >= 0.0F ? 4 : 5;
        s = d.z >= 0.0F ? d.x : -d.x;
        t = -d.y;
        major = size.z;
    }
    return {face, 0.5F * (glm::vec2(s, t) / major + 1.0F)};
}

/// A face's rows as GL stores them.
class HostEnvironment {
  public:
    /// Waits for the device.
    explicit HostEnvironment(const EnvironmentMap& map)
        : values_(map.cube().read<float>(GL_RGB, GL_FLOAT, 3)) {}
    /// Nearest texel: as the device samples it.
    glm::vec3 radianceFrom(const glm::vec3& direction) const {
        constexpr int kSizePx = EnvironmentMap::kFaceSizePx;
        const PlaceOnCube at = placeOnCube(direction);
        const glm::ivec2 texel =
            glm::clamp(glm::ivec2(at.place * static_cast<float>(kSizePx)), 0, kSizePx - 1);
        const float* kept = &values_[static_cast<std::size_t>(
            3 * ((at.face * kSizePx + texel.y) * kSizePx + texel.x))];
        return linearColour({kept[0], kept[1], kept[2]});
    }

  private:
    std::vector<float> values_;
};

}  // namespace gfxrepro::reflections
