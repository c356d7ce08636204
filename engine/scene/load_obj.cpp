// Wavefront OBJ. First the lists and the corners of all triangles are read, then each material's
// corners become a mesh whose vertices are the different (position, texcoord, normal) triples.
#include "engine/scene/load_obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/load.h"
#include "engine/scene/load_text.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {
namespace {

/// Goes through a text line by line and through a line word by word. A backslash at the end of a
/// line continues it; '#' begins a comment.
class LineReader {
  public:
    LineReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    /// False at the end of the text.
    bool nextLine() {
        line_ = nextLine_;
        if (text_.empty()) return false;
        rest_ = takeLine();
        if (endsWithBackslash(rest_)) joinContinuations();
        if (const std::size_t comment = rest_.find('#'); comment != rest_.npos) {
            rest_ = rest_.substr(0, comment);
        }
        return true;
    }

    /// Empty at the end of the line.
    std::string_view word() {
        skipBlanks();
        std::size_t end = 0;
        while (end < rest_.size() && !isBlank(rest_[end])) ++end;
        const std::string_view result = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return result;
    }

    /// What is left of the line, without blanks around it.
    std::string_view rest() {
        skipBlanks();
        while (!rest_.empty() && isBlank(rest_.back())) rest_.remove_suffix(1);
        return rest_;
    }

    /// The next word as a finite number; empty at the end of the line.
    std::optional<float> optionalNumber() {
        const std::string_view text = word();
        if (text.empty()) return std::nullopt;
        const auto value = parsedNumber<float>(text);
        if (!value || !std::isfinite(*value)) {
            fail(fmt::format("{} is not a finite number", inQuotes(text)));
        }
        return value;
    }

    float number() {
        const auto value = optionalNumber();
        if (!value) fail("the line lacks a number");
        return *value;
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error({file_, line_, 0}, message);
    }

  private:
    static constexpr std::size_t kMostLineBytes = std::size_t{64} << 20;

    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
    static bool endsWithBackslash(std::string_view line) {
        while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        return !line.empty() && line.back() == '\\';
    }

    void skipBlanks() {
        while (!rest_.empty() && isBlank(rest_.front())) rest_.remove_prefix(1);
    }

    std::string_view takeLine() {
        ++nextLine_;
        const std::size_t end = text_.find('\n');
        const std::string_view line = text_.substr(0, end);
        if (line.size() > kMostLineBytes) {
            line_ = nextLine_ - 1;
            fail(fmt::format("a line of {} bytes; at most {} are read", line.size(),
                             kMostLineBytes));
        }
        text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
        return line;
    }

    void joinContinuations() {
        joined_.clear();
        while (endsWithBackslash(rest_)) {
            joined_ += rest_.substr(0, rest_.rfind('\\'));
            joined_ += ' ';
            rest_ = text_.empty() ? std::string_view{} : takeLine();
        }
        joined_ += rest_;
        rest_ = joined_;
    }

    std::string_view text_;
    std::string file_;
    std::string_view rest_;
    std::string joined_;
    int line_ = 1;
    int nextLine_ = 1;
};

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

namespace {

/// Indices from 0 into the lists of the file; −1: none.
struct Corner {
    int position = -1;
    int texcoord = -1;
    int normal = -1;

    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        // Odd 64-bit constants (the golden ratio's and two of its kin) spread close indices apart.
        const std::uint64_t hash =
            static_cast<std::uint64_t>(corner.position) * 0x9E3779B97F4A7C15U ^
            static_cast<std::uint64_t>(corner.texcoord) * 0xC2B2AE3D27D4EB4FU ^
            static_cast<std::uint64_t>(corner.normal) * 0x165667B19E3779F9U;
        return hash ^ (hash >> 29);
    }
};

/// The triangles of one material, three corners each.
struct Group {
    std::string material;  // empty: none named
    std::vector<Corner> corners;
};

struct ObjContent {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> colors;  // empty, or as many as positions
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec3> normals;
    std::vector<Group> groups;
    std::vector<std::string> materialFiles;
    bool hasTriples = false;  // some corner has a texcoord or a normal
};

class ObjParser {
  public:
    ObjParser(std::string_view text, const std::string& file) : lines_(text, file) {}

