// Material files of Wavefront OBJ, and which files an OBJ file draws in.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/files.h"
#include "engine/scene/load_lines.h"
#include "engine/scene/load_obj.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {
namespace {

/// "Kd r g b" or "Kd grey"; nothing of "Kd spectral file" and "Kd xyz x y z", which are said.
std::optional<glm::vec3> colour(LineReader& lines, std::string_view key, LeftOut& leftOut) {
    const bool isSpectrum = lines.name().starts_with("spectral");
    if (isSpectrum || lines.name().starts_with("xyz")) {
        leftOut.add(fmt::format("'{}' by {} in a material file", key,
                                isSpectrum ? "a spectrum" : "CIE XYZ"));
        while (!lines.word().empty()) {
        }
        return std::nullopt;
    }
    const float red = lines.number();
    const auto green = lines.optionalNumber();
    const auto blue = green ? lines.optionalNumber() : std::nullopt;
    if (green && !blue) leftOut.add("the second of a colour's two numbers in a material file");
    return blue ? glm::vec3(red, *green, *blue) : glm::vec3(red);
}

/// "d 0.5", or "d -halo 0.5", which fades with the angle.
float opacity(LineReader& lines, LeftOut& leftOut) {
    if (lines.name().starts_with("-halo")) {
        leftOut.add("'d -halo' of a material file, taken as 'd'");
        lines.word();
    }
    return lines.number();
}

/// The GGX roughness whose lobe is as wide as that of a Blinn-Phong exponent: α² = 2 / (Ns + 2),
/// and glTF's roughness is √α.
float roughnessOf(float exponent) {
    return std::pow(2.0F / (std::max(exponent, 0.0F) + 2.0F), 0.25F);
}

/// The file name may hold blanks; behind options ("-s 1 1 1 wood.png") it is the last word, or
/// what stands in quotes.
std::string textureName(std::string_view rest) {
    const std::size_t quote = rest.ends_with('"') ? rest.find('"') : rest.npos;
    if (rest.size() > 1 && quote < rest.size() - 1) {
        rest = rest.substr(quote + 1, rest.size() - quote - 2);
    } else if (rest.starts_with('-')) {
        rest.remove_prefix(rest.find_last_of(" \t") + 1);
    }
    return std::string(rest);
}

/// Of an absolute path, which is of another machine, the file's name; otherwise as it is.
std::string_view withoutRoot(std::string_view name) {
    const bool isOfDrive = name.size() > 2 && name[1] == ':';
    if (!isOfDrive && !name.starts_with('/') && !name.starts_with('\\')) return name;
    return name.substr(name.find_last_of("/\\") + 1);
}

/// Says which options before a texture's name are not those that hold without them.
void leaveOptions(std::string_view rest, LeftOut& leftOut) {
    struct Option {
        std::string_view name;
        std::string_view values[3];
    };
    constexpr Option kWithout[] = {{"-s", {"1", "1", "1"}}, {"-o", {"0", "0", "0"}},
                                   {"-t", {"0", "0", "0"}}, {"-mm", {"0", "1", ""}},
                                   {"-clamp", {"off"}},     {"-cc", {"off"}},
                                   {"-blendu", {"on"}},     {"-blendv", {"on"}}};
    const std::size_t end = rest.ends_with('"') ? rest.find('"') : rest.find_last_of(" \t");
    if (!rest.starts_with('-') || end == rest.npos) return;
    LineReader words(rest.substr(0, end), "");
    words.nextLine();
    const Option* option = nullptr;
    std::size_t place = 0;
    std::string_view name;
    bool isSaid = false;
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
        const bool isNumber = parsedNumber<float>(word).has_value();
        if (word.starts_with('-') && !isNumber) {
            name = word;
            option = std::ranges::find(kWithout, name, &Option::name);
            place = 0;
            isSaid = false;
        }
        const bool isKnown = option != nullptr && option != std::end(kWithout);
        if (isKnown && word.data() == name.data()) continue;
        const std::string_view usual = isKnown && place < 3 ? option->values[place++] : "";
        const bool isUsual =
            word == usual || (isNumber && parsedNumber<float>(word) == parsedNumber<float>(usual));
        if (!isUsual && !isSaid) leftOut.add(fmt::format("{} of map_Kd", inQuotes(name)));
        isSaid = isSaid || !isUsual;
    }
}

std::string_view withoutQuotes(std::string_view name) {
    const bool isQuoted = name.size() >= 2 && name.front() == '"' && name.back() == '"';
    return isQuoted ? name.substr(1, name.size() - 2) : name;
}

}  // namespace

