// Material files of Wavefront OBJ.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

struct MtlMaterial {
    Material material;
    std::string colourFile;  // map_Kd, as written; empty: none
};

/// Materials by name. Kd, Ke and map_Kd keep their meaning; d and Tr become the base colour's
/// alpha, Ni the index of refraction, Ns a roughness. Throws Error("FILE:LINE: …") for numbers that
/// are not.
std::map<std::string, MtlMaterial> loadMtl(const std::filesystem::path& path);

}  // namespace gfxrepro::scene