    ObjContent parse() {
        while (lines_.nextLine()) {
            const std::string_view key = lines_.word();
            if (key == "v") {
                parseVertex();
            } else if (key == "vt") {
                const float u = lines_.number();
                // OBJ counts v from the bottom, glTF from the top.
                content_.texcoords.emplace_back(u, 1.0F - lines_.optionalNumber().value_or(0.0F));
            } else if (key == "vn") {
                const float x = lines_.number();
                const float y = lines_.number();
                content_.normals.push_back(unitNormal({x, y, lines_.number()}));
            } else if (key == "f" || key == "fo") {
                parseFace();
            } else if (key == "usemtl") {
                useMaterial(std::string(lines_.rest()));
            } else if (key == "mtllib") {
                std::string file(lines_.rest());
                const bool isNew = materialFiles_.insert(file).second;
                if (isNew) content_.materialFiles.push_back(std::move(file));
            }  // groups, smoothing, lines, curves: no triangles in them
        }
        if (content_.colors.size() != content_.positions.size()) content_.colors.clear();
        std::erase_if(content_.groups, [](const Group& group) { return group.corners.empty(); });
        return std::move(content_);
    }

  private:
    /// "v x y z", "v x y z w", "v x y z r g b".
    void parseVertex() {
        const float x = coordinate();
        const float y = coordinate();
        content_.positions.emplace_back(x, y, coordinate());
        const auto red = lines_.optionalNumber();
        const auto green = red ? lines_.optionalNumber() : std::nullopt;
        const auto blue = green ? lines_.optionalNumber() : std::nullopt;
        if (blue) content_.colors.emplace_back(*red, *green, *blue);
    }

    float coordinate() {
        const float value = lines_.number();
        if (std::abs(value) > kMaxCoordinate) {
            lines_.fail(fmt::format("a coordinate is {}; {:g} to {:g} are allowed", value,
                                    -kMaxCoordinate, kMaxCoordinate));
        }
        return value;
    }

    void parseFace() {
        polygon_.clear();
        for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) {
            polygon_.push_back(parseCorner(word));
        }
        if (polygon_.size() < 3) {
            lines_.fail(
                fmt::format("a face of {} corners; 3 or more are allowed", polygon_.size()));
        }
        if (content_.groups.empty()) useMaterial("");
        std::vector<Corner>& corners = content_.groups[group_].corners;
        for (std::size_t i = 2; i < polygon_.size(); ++i) {
            corners.insert(corners.end(), {polygon_[0], polygon_[i - 1], polygon_[i]});
        }
    }

    /// "v", "v/t", "v//n" or "v/t/n".
    Corner parseCorner(std::string_view word) {
        const std::string_view whole = word;
        Corner corner;
        corner.position = parseIndex(word, whole, content_.positions.size(), "v");
        if (skipSlash(word) && !word.starts_with('/') && !word.empty()) {
            corner.texcoord = parseIndex(word, whole, content_.texcoords.size(), "vt");
        }
        if (skipSlash(word) && !word.empty()) {
            corner.normal = parseIndex(word, whole, content_.normals.size(), "vn");
        }
        if (!word.empty()) failCorner(whole);
        content_.hasTriples |= corner.texcoord >= 0 || corner.normal >= 0;
        return corner;
    }

    static bool skipSlash(std::string_view& word) {
        if (!word.starts_with('/')) return false;
        word.remove_prefix(1);
        return true;
    }

    [[noreturn]] void failCorner(std::string_view whole) const {
        lines_.fail(fmt::format("{} is not a corner; v, v/vt, v//vn and v/vt/vn are allowed",
                                inQuotes(whole)));
    }

    /// Indices count from 1; negative ones from the end of what has been read.
    int parseIndex(std::string_view& word, std::string_view whole, std::size_t count,
                   std::string_view list) const {
        long long index = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc()) failCorner(whole);
        word.remove_prefix(static_cast<std::size_t>(stop - word.data()));
        const auto size = static_cast<long long>(count);
        if (index == 0 || index > size || index < -size) {
            lines_.fail(
                fmt::format("index {} is not one of the {} '{}' lines so far", index, count, list));
        }
        return static_cast<int>(index > 0 ? index - 1 : size + index);
    }

    void useMaterial(std::string name) {
        const auto [found, isNew] = groupOf_.try_emplace(name, content_.groups.size());
        group_ = found->second;
        if (isNew) content_.groups.push_back({std::move(name), {}});
    }

    LineReader lines_;
    ObjContent content_;
    std::unordered_map<std::string, std::size_t> groupOf_;
    std::size_t group_ = 0;
    std::vector<Corner> polygon_;
    std::set<std::string> materialFiles_;
};

