// How colours are kept that are drawn once and read again: of surfaces, clusters' images and the
// environment.
#pragma once

#include <glm/glm.hpp>

#include "engine/gl/gl.h"

namespace gfxrepro::reflections {

/// Texels hold square roots of linear colours, 0 to 1, in 10 bits: as shown they are at most a
/// fifth of a level of 255 off. Linear ones would be up to 1.6 levels off near black.
constexpr GLenum kKeptColourFormat = GL_RGB10_A2;

/// As shaders/kept_colour.glsl has it.
inline glm::vec3 keptColour(const glm::vec3& linear) {
    return glm::sqrt(linear);
}
inline glm::vec3 linearColour(const glm::vec3& kept) {
    return kept * kept;
}

}  // namespace gfxrepro::reflections
