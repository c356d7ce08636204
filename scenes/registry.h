// The generators of the scenes in this folder.
#pragma once

#include <span>

#include "engine/scene/generators.h"

namespace gfxrepro::scene {

/// By name, sorted.
std::span<const GeneratorInfo> registeredGenerators();

}  // namespace gfxrepro::scene
