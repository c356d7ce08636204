#include "engine/scene/load_mtl.h"

#include <algorithm>

#include "engine/core/files.h"
#include "engine/scene/load_lines.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {

namespace {

/// "Kd r g b", or "Kd grey".
glm::vec3 colour(LineReader& lines) {
    const float red = lines.number();
    const auto green = lines.optionalNumber();
    const auto blue = green ? lines.optionalNumber() : std::nullopt;
    return blue ? glm::vec3(red, *green, *blue) : glm::vec3(red);
}

/// The GGX roughness whose lobe is as wide as that of a Blinn-Phong exponent: α² = 2 / (Ns + 2),
/// and glTF's roughness is √α.
float roughnessOf(float exponent) {
    return std::pow(2.0F / (std::max(exponent, 0.0F) + 2.0F), 0.25F);
}

/// The file name may hold blanks; with options ("-s 1 1 1 wood.png") it is the last word.
std::string textureName(std::string_view rest) {
    if (rest.starts_with('-')) rest.remove_prefix(rest.find_last_of(" \t") + 1);
    return std::string(rest);
}

}  // namespace

std::map<std::string, MtlMaterial> loadMtl(const std::filesystem::path& path) {
    requireReadAtOnce(path);
    const MappedFile file(path);
    LineReader lines(file.text(), path.string());
    std::map<std::string, MtlMaterial> materials;
    MtlMaterial ignored;  // what stands before the first newmtl
    MtlMaterial* current = &ignored;
    while (lines.nextLine()) {
        const std::string_view key = lines.word();
        Material& material = current->material;
        if (key == "newmtl") {
            const std::string name(lines.rest());
            current = &materials[name];
            current->material.name = name;
        } else if (key == "Kd") {
            material.baseColor = glm::vec4(colour(lines), material.baseColor.a);
        } else if (key == "Ke") {
            material.emissive = colour(lines);
        } else if (key == "Ns") {
            material.roughness = roughnessOf(lines.number());
        } else if (key == "Ni") {
            material.indexOfRefraction = lines.number();
        } else if (key == "d") {
            material.baseColor.a = lines.number();
        } else if (key == "Tr") {
            material.baseColor.a = 1.0F - lines.number();
        } else if (key == "map_Kd") {
            current->colourFile = textureName(lines.rest());
        }
    }
    return materials;
}

}  // namespace gfxrepro::scene