std::map<std::string, MtlMaterial> loadMtl(const std::filesystem::path& path, LeftOut& leftOut) {
    requireReadAtOnce(path);
    const MappedFile file(path);
    requireUtf8Text(file.text(), path.string());
    LineReader lines(file.text(), path.string());
    std::map<std::string, MtlMaterial> materials;
    MtlMaterial* current = nullptr;
    while (lines.nextLine()) {
        const std::string_view key = lines.word();
        const bool isOfNumbers =
            key == "Kd" || key == "Ke" || key == "Ns" || key == "Ni" || key == "d" || key == "Tr";
        lines.noteTakenLine(leftOut);
        if (key == "newmtl") {
            const std::string name = asUtf8(lines.name());
            const auto [found, isNew] = materials.try_emplace(name);
            current = isNew ? &found->second : nullptr;
            leftOut.add("a material of the name of one before it", isNew ? 0 : 1);
            if (!isNew) continue;
            current->material.name = name;
            current->folder = path.parent_path();
            continue;
        }
        if (current == nullptr) {
            leftOut.add("a line of a material file that is of no material", key.empty() ? 0 : 1);
            continue;
        }
        Material& material = current->material;
        if (key == "Kd" || key == "Ke") {
            const auto read = colour(lines, key, leftOut);
            if (read && key == "Kd") {
                material.baseColor = glm::vec4(*read, material.baseColor.a);
            } else if (read) {
                material.emissive = *read;
            }
        } else if (key == "Ns") {
            material.roughness = roughnessOf(lines.number());
        } else if (key == "Ni") {
            material.indexOfRefraction = lines.number();
        } else if (key == "d" || key == "Tr") {
            material.baseColor.a = key == "d" ? opacity(lines, leftOut) : 1.0F - lines.number();
            if (material.baseColor.a < 1.0F)
                leftOut.add("a material's opacity below 1, drawn as solid");
        } else if (key == "map_Kd") {
            leaveOptions(lines.name(), leftOut);
            current->colourFile = textureName(lines.name());
        } else if (!key.empty() && key != "Ka" && key != "map_Ka" && key != "illum") {
            // No light here is ambient, and each term of `illum` follows from the others.
            leftOut.add(fmt::format("{} of a material file", inQuotes(key)));
        }
        if (isOfNumbers && !lines.word().empty()) {
            leftOut.add(fmt::format("further words of the line '{}' of a material file", key));
        }
    }
    return materials;
}

std::vector<std::string> libraryNames(std::string_view line, const std::filesystem::path& folder) {
    for (const std::string_view whole : {line, LineReader::withoutComment(line)}) {
        const std::string name(withoutRoot(withoutQuotes(whole)));
        if (fileInside(folder, name)) return {name};
    }
    std::vector<std::string> names;
    bool isOneThere = false;
    LineReader words(line, "");
    words.nextLine();
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
        names.emplace_back(withoutRoot(withoutQuotes(word)));
        isOneThere = isOneThere || fileInside(folder, names.back());
    }
    return isOneThere ? names : std::vector<std::string>{std::string(line)};
}

std::optional<std::filesystem::path> textureFile(const MtlMaterial& material,
                                                 const std::filesystem::path& folder) {
    const std::string_view written = material.colourFile;
    for (const auto& beside :
         {material.folder.lexically_relative(folder), std::filesystem::path()}) {
        for (const std::string_view whole : {written, LineReader::withoutComment(written)}) {
            const std::string_view name = withoutRoot(whole);
            if (const auto file = fileInside(folder, beside / name)) return file;
        }
    }
    return std::nullopt;
}

std::set<std::filesystem::path> filesOfObj(std::string_view text,
                                           const std::filesystem::path& folder) {
    constexpr std::string_view kKey = "mtllib";
    constexpr std::size_t kMostBytes = 65536;  // of a line of names
    std::set<std::filesystem::path> files;
    std::set<std::string> known;
    text = withoutByteOrderMark(text);
    for (std::size_t at = text.find(kKey); at != text.npos; at = text.find(kKey, at)) {
        const std::size_t before = text.find_last_not_of(" \t", at - (at > 0 ? 1 : 0));
        const bool beginsLine =
            at == 0 || before == text.npos || text[before] == '\n' || text[before] == '\r';
        const std::string_view rest = text.substr(at, beginsLine ? kMostBytes : kKey.size());
        LineReader reader(rest, "");
        reader.nextLine();
        at += rest.size() - reader.unreadBytes();
        if (!beginsLine || reader.word() != kKey) continue;
        const std::string line(reader.name());
        if (!known.insert(line).second) continue;
        for (const std::string& name : libraryNames(line, folder)) {
            const auto library = fileInside(folder, name);
            if (!library || !files.insert(*library).second) continue;
            try {
                LeftOut ignored;
                for (const auto& [material, read] : loadMtl(*library, ignored)) {
                    if (const auto file = textureFile(read, folder)) files.insert(*file);
                }
            } catch (const Error&) {  // its loader says what is wrong
            }
        }
    }
    return files;
}

}  // namespace gfxrepro::scene
