// PLY 1.0. The header says how the rows are laid out; one reader for text and one for binary rows
// give the same numbers, so what follows them is written once.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_ply_header.h"
#include "engine/scene/load_text.h"
#include "engine/scene/polygon.h"
#include "engine/scene/topology.h"

namespace gfxrepro::scene {
namespace {

using ply::Element;
using ply::Header;
using ply::Property;
using ply::PropertySlot;
using ply::Type;
using enum ply::PropertySlot;

/// Calls `visit` with a value of the C++ type that `type` stands for.
template <class Visit>
decltype(auto) visitType(Type type, Visit&& visit) {
    switch (type) {
        case Type::Int8:
            return visit(std::int8_t{});
        case Type::UInt8:
            return visit(std::uint8_t{});
        case Type::Int16:
            return visit(std::int16_t{});
        case Type::UInt16:
            return visit(std::uint16_t{});
        case Type::Int32:
            return visit(std::int32_t{});
        case Type::UInt32:
            return visit(std::uint32_t{});
        case Type::Float32:
            return visit(float{});
        case Type::Float64:
            break;
    }
    return visit(double{});
}

/// Where a reader stands, for messages: "vertex 12".
struct Row {
    std::string_view element;
    std::uint64_t number = 0;

    std::string text() const { return std::string(element) + ' ' + std::to_string(number); }
};

/// Numbers of a text body, separated by white space.
class AsciiReader {
  public:
    /// Floats are read as doubles where they are exact enough to become relative to an offset.
    AsciiReader(std::string_view text, const Header& header, const std::string& file, bool isExact)
        : file_(file),
          rest_(text.substr(header.bodyAt)),
          line_(header.bodyLine),
          lineEnd_(header.lineEnd),
          isExact_(isExact) {}

    static constexpr bool kIsAscii = true;
    Row row;

    std::size_t restBytes() const { return rest_.size() + 1; }  // the last row may lack its newline

    /// Lines with anything in them that have not been read.
    std::size_t unread() const {
        bool isFilled = false;
        std::size_t lines = 0;
        for (const char c : rest_) {
            if (c == lineEnd_) isFilled = false;
            lines += !isFilled && !isBlank(c);
            isFilled = isFilled || !isBlank(c);
        }
        return lines;
    }
    static std::size_t minimumBytes(Type) { return 2; }

    /// Rows are lines; where they are not, numbers are read in their order.
    void endRow() {
        const auto next =
            std::ranges::find_if(rest_, [this](char c) { return c == lineEnd_ || !isBlank(c); });
        splitLines += next == rest_.end() || *next == lineEnd_ ? 0 : 1;
    }
    std::size_t splitLines = 0;

    [[noreturn]] void fail(const std::string& message) const {
        throw Error({file_, line_, 0}, row.text() + ": " + message);
    }

    double number(Type type) {
        const std::string_view word = nextWord();
        if (isExact_ && type == Type::Float32) type = Type::Float64;
        return visitType(type, [&](auto sample) {
            using T = decltype(sample);
            using Parsed = std::conditional_t<std::is_integral_v<T>, std::int64_t, T>;
            const auto value = parsedNumber<Parsed>(word);
            if (!value) {
                fail(fmt::format("{} is not a number of type {}", inQuotes(word),
                                 ply::nameOf(type)));
            }
            if constexpr (std::is_integral_v<T>) {
                using Limits = std::numeric_limits<T>;
                if (*value < Limits::min() || *value > Limits::max()) {
                    fail(fmt::format("{} does not fit into {}", *value, ply::nameOf(type)));
                }
            }
            return static_cast<double>(*value);
        });
    }

    void skip(Type, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) nextWord();
    }

  private:
    std::string_view nextWord() {
        std::size_t begin = 0;
        while (begin < rest_.size() && isBlank(rest_[begin])) line_ += rest_[begin++] == lineEnd_;
        std::size_t end = begin;
        while (end < rest_.size() && !isBlank(rest_[end])) ++end;
        if (begin == end) fail("the file ends early");
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }

    static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    const std::string& file_;
    std::string_view rest_;
    int line_;
    char lineEnd_;
    bool isExact_;
};

/// Numbers of a binary body.
class BinaryReader {
  public:
    BinaryReader(std::string_view text, const Header& header, const std::string& file)
        : file_(file),
          text_(text),
          at_(header.bodyAt),
          isSwapped_((header.format == ply::Format::BigEndian) ==
                     (std::endian::native == std::endian::little)) {}

