// What a scene of the catalogue is made of on this machine.
#pragma once

#include <string>

#include "engine/scene/catalog.h"

namespace gfxrepro::cli {

/// "real", "stand-in", "generated", or "missing" where none of its files is here.
std::string sceneState(const scene::Catalog& catalog, const std::string& name);

}  // namespace gfxrepro::cli
