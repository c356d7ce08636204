// Wavefront OBJ. First the lists and the corners of all triangles are read, then each material's
// corners become a mesh whose vertices are the different (position, texcoord, normal) triples.
#include "engine/scene/load_obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/load.h"
#include "engine/scene/load_lines.h"
#include "engine/scene/model_files.h"
#include "engine/scene/polygon.h"
#include "engine/scene/topology.h"

namespace gfxrepro::scene {
namespace {

/// Indices from 0 into the lists of the file; −1: none.
struct Corner {
    int position = -1;
    int texcoord = -1;
    int normal = -1;
};

/// The triangles of one material, three corners each.
struct Group {
    std::string material;  // empty: none named
    std::vector<Corner> corners;
};

struct ObjContent {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> colors;  // linear; empty, or as many as positions
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec3> normals;
    std::vector<Group> groups;
    std::vector<std::string> libraries;  // what stands behind "mtllib"
    bool hasTriples = false;             // some corner has a texcoord or a normal
    std::size_t linesOfLines = 0;
    std::vector<std::string> warnings;
};

class ObjParser {
  public:
    /// Positions are relative to `anchor`.
    ObjParser(std::string_view text, const std::string& file, Anchor& anchor, LeftOut& leftOut)
        : lines_(text, file), anchor_(anchor), leftOut_(leftOut) {}

    ObjContent parse() {
        while (lines_.nextLine()) parseLine(lines_.word());
        if (!content_.colors.empty() && content_.colors.size() != content_.positions.size()) {
            leftOut_.add("vertex colours, as not every vertex has one");
            content_.colors.clear();
        }
        makeLinear(content_.colors, content_.warnings);
        std::erase_if(content_.groups, [](const Group& group) { return group.corners.empty(); });
        dropAttributesThatAreNotThere();
        leftOut_.add("the line 'l'", content_.linesOfLines);
        // Normals of the file say what smoothing groups would.
        if (content_.normals.empty()) leftOut_.add("the line 's' (smoothing)", smoothingCount_);
        leftOut_.add(kOverlap, polygons_.overlappingCount());
        return std::move(content_);
    }

  private:
    void parseLine(std::string_view key) {
        lines_.noteTakenLine(leftOut_);
        if (key == "v") {
            parseVertex();
        } else if (key == "vt") {
            const float u = texcoord(lines_.anyNumber());
            // OBJ counts v from the bottom, glTF from the top.
            const bool hasV = !lines_.name().empty() && !lines_.name().starts_with('#');
            content_.texcoords.emplace_back(u, 1.0F - (hasV ? texcoord(lines_.anyNumber()) : 0.0F));
            if (hasV) leaveRest("vt", 0.0F);  // of an image the depth is 0
        } else if (key == "vn") {
            const float x = lines_.anyNumber();
            const float y = lines_.anyNumber();
            content_.normals.push_back(readNormal({x, y, lines_.anyNumber()}, leftOut_));
            leaveRest("vn");
        } else if (key == "f" || key == "fo") {
            parseFace();
        } else if (key == "usemtl") {
            useMaterial(asUtf8(lines_.name()));
        } else if (key == "mtllib") {
            std::string line(lines_.name());
            const bool isNew = libraries_.insert(line).second;
            if (isNew) content_.libraries.push_back(std::move(line));
        } else if (key == "l") {
            ++content_.linesOfLines;
        } else if (key == "s") {
            ++smoothingCount_;
        } else if (key.empty()) {  // ZBrush has colours in comments
            if (!lines_.name().starts_with("#MRGB")) return;
            leftOut_.add("the line '#MRGB' (vertex colours)");
        } else if (key != "o" && key != "g") {  // these only name things
            leftOut_.add(fmt::format("the line {}", inQuotes(key)));
        }
    }

    /// "v x y z", "v x y z w", "v x y z r g b".
    void parseVertex() {
        content_.positions.push_back(lines_.position(anchor_));
        const auto red = lines_.optionalNumber();
        const auto green = red ? lines_.optionalNumber() : std::nullopt;
        const auto blue = green ? lines_.optionalNumber() : std::nullopt;
        if (blue) content_.colors.emplace_back(*red, *green, *blue);
        if (blue) leaveRest("v");
        if (!blue && (green || red.value_or(1.0F) != 1.0F)) leaveNumbers("v");  // a weight of 1
    }