    static constexpr bool kIsAscii = false;
    Row row;

    std::size_t restBytes() const { return text_.size() - at_; }
    std::size_t unread() const { return restBytes(); }
    static std::size_t minimumBytes(Type type) { return ply::sizeBytes(type); }
    void endRow() {}
    static constexpr std::size_t splitLines = 0;

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(file_ + ": byte " + std::to_string(at_) + ": " + row.text() + ": " + message);
    }

    double number(Type type) {
        return visitType(type, [this](auto sample) { return static_cast<double>(value(sample)); });
    }

    void skip(Type type, std::uint64_t count) {
        if (count > restBytes() / ply::sizeBytes(type)) fail("the file ends early");
        at_ += count * ply::sizeBytes(type);
    }

  private:
    template <class T>
    T value(T) {
        if (sizeof(T) > restBytes()) fail("the file ends early");
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
        if (isSwapped_) std::reverse(bytes.begin(), bytes.end());
        at_ += sizeof(T);
        return std::bit_cast<T>(bytes);
    }

    const std::string& file_;
    std::string_view text_;
    std::size_t at_;
    bool isSwapped_;
};

/// What a colour of a type is a part of: of integers the largest; none of floats.
std::optional<double> maximumOf(Type type) {
    return visitType(type, [](auto sample) -> std::optional<double> {
        using T = decltype(sample);
        if constexpr (std::is_integral_v<T>) return double{std::numeric_limits<T>::max()};
        return std::nullopt;
    });
}

/// What scanners and their programs write of a vertex that changes nothing of what is drawn.
bool changesNothing(const Property& property) {
    return property.name == "confidence" || property.name == "intensity" ||
           property.name == "quality" || property.name == "flags";
}

struct Vertices {
    Mesh mesh;  // without triangles
    std::vector<float> radii;
    std::vector<std::string> warnings;
};

template <class Reader>
void skipList(Reader& reader, const Property& property) {
    const double count = reader.number(*property.countType);
    if (count < 0) reader.fail("list '" + property.name + "' has a negative count");
    reader.skip(property.type, static_cast<std::uint64_t>(count));
}

template <class Reader>
void skipElement(Reader& reader, const Element& element) {
    for (reader.row.number = 0; reader.row.number < element.count; ++reader.row.number) {
        for (const Property& property : element.properties) {
            if (property.isList()) {
                skipList(reader, property);
            } else {
                reader.skip(property.type, 1);
            }
        }
        reader.endRow();
    }
}

