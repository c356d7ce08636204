// STL, binary or text. Facets share no vertices: each is flat, as the file has it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
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
constexpr std::size_t kFacetBytes = 50;      // normal, three corners, two bytes

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
        leftOut.add("the attribute of a facet", bits == 0 ? 0 : 1);  // some write colours there
    }
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
