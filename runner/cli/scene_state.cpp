#include "runner/cli/scene_state.h"

#include <filesystem>

namespace gfxrepro::cli {

std::string sceneState(const scene::Catalog& catalog, const std::string& name) {
    const scene::SceneEntry& entry = catalog.entries().at(name);
    for (const scene::SceneSource& source : entry.sources) {
        const bool isThere =
            source.file.empty() || std::filesystem::exists(catalog.assetsFolder() / source.file);
        if (isThere) return std::string(scene::kindName(source.kind));
    }
    return "missing";
}

}  // namespace gfxrepro::cli
