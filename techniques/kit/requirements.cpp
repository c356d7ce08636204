#include "techniques/kit/requirements.h"

#include <fmt/format.h>

#include "runner/core/error.h"

namespace gfxrepro::kit {

const scene::Scene& requireScene(const technique::SetupContext& context,
                                 std::string_view technique) {
    if (!context.scene) throw Error(fmt::format("technique '{}' needs a scene", technique));
    return *context.scene;
}

const scene::Scene& requireTriangles(const technique::SetupContext& context,
                                     std::string_view technique) {
    const scene::Scene& scene = requireScene(context, technique);
    if (scene.triangleCount() == 0) {
        throw Error(fmt::format("technique '{}' needs a scene with triangles", technique));
    }
    if (glm::length(scene.bounds().size()) == 0.0F) {
        throw Error(fmt::format(
            "technique '{}' needs a scene with some extent; all of its points are one", technique));
    }
    return scene;
}

}  // namespace gfxrepro::kit
