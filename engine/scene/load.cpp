#include "engine/scene/load.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "engine/core/error.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {
namespace {

struct Format {
    std::string_view extension;
    Scene (*load)(const std::filesystem::path& path);
};

constexpr Format kFormats[] = {
    {".ply", &loadPly},  {".obj", &loadObj}, {".gltf", &loadGltf},
    {".glb", &loadGltf}, {".off", &loadOff}, {".stl", &loadStl},
};

const Format& formatOf(const std::filesystem::path& path) {
    const std::string extension = lowerCaseExtension(path);
    const auto found = std::ranges::find(kFormats, extension, &Format::extension);
    if (found != std::end(kFormats)) return *found;
    throw Error(path.string() + ": unknown extension '" + extension +
                "'; .ply, .obj, .gltf, .glb, .off and .stl are allowed");
}

}  // namespace

void requireKnownExtension(const std::filesystem::path& path) {
    formatOf(path);
}

Scene loadScene(const std::filesystem::path& path) {
    const Format& format = formatOf(path);
    requireReadAtOnce(path);
    Scene scene = format.load(path);
    scene.name = path.stem().string();
    scene.origin = {Origin::Kind::Real, path.filename().string(),
                    sha256OfModel(path, scene.filesBeside)};
    return scene;
}

}  // namespace gfxrepro::scene