template <class Reader>
class VertexParser {
  public:
    VertexParser(Reader& reader, const Element& element, bool arePoints, const std::string& file,
                 Anchor& anchor, LeftOut& leftOut)
        : reader_(reader),
          element_(element),
          arePoints_(arePoints),
          anchor_(anchor),
          leftOut_(leftOut) {
        for (const Property& property : element.properties) {
            const PropertySlot slot = slotOf(property);
            slots_.push_back(has_[slot] ? kNoSlot : slot);  // red and diffuse_red: the first
            has_[slots_.back()] = true;
            if (!isColour(slots_.back())) continue;
            areBytes_ &= property.type == Type::UInt8;
            colourTypes_[slots_.back() - kRed] = property.type;
        }
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            const Property& property = element.properties[i];
            if (isComplete(slots_[i]) || changesNothing(property)) continue;
            leftOut.add(fmt::format("the property {} of vertices", inQuotes(property.name)));
        }
        if (!hasAll({kX, kY, kZ})) {
            throw Error({file, element.line, 0}, "element 'vertex' lacks x, y or z");
        }
    }

    Vertices parse(bool hasLinearColours) {
        Vertices vertices;
        Mesh& mesh = vertices.mesh;
        const bool normals = hasAll({kNx, kNy, kNz});
        const bool colors = hasAll({kRed, kGreen, kBlue});
        const bool texcoords = hasAll({kU, kV});
        const bool radii = hasAll({kRadius});
        mesh.positions.reserve(element_.count);
        if (normals) mesh.normals.reserve(element_.count);
        if (colors) mesh.colors.reserve(element_.count);
        if (texcoords) mesh.texcoords.reserve(element_.count);
        if (radii) vertices.radii.reserve(element_.count);
        std::uint64_t& number = reader_.row.number;
        for (number = 0; number < element_.count; ++number) {
            readRow();
            if (glm::any(glm::isnan(place_))) {
                leftOut_.add("a point whose place is no number");
                continue;
            }
            mesh.positions.push_back(anchor_.relative(place_));
            if (normals) {
                mesh.normals.push_back(readNormal({row_[kNx], row_[kNy], row_[kNz]}, leftOut_));
            }
            if (colors) mesh.colors.push_back({row_[kRed], row_[kGreen], row_[kBlue]});
            if (texcoords) mesh.texcoords.push_back({row_[kU], row_[kV]});
            if (radii) vertices.radii.push_back(row_[kRadius]);
        }
        if (!areBytes_) takePartsOfWhole(vertices);
        if (!areBytes_ && !hasLinearColours) makeLinear(mesh.colors, vertices.warnings);
        return vertices;
    }

  private:
    /// Integers of more bytes may hold bytes, and those of 4 bytes numbers of 2.
    void takePartsOfWhole(Vertices& vertices) const {
        double largest = 0.0, taken = 0.0;
        for (int c = 0; c < 3; ++c) {
            if (!maximumOf(colourTypes_[c])) continue;
            for (const glm::vec3& v : vertices.mesh.colors)
                largest = std::max(largest, double{v[c]});
        }
        for (int c = 0; c < 3; ++c) {
            const std::optional<double> maximum = maximumOf(colourTypes_[c]);
            if (!maximum) continue;
            const double stored = largest <= 255.0 ? 255.0 : 65535.0;
            const double whole = largest <= stored ? std::min(*maximum, stored) : *maximum;
            if (whole < *maximum) taken = whole;
            for (glm::vec3& v : vertices.mesh.colors)
                v[c] = static_cast<float>(double{v[c]} / whole);
        }
        if (taken == 0.0 || largest == 0.0) return;
        vertices.warnings.push_back(fmt::format(
            "vertex colours, integers up to {:g}, are taken as parts of {:g}", largest, taken));
    }

    bool hasAll(std::initializer_list<PropertySlot> slots) const {
        return std::all_of(slots.begin(), slots.end(),
                           [this](PropertySlot slot) { return has_[slot]; });
    }

    /// Whether the vertices have all that makes an attribute with this.
    bool isComplete(PropertySlot slot) const {
        if (slot >= kNx && slot <= kNz) return hasAll({kNx, kNy, kNz});
        if (isColour(slot)) return hasAll({kRed, kGreen, kBlue});
        if (slot == kU || slot == kV) return hasAll({kU, kV});
        return slot < kSlotCount;
    }

    void readRow() {
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            const Property& property = element_.properties[i];
            if (property.isList()) {
                skipList(reader_, property);
            } else if (slots_[i] == kNoSlot) {
                reader_.skip(property.type, 1);
            } else {
                row_[slots_[i]] = read(property, slots_[i]);
            }
        }
        reader_.endRow();
    }

    static bool isColour(PropertySlot slot) {
        return slot == kRed || slot == kGreen || slot == kBlue;
    }

    float read(const Property& property, PropertySlot slot) {
        const double number = reader_.number(property.type);
        const bool isPosition = slot <= kZ;
        if (isColour(slot) && areBytes_) return linearBytes_[static_cast<std::size_t>(number)];
        if (isPosition) place_[slot] = number;
        const auto value = static_cast<float>(number);
        // readNormal() takes normals that are not numbers.
        const bool isNormal = slot == kNx || slot == kNy || slot == kNz;
        // So are points where a depth camera saw nothing.
        if (isPosition && arePoints_ && std::isnan(value)) return value;
        if (!std::isfinite(value) && !isNormal) {
            reader_.fail(property.name + " is " + std::to_string(number) +
                         "; finite numbers in the range of float are allowed");
        }
        if (isPosition || slot == kRadius) {
            requireNear(
                number, [&](const std::string& problem) { reader_.fail(problem); }, property.name);
        }
        return value;
    }

    Reader& reader_;
    const Element& element_;
    bool arePoints_;  // no face needs them all
    Anchor& anchor_;
    LeftOut& leftOut_;
    glm::dvec3 place_{0.0};
    bool areBytes_ = true;               // all colours
    std::array<Type, 3> colourTypes_{};  // of red, green and blue
    std::vector<PropertySlot> slots_;
    std::array<bool, kNoSlot + 1> has_{};
    std::array<float, kSlotCount> row_{};
    std::array<float, 256> linearBytes_ = image::srgbDecoding();
};