    /// Says that the line has more, unless it is this number alone, which changes nothing.
    void leaveRest(const char* key, std::optional<float> harmless = std::nullopt) {
        std::string_view word = lines_.word();
        if (harmless && parsedNumber<float>(word) == harmless) word = lines_.word();
        if (!word.empty()) leaveNumbers(key);
    }

    void leaveNumbers(const char* key) {
        leftOut_.add(fmt::format("further numbers of the line '{}'", key));
    }

    float texcoord(float value) {
        if (std::isfinite(value)) return value;
        leftOut_.add("a texture coordinate that is not finite, taken as 0");
        return 0.0F;
    }

    void parseFace() {
        polygon_.clear();
        for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) {
            polygon_.push_back(parseCorner(word));
        }
        if (polygon_.size() < 3) leftOut_.add("a face of fewer than 3 corners");
        if (content_.groups.empty()) useMaterial("");
        std::vector<Corner>& corners = content_.groups[group_].corners;
        if (polygon_.size() == 3) {
            corners.insert(corners.end(), polygon_.begin(), polygon_.end());
        } else if (polygon_.size() > 3) {
            places_.clear();
            for (const Corner& each : polygon_) {
                places_.push_back(content_.positions[static_cast<std::size_t>(each.position)]);
            }
            for (const glm::uvec3& t : polygons_.fill(places_)) {
                corners.insert(corners.end(), {polygon_[t.x], polygon_[t.y], polygon_[t.z]});
            }
        }
    }

    /// "v", "v/t", "v//n" or "v/t/n".
    Corner parseCorner(std::string_view word) {
        const std::string_view whole = word;
        Corner corner;
        const auto positionCount = static_cast<long long>(content_.positions.size());
        const long long position = parseIndex(word, whole, positionCount);
        if (position < 0 || position >= positionCount) {
            lines_.fail(fmt::format("index {} is not one of the {} 'v' lines so far",
                                    whole.substr(0, std::min(whole.find('/'), std::size_t{40})),
                                    positionCount));
        }
        corner.position = static_cast<int>(position);
        if (skipSlash(word) && !word.starts_with('/') && !word.empty()) {
            corner.texcoord = attribute(word, whole, content_.texcoords.size(), mostTexcoord_);
        }
        if (skipSlash(word) && !word.empty()) {
            corner.normal = attribute(word, whole, content_.normals.size(), mostNormal_);
        }
        if (!word.empty()) failCorner(whole);
        content_.hasTriples |= corner.texcoord >= 0 || corner.normal >= 0;
        return corner;
    }

    /// The index of a line that may come later.
    int attribute(std::string_view& word, std::string_view whole, std::size_t count, int& most) {
        const long long index = parseIndex(word, whole, static_cast<long long>(count));
        const bool isAbsent = index < 0 || index >= std::numeric_limits<int>::max();
        if (isAbsent) leftOut_.add(kAbsentAttribute);
        most = isAbsent ? most : std::max(most, static_cast<int>(index));
        return isAbsent ? -1 : static_cast<int>(index);
    }

    void dropAttributesThatAreNotThere() {
        const auto texcoordCount = static_cast<int>(content_.texcoords.size());
        const auto normalCount = static_cast<int>(content_.normals.size());
        if (mostTexcoord_ < texcoordCount && mostNormal_ < normalCount) return;
        const auto drop = [&](int& index, int count) {
            if (index < count) return;
            index = -1;
            leftOut_.add(kAbsentAttribute);
        };
        for (Group& group : content_.groups) {
            for (Corner& corner : group.corners) {
                drop(corner.texcoord, texcoordCount);
                drop(corner.normal, normalCount);
            }
        }
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

    /// Indices count from 1; negative ones from the end of the `count` lines that have been read.
    /// The result counts from 0, and is negative where there is no such line.
    long long parseIndex(std::string_view& word, std::string_view whole, long long count) const {
        long long index = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc()) failCorner(whole);
        word.remove_prefix(static_cast<std::size_t>(stop - word.data()));
        return index > 0 ? index - 1 : index < 0 && index >= -count ? count + index : -1;
    }

    void useMaterial(std::string name) {
        const auto [found, isNew] = groupOf_.try_emplace(name, content_.groups.size());
        group_ = found->second;
        if (isNew) content_.groups.push_back({std::move(name), {}});
    }

