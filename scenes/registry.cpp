// Every generator, one line each. A table, not self-registration: a static library's unreferenced
// objects are dropped by the linker.
#include "scenes/registry.h"

#include "scenes/indoor/rooms.h"
#include "scenes/models/shapes.h"
#include "scenes/outdoor/outdoor.h"
#include "scenes/shadows/shadow_scenes.h"
#include "scenes/terrain/terrain.h"

namespace gfxrepro::scene {

std::span<const GeneratorInfo> registeredGenerators() {
    // One line each:
    // clang-format off
    static constexpr GeneratorInfo kGenerators[] = {
        {"bathroom", "a bathroom with 15 reflectors: tub, basin, toilet, taps, mirrors", &bathroom},
        {"bird_nest", "twigs woven into a bowl, with eggs, on a branch", &birdNest},
        {"city", "a downtown seen from above: streets, towers, houses, trees and cars", &city},
        {"cornell_box", "the Cornell box as it was measured, with its camera", &cornellBox, false},
        {"four_objects", "four boxes, one of which two views do not see", &fourObjects, false},
        {"grass", "bent blades on uneven ground", &grass},
        {"living_room", "a furnished room with 25 reflective objects", &livingRoom},
        {"object_on_plane", "a shape that stands on a plane, and plates close above it",
         &objectOnPlane},
        {"sdf_model", "a closed stand-in for a scanned model, with exact counts", &sdfModel},
        {"terrain", "a height map of mountains and lowland", &terrain},
        {"town_square", "a square with railings, wires, leaves and things close above the ground",
         &townSquare},
        {"tree", "a deciduous tree with a dense crown of leaves", &tree},
    };
    // clang-format on
    return kGenerators;
}

}  // namespace gfxrepro::scene