/// The triangles of faces, as long as no corner's position is known: fans around the first corners.
struct Faces {
    struct Polygon {
        std::size_t firstTriangle = 0;
        std::size_t triangleCount = 0;
    };
    std::vector<glm::uvec3> triangles;
    std::vector<Polygon> polygons;  // of more than 3 corners
    std::size_t linesCount = 0;     // of fewer
};

void appendFan(Faces& faces, std::span<const std::int64_t> corners) {
    if (corners.size() < 3) ++faces.linesCount;
    if (corners.size() > 3) faces.polygons.push_back({faces.triangles.size(), corners.size() - 2});
    for (std::size_t i = 2; i < corners.size(); ++i) {
        faces.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
    }
}

/// Other triangles in the place of those fans that do not fill their polygon.
void fillPolygons(Faces& faces, std::span<const glm::vec3> positions, LeftOut& leftOut) {
    PolygonFiller filler;
    std::vector<std::uint32_t> corners;
    std::vector<glm::vec3> places;
    for (const Faces::Polygon& polygon : faces.polygons) {
        const auto fan =
            std::span(faces.triangles).subspan(polygon.firstTriangle, polygon.triangleCount);
        corners = {fan[0].x, fan[0].y};
        for (const glm::uvec3& triangle : fan) corners.push_back(triangle.z);
        places.clear();
        for (const std::uint32_t corner : corners) places.push_back(positions[corner]);
        const auto triangles = filler.fill(places);
        for (std::size_t i = 0; i < fan.size(); ++i) {
            fan[i] = {corners[triangles[i].x], corners[triangles[i].y], corners[triangles[i].z]};
        }
    }
    leftOut.add("a face of fewer than 3 corners", faces.linesCount);
    leftOut.add(kOverlap, filler.overlappingCount());
}

/// A strip of triangles, where −1 begins another one. Every second triangle is turned round.
void appendStrip(std::vector<glm::uvec3>& triangles, std::span<const std::int64_t> corners) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] < 0) begin = i + 1;
        if (i < begin + 2) continue;
        const bool isTurned = (i - begin) % 2 != 0;
        triangles.emplace_back(corners[i - 2], corners[isTurned ? i : i - 1],
                               corners[isTurned ? i - 1 : i]);
    }
}