    static constexpr const char* kAbsentAttribute =
        "a texture coordinate or a normal of a corner, which is not in the file";

    LineReader lines_;
    Anchor& anchor_;
    LeftOut& leftOut_;
    ObjContent content_;
    std::unordered_map<std::string, std::size_t> groupOf_;
    std::size_t group_ = 0;
    std::vector<Corner> polygon_;
    std::vector<glm::vec3> places_;  // of its corners
    PolygonFiller polygons_;
    std::set<std::string> libraries_;
    int mostTexcoord_ = -1;  // of all corners
    int mostNormal_ = -1;
    std::size_t smoothingCount_ = 0;
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

/// Which attributes all three corners of a triangle have: 1 texture coordinates, 2 normals.
std::size_t attributesOf(const Corner* corners) {
    std::size_t attributes = 3;
    for (int i = 0; i < 3; ++i) {
        if (corners[i].texcoord < 0) attributes &= ~std::size_t{1};
        if (corners[i].normal < 0) attributes &= ~std::size_t{2};
    }
    return attributes;
}

/// Triangles with the same attributes together; mostly all have the same.
std::vector<std::vector<Corner>> alike(std::vector<Corner>&& corners) {
    std::array<std::size_t, 4> placeOf{4, 4, 4, 4};
    std::vector<std::vector<Corner>> parts;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::size_t& place = placeOf[attributesOf(&corners[i])];
        if (place == 4) {
            place = parts.size();
            parts.emplace_back();
        }
    }
    if (parts.size() == 1) return {std::move(corners)};
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::vector<Corner>& part = parts[placeOf[attributesOf(&corners[i])]];
        part.insert(part.end(), &corners[i], &corners[i] + 3);
    }
    return parts;
}

/// Of triangles that all have the same attributes.
Mesh meshOfTriples(const ObjContent& content, const std::vector<Corner>& corners) {
    const std::size_t attributes = attributesOf(corners.data());
    const bool texcoords = (attributes & 1) != 0;
    const bool normals = (attributes & 2) != 0;
    Mesh mesh;
    mesh.triangles.resize(corners.size() / 3);
    KeyNumbers<std::array<std::uint32_t, 3>> vertices;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Corner corner = corners[i];
        if (!texcoords) corner.texcoord = -1;
        if (!normals) corner.normal = -1;
        const auto [vertex, isNew] = vertices.number({static_cast<std::uint32_t>(corner.position),
                                                      static_cast<std::uint32_t>(corner.texcoord),
                                                      static_cast<std::uint32_t>(corner.normal)});
        mesh.triangles[i / 3][static_cast<int>(i % 3)] = vertex;
        if (!isNew) continue;
        mesh.positions.push_back(content.positions[corner.position]);
        if (!content.colors.empty()) mesh.colors.push_back(content.colors[corner.position]);
        if (texcoords) mesh.texcoords.push_back(content.texcoords[corner.texcoord]);
        if (normals) mesh.normals.push_back(content.normals[corner.normal]);
    }
    return mesh;
}

/// Materials and textures of the groups. Material files and textures that are not there leave the
/// default grey and no texture, and are said: many OBJ files travel without them.
class MaterialTable {
  public:
    MaterialTable(const std::filesystem::path& folder, const std::vector<std::string>& lines,
                  LeftOut& leftOut, Scene& scene)
        : folder_(folder), leftOut_(leftOut), scene_(scene) {
        for (const std::string& line : lines) {
            for (const std::string& name : libraryNames(line, folder)) addLibrary(name);
        }
    }

    void add(const std::string& name) {
        auto found = defined_.find(name);
        if (found == defined_.end()) {
            found = defined_.find(std::string(LineReader::withoutComment(name)));
        }
        Material material;
        if (found != defined_.end()) {
            material = found->second.material;
            material.baseColorTexture = texture(found->second);
        } else if (isComplete_) {
            leftOut_.add(fmt::format("the material {}, which no material file has: it is grey",
                                     inQuotes(name)));
        }
        material.name = name;
        scene_.materials.push_back(std::move(material));
    }

