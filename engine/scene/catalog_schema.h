// The keys of a scene of the catalogue.
#pragma once

#include "engine/core/key_schema.h"

namespace gfxrepro::scene {

SchemaFile sceneSchema();

}  // namespace gfxrepro::scene
