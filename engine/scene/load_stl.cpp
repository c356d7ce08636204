// STL, binary or text. Facets share no vertices: each is flat, as the file has it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_lines.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kStlHeaderBytes = 84;  // 80 of text, and the count of facets
constexpr std::size_t kFacetBytes = 50;      // normal, three corners, two bytes of colour

std::uint64_t declaredBytes(std::string_view bytes) {
    std::uint32_t facets = 0;
    if (bytes.size() < kStlHeaderBytes) return 0;
    std::memcpy(&facets, bytes.data() + 80, sizeof(facets));
    return kStlHeaderBytes + kFacetBytes * std::uint64_t{facets};
}

bool isTextStl(std::string_view bytes) {
    // Exporters of binary files write "solid" there, too.
    if (bytes.substr(0, 1024).find('\0') != bytes.npos) return false;
    bytes = withoutByteOrderMark(bytes);
    const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    return lowerCase(bytes.substr(begin, 5)) == "solid";
}

/// STL sets no colours; two ways are usual. Materialise's header has "COLOR=" and the whole's red,
/// green, blue and alpha: its facets have one of their own where bit 15 is 0, red in the lowest
/// bits. In VisCAM's and SolidView's files facets have one where bit 15 is 1, blue in the lowest.
class FacetColours {
  public:
    explicit FacetColours(std::string_view header, LeftOut& leftOut) : leftOut_(leftOut) {
        constexpr std::string_view kWhole = "COLOR=";
        const std::size_t at = header.find(kWhole);
        if (at != header.npos && at + kWhole.size() + 4 <= header.size()) {
            const auto value = [&](std::size_t i) {
                return static_cast<unsigned char>(header[at + kWhole.size() + i]);
            };
            whole_.emplace(value(0), value(1), value(2));
            *whole_ /= 255.0F;
            leftOut_.add("the alpha of the header's COLOR=", value(3) == 255 ? 0 : 1);
        }
        leftOut_.add("the header's MATERIAL=", header.find("MATERIAL=") == header.npos ? 0 : 1);
    }

    /// sRGB, of the facet whose last two bytes these are; none: it has none.
    std::optional<glm::vec3> of(std::uint16_t bits) {
        if (whole_ && (bits & 0x8000U) != 0) return whole_;
        const glm::vec3 fromLow(bits & 31U, bits >> 5 & 31U, bits >> 10 & 31U);
        if (whole_) return fromLow / 31.0F;
        if ((bits & 0x8000U) != 0) return glm::vec3(fromLow.b, fromLow.g, fromLow.r) / 31.0F;
        leftOut_.add("the attribute of a facet", bits == 0 ? 0 : 1);
        return std::nullopt;
    }

  private:
    std::optional<glm::vec3> whole_;
    LeftOut& leftOut_;
};

void setColour(Mesh& mesh, const glm::uvec3& triangle, const glm::vec3& srgb) {
    mesh.colors.resize(mesh.positions.size(), glm::vec3(1.0F));
    for (int i = 0; i < 3; ++i) {
        for (int c = 0; c < 3; ++c) mesh.colors[triangle[i]][c] = image::linearOf(srgb[c]);
    }
}

