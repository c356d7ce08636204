#include "techniques/kit/requirements.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace gfxrepro::kit {

void requireTriangles(const scene::Scene& scene, std::string_view technique) {
    if (scene.triangleCount() == 0) {
        const std::size_t points = scene.points.positions.size();
        throw Error(
            fmt::format("technique '{}' needs a scene with triangles{}", technique,
                        points == 0 ? "" : fmt::format(", and this one has {} points", points)));
    }
    if (glm::length(scene.bounds().size()) == 0.0F) {
        throw Error(fmt::format(
            "technique '{}' needs a scene with some extent; all of its points are one", technique));
    }
}

}  // namespace gfxrepro::kit
