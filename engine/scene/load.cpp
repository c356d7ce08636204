#include "engine/scene/load.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/foreign_text.h"
#include "engine/scene/left_out.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {
namespace {

struct Format {
    std::string_view extension;
    Scene (*load)(const std::filesystem::path& path);
};

constexpr Format kFormats[] = {
    {".ply", &loadPly}, {".obj", &loadObj}, {".gltf", &loadGltf}, {".glb", &loadGltf},
    {".off", &loadOff}, {".stl", &loadStl}, {".xyz", &loadXyz},   {".las", &loadLas},
    {".laz", &loadLas},  // compressed: which its loader says
};

const Format& formatOf(const std::filesystem::path& path) {
    const std::string extension = lowerCaseExtension(path);
    const auto found = std::ranges::find(kFormats, extension, &Format::extension);
    if (found != std::end(kFormats)) return *found;
    throw Error(path.string() + ": unknown extension '" + extension +
                "'; .ply, .obj, .gltf, .glb, .off, .stl, .xyz and .las are allowed");
}

/// Says what no surface has, of whichever format.
void warnOfColours(Scene& scene) {
    LeftOut odd;
    const auto isOutside = [](float value) { return !(value >= 0.0F && value <= 1.001F); };
    const auto isNegative = [](const glm::vec3& c) { return c.r < 0 || c.g < 0 || c.b < 0; };
    for (const Material& material : scene.materials) {
        const glm::vec4& c = material.baseColor;
        const bool isOdd = isOutside(c.r) || isOutside(c.g) || isOutside(c.b) || isOutside(c.a);
        odd.add("a base colour or opacity outside of 0 to 1", isOdd);
        odd.add("a metallic factor outside of 0 to 1", isOutside(material.metallic));
        odd.add("a roughness outside of 0 to 1", isOutside(material.roughness));
        odd.add("a transmission outside of 0 to 1", isOutside(material.transmission));
        odd.add("an emissive colour below 0", isNegative(material.emissive));
    }
    for (const Mesh& mesh : scene.meshes) {
        odd.add("a vertex colour below 0", std::ranges::count_if(mesh.colors, isNegative));
    }
    odd.add("a vertex colour below 0", std::ranges::count_if(scene.points.colors, isNegative));
    odd.tell(scene.warnings, "taken as it is");
}

/// GLB files and reports take no other names.
void makeUtf8(Scene& scene) {
    const auto convert = [](std::string& text) { text = asUtf8(text); };
    convert(scene.name);
    convert(scene.origin.description);
    for (Mesh& mesh : scene.meshes) convert(mesh.name);
    for (Material& material : scene.materials) convert(material.name);
    std::ranges::for_each(scene.warnings, convert);
}

}  // namespace

void requireKnownExtension(const std::filesystem::path& path) {
    formatOf(path);
}

Scene loadScene(const std::filesystem::path& path) {
    const Format& format = formatOf(path);
    requireReadAtOnce(path);
    Scene scene = format.load(path);
    warnOfColours(scene);
    scene.name = path.stem().string();
    scene.origin = {Origin::Kind::Real, path.filename().string(),
                    sha256OfModel(path, scene.filesBeside)};
    makeUtf8(scene);
    return scene;
}

}  // namespace gfxrepro::scene