std::uint32_t addCorner(Mesh& mesh, const glm::vec3& position) {
    mesh.positions.push_back(position);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

Mesh binaryMesh(std::string_view bytes, const std::string& file, Anchor& anchor, LeftOut& leftOut) {
    const std::uint64_t needed = declaredBytes(bytes);
    if (needed == 0 || needed > bytes.size()) {
        throw Error(fmt::format(
            "{}: has {} bytes; a binary STL file of its {} facets has {}, one "
            "in text begins with 'solid'",
            file, bytes.size(), needed == 0 ? 0 : (needed - kStlHeaderBytes) / kFacetBytes,
            std::max<std::uint64_t>(needed, kStlHeaderBytes)));
    }
    leftOut.add("a byte behind the facets", bytes.size() - needed);
    FacetColours colours(bytes.substr(0, 80), leftOut);
    Mesh mesh;
    mesh.positions.reserve((needed - kStlHeaderBytes) / kFacetBytes * 3);
    for (std::size_t at = kStlHeaderBytes; at < needed; at += kFacetBytes) {
        std::array<glm::vec3, 4> facet;  // its normal, and its corners
        std::memcpy(facet.data(), bytes.data() + at, sizeof(facet));
        glm::uvec3 triangle(0);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 corner(facet[static_cast<std::size_t>(i) + 1]);
            for (int axis = 0; axis < 3; ++axis) {
                requireNear(corner[axis], [&](const std::string& problem) {
                    throw Error(
                        fmt::format("{}: facet {}: {}", file, mesh.triangles.size(), problem));
                });
            }
            triangle[i] = addCorner(mesh, anchor.relative(corner));
        }
        mesh.triangles.push_back(triangle);
        std::uint16_t bits = 0;
        std::memcpy(&bits, bytes.data() + at + 48, sizeof(bits));
        if (const auto colour = colours.of(bits)) setColour(mesh, triangle, *colour);
    }
    if (!mesh.colors.empty()) mesh.colors.resize(mesh.positions.size(), glm::vec3(1.0F));
    return mesh;
}

/// Goes behind a solid's name, which ends with its line, or, in a file of one line, before the next
/// "facet normal". False where there is none.
bool skipName(LineReader& lines) {
    for (std::string word = lowerCase(lines.word()); !word.empty();
         word = lowerCase(lines.word())) {
        if (word == "facet" && lowerCase(lines.name().substr(0, 6)) == "normal") return true;
    }
    return false;
}

Mesh textMesh(std::string_view text, const std::string& file, Anchor& anchor) {
    LineReader lines(text, file);
    Mesh mesh;
    std::size_t corners = 0;
    bool isWithin = true;  // a solid, which has its end
    while (lines.nextLine()) {
        for (std::string word = lowerCase(lines.word()); !word.empty();
             word = lowerCase(lines.word())) {
            isWithin = word != "endsolid";
            // Its name may be anything; in a file of one line the next solid ends it.
            while (!isWithin && !word.empty() && word != "solid") word = lowerCase(lines.word());
            if (word.empty()) break;
            if (word == "solid") {
                if (!skipName(lines)) break;
                isWithin = true;
                word = "facet";
            }
            if (word == "vertex") {
                addCorner(mesh, lines.position(anchor));
                ++corners;
            } else if (word == "facet") {
                for (int i = 0; i < 4; ++i) lines.word();  // "normal" and its numbers
            } else if (word == "endloop") {
                if (corners != 3) {
                    lines.fail(fmt::format("a facet of {} corners; 3 are allowed", corners));
                }
                const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
                mesh.triangles.emplace_back(last - 2, last - 1, last);
                corners = 0;
            } else if (word != "outer" && word != "loop" && word != "endfacet") {
                lines.fail(fmt::format(
                    "{} is unknown; solid, facet normal, outer loop, vertex, endloop, endfacet "
                    "and endsolid are allowed",
                    inQuotes(word)));
            }
        }
    }
    if (corners > 0) lines.fail("the file ends within a facet");
    if (isWithin) lines.fail("the file ends without 'endsolid'");
    return mesh;
}

}  // namespace

Scene loadStl(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    const std::string file = path.string();
    requireUtf8Text(mapped.text(), file);
    const bool isText = isTextStl(mapped.text());
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        Mesh mesh = isText ? textMesh(mapped.text(), file, anchor)
                           : binaryMesh(mapped.text(), file, anchor, leftOut);
        if (mesh.triangles.empty()) throw Error(file + ": no facets");
        return sceneOf(std::move(mesh));
    });
}

}  // namespace gfxrepro::scene