/// The corners as they are: vertex i of the mesh is line i of the file.
Mesh meshOfPositions(ObjContent& content) {
    Mesh mesh;
    std::vector<Corner>& corners = content.groups.front().corners;
    mesh.triangles.reserve(corners.size() / 3);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        mesh.triangles.emplace_back(corners[i].position, corners[i + 1].position,
                                    corners[i + 2].position);
    }
    mesh.positions = std::move(content.positions);
    mesh.colors = std::move(content.colors);
    return mesh;
}

/// An attribute is kept when every corner has it.
Mesh meshOfTriples(const ObjContent& content, const std::vector<Corner>& corners) {
    const bool texcoords = std::none_of(corners.begin(), corners.end(),
                                        [](const Corner& each) { return each.texcoord < 0; });
    const bool normals = std::none_of(corners.begin(), corners.end(),
                                      [](const Corner& each) { return each.normal < 0; });
    Mesh mesh;
    mesh.triangles.resize(corners.size() / 3);
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Corner corner = corners[i];
        if (!texcoords) corner.texcoord = -1;
        if (!normals) corner.normal = -1;
        const auto [found, isNew] =
            vertices.try_emplace(corner, static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.triangles[i / 3][static_cast<int>(i % 3)] = found->second;
        if (!isNew) continue;
        mesh.positions.push_back(content.positions[corner.position]);
        if (!content.colors.empty()) mesh.colors.push_back(content.colors[corner.position]);
        if (texcoords) mesh.texcoords.push_back(content.texcoords[corner.texcoord]);
        if (normals) mesh.normals.push_back(content.normals[corner.normal]);
    }
    return mesh;
}

/// Materials and textures of the groups. Material files and textures that are not there leave the
/// default grey and no texture: many OBJ files travel without them.
class MaterialTable {
  public:
    MaterialTable(const std::filesystem::path& folder, const std::vector<std::string>& files)
        : folder_(folder) {
        for (const std::string& file : files) {
            if (const auto path = existing(file)) {
                defined_.merge(loadMtl(*path));
            } else {
                absent_.push_back(file);
            }
        }
    }

    void addTo(Scene& scene, const std::string& name) {
        const auto found = defined_.find(name);
        Material material = found == defined_.end() ? Material{} : found->second.material;
        material.name = name;
        if (found != defined_.end()) {
            material.baseColorTexture = texture(scene, found->second.colourFile);
        }
        scene.materials.push_back(std::move(material));
    }

    /// Of files that are not there: what looks grey for it.
    std::vector<std::string> warnings() const {
        std::vector<std::string> texts;
        for (const std::string& file : absent_) {
            texts.push_back(fmt::format(
                "material file '{}' is not beside the model: its materials are grey", file));
        }
        return texts;
    }

  private:
    std::optional<std::filesystem::path> existing(std::string file) const {
        std::replace(file.begin(), file.end(), '\\', '/');
        const auto path = pathInside(folder_, file);
        std::error_code ignored;
        return path && std::filesystem::is_regular_file(*path, ignored) ? path : std::nullopt;
    }

    int texture(Scene& scene, const std::string& file) {
        const auto path = existing(file);
        if (!path) return -1;
        const auto [found, isNew] =
            textureOf_.try_emplace(path->string(), static_cast<int>(scene.textures.size()));
        if (isNew) {
            scene.textures.push_back(decodeTexture(MappedFile(*path).bytes(), path->string()));
        }
        return found->second;
    }

    std::filesystem::path folder_;
    std::map<std::string, MtlMaterial> defined_;
    std::vector<std::string> absent_;
    std::map<std::string, int> textureOf_;
};

}  // namespace

Scene loadObj(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    const std::string file = path.string();
    ObjContent content = ObjParser(mapped.text(), file).parse();
    if (content.positions.empty()) throw Error(file + ": no vertices");
    if (content.positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw Error(file + ": more than 2147483647 vertices");
    }
    Scene scene;
    if (content.groups.empty()) {
        scene.points.positions = std::move(content.positions);
        scene.points.colors = std::move(content.colors);
        return scene;
    }
    MaterialTable materials(path.parent_path(), content.materialFiles);
    scene.warnings = materials.warnings();
    const bool asIs = content.groups.size() == 1 && !content.hasTriples;
    for (Group& group : content.groups) {
        Mesh mesh = asIs ? meshOfPositions(content) : meshOfTriples(content, group.corners);
        std::vector<Corner>().swap(group.corners);
        if (!group.material.empty()) {
            mesh.name = group.material;
            mesh.material = static_cast<int>(scene.materials.size());
            materials.addTo(scene, group.material);
        }
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::mat4(1.0F)});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

}  // namespace gfxrepro::scene