  private:
    void addLibrary(const std::string& name) {
        if (const auto path = fileInside(folder_, name)) {
            if (std::ranges::find(scene_.filesBeside, *path) != scene_.filesBeside.end()) return;
            scene_.filesBeside.push_back(*path);
            std::map<std::string, MtlMaterial> read = loadMtl(*path, leftOut_);
            defined_.merge(read);
            leftOut_.add("a material of the name of one before it", read.size());
            return;
        }
        isComplete_ = false;
        scene_.warnings.push_back(fmt::format(
            "material file '{}' is not beside the model: its materials are grey", name));
    }

    int texture(const MtlMaterial& material) {
        const std::string& name = material.colourFile;
        if (name.empty()) return -1;
        const auto path = textureFile(material, folder_);
        if (!path) {
            leftOut_.add(
                fmt::format("the texture {}, which is not beside the model", inQuotes(name)));
            return -1;
        }
        const auto [found, isNew] =
            textureOf_.try_emplace(path->string(), static_cast<int>(scene_.textures.size()));
        if (!isNew) return found->second;
        const MappedFile file(*path);
        scene_.filesBeside.push_back(*path);
        if (isPngOrJpeg(file.bytes())) {
            scene_.textures.push_back(decodeTexture(file.bytes(), path->string(), leftOut_));
            if (!isPlainSrgb(file.bytes(), path->string())) {
                leftOut_.add("the gamma, primaries or colour profile of a texture");
            }
        } else {
            leftOut_.add(
                fmt::format("the texture {}, which is neither PNG nor JPEG", inQuotes(name)));
            found->second = -1;
        }
        return found->second;
    }

    std::filesystem::path folder_;
    LeftOut& leftOut_;
    Scene& scene_;
    std::map<std::string, MtlMaterial> defined_;
    bool isComplete_ = true;  // all material files are there
    std::map<std::string, int> textureOf_;
};

/// Lines of the file that no corner names.
std::size_t unusedPositions(const ObjContent& content) {
    std::vector<char> isUsed(content.positions.size(), 0);
    for (const Group& group : content.groups) {
        for (const Corner& corner : group.corners) {
            isUsed[static_cast<std::size_t>(corner.position)] = 1;
        }
    }
    return static_cast<std::size_t>(std::ranges::count(isUsed, 0));
}

Scene sceneOf(ObjContent content, const std::filesystem::path& path, LeftOut& leftOut) {
    const std::string file = path.string();
    if (content.positions.empty()) throw Error(file + ": no vertices");
    if (content.positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw Error(file + ": more than 2147483647 vertices");
    }
    Scene scene;
    scene.warnings = std::move(content.warnings);
    if (content.groups.empty()) {
        if (content.linesOfLines > 0) throw Error(file + ": lines, but no faces or points");
        leftOut.add("the line 'vn' of a file without faces", content.normals.size());
        leftOut.add("the line 'vt' of a file without faces", content.texcoords.size());
        leftOut.add("the line 'mtllib' of a file without faces", content.libraries.size());
        scene.points.positions = std::move(content.positions);
        scene.points.colors = std::move(content.colors);
        return scene;
    }
    const std::size_t unusedCount = unusedPositions(content);
    leftOut.add("a vertex that no face uses", unusedCount);
    MaterialTable materials(path.parent_path(), content.libraries, leftOut, scene);
    const bool asIs = content.groups.size() == 1 && !content.hasTriples;
    const auto addMesh = [&](Mesh mesh, const std::string& material) {
        if (!material.empty()) {
            mesh.name = material;
            mesh.material = static_cast<int>(scene.materials.size()) - 1;
            const bool isTextured = scene.materials.back().baseColorTexture >= 0;
            leftOut.add("a texture of faces without texture coordinates",
                        isTextured && mesh.texcoords.empty());
        }
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::mat4(1.0F)});
        scene.meshes.push_back(std::move(mesh));
    };
    for (Group& group : content.groups) {
        if (!group.material.empty()) materials.add(group.material);
        if (asIs) {
            addMesh(meshOfPositions(content), group.material);
            if (unusedCount > 0) dropUnusedVertices(scene.meshes.back());
            continue;
        }
        for (const std::vector<Corner>& corners : alike(std::move(group.corners))) {
            addMesh(meshOfTriples(content, corners), group.material);
        }
    }
    return scene;
}

}  // namespace

Scene loadObj(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    requireUtf8Text(mapped.text(), path.string());
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        return sceneOf(ObjParser(mapped.text(), path.string(), anchor, leftOut).parse(), path,
                       leftOut);
    });
}

}  // namespace gfxrepro::scene
