#include "runner/scene/load.h"

#include <algorithm>
#include <cctype>

#include "runner/core/hash.h"

namespace gfxrepro::scene {

Scene loadScene(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    Scene scene;
    if (extension == ".ply") {
        scene = loadPly(path);
    } else if (extension == ".obj") {
        scene = loadObj(path);
    } else if (extension == ".gltf" || extension == ".glb") {
        scene = loadGltf(path);
    } else {
        throw Error(path.string() + ": unknown extension '" + extension +
                    "'; .ply, .obj, .gltf and .glb are allowed");
    }
    scene.name = path.stem().string();
    scene.origin = {Origin::Kind::Real, path.filename().string(), sha256OfFile(path)};
    return scene;
}

}  // namespace gfxrepro::scene