bool isIndexList(const Property& property) {
    return property.isList() &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Whether the element's rows are faces or strips of them, whatever its name is.
bool hasFaces(const Element& element) {
    return element.name == "face" || element.name == "tristrips" ||
           std::ranges::any_of(element.properties, isIndexList);
}

/// Faces, or strips of them.
template <class Reader>
void parseFaces(Reader& reader, const Element& element, std::uint64_t vertexCount,
                const std::string& file, Faces& faces, LeftOut& leftOut) {
    const bool isStrip = element.name == "tristrips";
    std::vector<glm::uvec3>& triangles = faces.triangles;
    const auto list = std::ranges::find_if(element.properties, isIndexList);
    if (list == element.properties.end()) {
        throw Error({file, element.line, 0},
                    "element '" + element.name + "' lacks the list vertex_indices");
    }
    for (const Property& property : element.properties) {
        if (&property == &*list || changesNothing(property)) continue;
        leftOut.add(fmt::format("the property {} of faces", inQuotes(property.name)));
    }
    // A file of zeros has a face of no corners in each byte.
    const std::size_t triangleBytes =
        Reader::minimumBytes(*list->countType) + 3 * Reader::minimumBytes(list->type);
    if (!isStrip) {
        triangles.reserve(
            triangles.size() +
            std::min<std::uint64_t>(element.count, reader.restBytes() / triangleBytes));
    }
    std::vector<std::int64_t> corners;
    const auto readCorners = [&](const Property& property) {
        const double count = reader.number(*property.countType);
        const std::size_t most = reader.restBytes() / Reader::minimumBytes(property.type);
        if (count < 0 || count > static_cast<double>(most)) {
            reader.fail("a list of " + std::to_string(static_cast<std::int64_t>(count)) +
                        " indices does not fit into the file");
        }
        corners.resize(static_cast<std::size_t>(count));
        for (std::int64_t& corner : corners) {
            const double index = reader.number(property.type);
            const bool isRestart = isStrip && index == -1.0;
            const bool isVertex = index >= 0.0 && index < static_cast<double>(vertexCount) &&
                                  index == static_cast<double>(static_cast<std::int64_t>(index));
            if (!isRestart && !isVertex) {
                reader.fail(
                    fmt::format("index {} is not one of the {} vertices", index, vertexCount));
            }
            corner = static_cast<std::int64_t>(index);
        }
    };
    for (reader.row.number = 0; reader.row.number < element.count; ++reader.row.number) {
        for (const Property& property : element.properties) {
            if (&property == &*list) {
                readCorners(property);
                isStrip ? appendStrip(triangles, corners) : appendFan(faces, corners);
            } else if (property.isList()) {
                skipList(reader, property);
            } else {
                reader.skip(property.type, 1);
            }
        }
        reader.endRow();
    }
}

template <class Reader>
Scene parseBody(Reader reader, const Header& header, const std::string& file, Anchor& anchor,
                LeftOut& leftOut) {
    const Element* vertexElement = header.find("vertex");
    if (vertexElement == nullptr || vertexElement->count == 0) throw Error(file + ": no vertices");
    if (vertexElement->count > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(
            {file, vertexElement->line, 0},
            std::to_string(vertexElement->count) + " vertices; at most 4294967295 are allowed");
    }
    leftOut.add("a comment TextureFile", header.textureComments);
    Vertices vertices;
    Faces faces;
    for (const Element& element : header.elements) {
        reader.row = {element.name, 0};
        const std::size_t rowBytes = element.minimumRowBytes(Reader::kIsAscii);
        if (rowBytes == 0) continue;  // rows without properties take no room
        if (element.count > reader.restBytes() / rowBytes) {
            throw Error({file, element.line, 0}, std::to_string(element.count) +
                                                     " rows of element '" + element.name +
                                                     "' do not fit into the file");
        }
        if (element.name == "vertex") {
            const bool arePoints = std::ranges::none_of(
                header.elements, [](const Element& e) { return hasFaces(e) && e.count > 0; });
            vertices = VertexParser<Reader>(reader, element, arePoints, file, anchor, leftOut)
                           .parse(header.hasLinearColours);
        } else if (hasFaces(element)) {
            parseFaces(reader, element, vertexElement->count, file, faces, leftOut);
        } else {
            leftOut.add(fmt::format("a row of element {}", inQuotes(element.name)), element.count);
            skipElement(reader, element);
        }
    }
    leftOut.add(Reader::kIsAscii ? "a line behind the last row" : "a byte behind the last row",
                reader.unread());
    Mesh& mesh = vertices.mesh;
    if (mesh.positions.empty()) {
        throw Error({file, vertexElement->line, 0},
                    fmt::format("element 'vertex': x, y or z is no number in each of {} rows",
                                vertexElement->count));
    }
    fillPolygons(faces, mesh.positions, leftOut);
    mesh.triangles = std::move(faces.triangles);
    if (!mesh.triangles.empty()) {
        leftOut.add("the radius of a vertex with faces", vertices.radii.size());
    }
    Scene scene = sceneOfVertices(std::move(mesh), leftOut);
    if (scene.meshes.empty()) scene.points.radii = std::move(vertices.radii);
    scene.warnings = std::move(vertices.warnings);
    if (reader.splitLines > 0) {
        scene.warnings.push_back(fmt::format(
            "{} within a line: numbers are read in their order, whichever line has "
            "them",
            reader.splitLines == 1 ? "1 row ends" : fmt::format("{} rows end", reader.splitLines)));
    }
    return scene;
}

}  // namespace

Scene loadPly(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    const std::string file = path.string();
    const Header header = ply::parseHeader(mapped.text(), file);
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        const bool isExact = anchor.counts || anchor.offset != glm::dvec3(0.0);
        return header.format == ply::Format::Ascii
                   ? parseBody(AsciiReader(mapped.text(), header, file, isExact), header, file,
                               anchor, leftOut)
                   : parseBody(BinaryReader(mapped.text(), header, file), header, file, anchor,
                               leftOut);
    });
}

}  // namespace gfxrepro::scene
