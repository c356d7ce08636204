// Material files of Wavefront OBJ, and which files an OBJ file draws in.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/left_out.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

struct MtlMaterial {
    Material material;
    std::string colourFile;        // map_Kd, as written; empty: none
    std::filesystem::path folder;  // of the material file
};

/// Materials by name. Kd, Ke and map_Kd keep their meaning; d and Tr become the base colour's
/// alpha, Ni the index of refraction, Ns a roughness. Throws Error("FILE:LINE: …") for numbers that
/// are not.
std::map<std::string, MtlMaterial> loadMtl(const std::filesystem::path& path, LeftOut& leftOut);

/// What stands behind "mtllib": the whole as one name where such a file is there (fileInside()) or
/// none of its words is one, else word by word. A name may stand in quotes.
std::vector<std::string> libraryNames(std::string_view line, const std::filesystem::path& folder);

/// Of what stands behind "map_Kd", perhaps with a comment: beside the material file, else beside
/// the model, which `folder` is of.
std::optional<std::filesystem::path> textureFile(const MtlMaterial& material,
                                                 const std::filesystem::path& folder);

/// The material files that an OBJ file names, and their textures, where they are there.
std::set<std::filesystem::path> filesOfObj(std::string_view text,
                                           const std::filesystem::path& folder);

}  // namespace gfxrepro::scene
