// OFF as Geomview describes it, in text.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/files.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_lines.h"
#include "engine/scene/polygon.h"
#include "engine/scene/topology.h"

namespace gfxrepro::scene {
namespace {

class OffParser {
  public:
    OffParser(std::string_view text, const std::string& file, Anchor& anchor, LeftOut& leftOut)
        : lines_(text, file), anchor_(anchor), leftOut_(leftOut) {}

    Scene parse() {
        parseHeader();
        for (std::uint64_t i = 0; i < vertexCount_; ++i) parseVertex();
        for (std::uint64_t i = 0; i < faceCount_; ++i) parseFace();
        std::size_t linesBehind = 0;
        while (lines_.nextLine()) linesBehind += !lines_.word().empty();
        std::vector<std::string> warnings;
        settleColours(warnings);
        leftOut_.add(kOverlap, filler_.overlappingCount());
        leftOut_.add("a line behind the last face", linesBehind);
        Scene scene = sceneOfVertices(std::move(mesh_), leftOut_);
        scene.warnings = std::move(warnings);
        return scene;
    }

  private:
    /// The first word of the next line that has one.
    std::string_view nextWord() {
        lines_.nextFilledLine();
        return lines_.word();
    }

    std::uint64_t whole(std::string_view word, std::uint64_t end, const char* what) const {
        const std::optional<std::uint64_t> value = parsedNumber<std::uint64_t>(word);
        if (value && *value < end) return *value;
        lines_.fail(fmt::format("{} is no {}; 0 to {} are allowed", inQuotes(word), what, end - 1));
    }

    /// [ST][C][N]OFF; some files have no such word, or the first count right behind it.
    void parseHeader() {
        std::string_view word = nextWord();
        if (const std::size_t at = word.find("OFF"); at != word.npos) {
            std::string_view kind = word.substr(0, at);
            hasTexcoords_ = takePrefix(kind, "ST");
            hasColors_ = takePrefix(kind, "C");
            hasNormals_ = takePrefix(kind, "N");
            if (!kind.empty()) {
                lines_.fail(fmt::format("{} is not read; OFF is, with ST, C and N before it",
                                        inQuotes(word)));
            }
            word = word.substr(at + 3);
            if (word.empty()) word = lines_.word();
            if (word == "BINARY") lines_.fail("binary OFF is not read; text is");
            if (word.empty()) word = nextWord();
        }
        constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
        vertexCount_ = whole(word, kMost, "count of vertices");
        word = lines_.word();
        faceCount_ = whole(word.empty() ? nextWord() : word, kMost, "count of faces");
        if (vertexCount_ == 0) lines_.fail("no vertices");
    }

    static bool takePrefix(std::string_view& text, std::string_view prefix) {
        const bool isThere = text.starts_with(prefix);
        if (isThere) text.remove_prefix(prefix.size());
        return isThere;
    }

    void parseVertex() {
        lines_.nextFilledLine();
        mesh_.positions.push_back(lines_.position(anchor_));
        const auto vector = [&] {
            glm::vec3 v;
            for (int i = 0; i < 3; ++i) v[i] = lines_.number();
            return v;
        };
        if (hasNormals_) mesh_.normals.push_back(unitNormal(vector()));
        std::vector<float> rest;
        if (hasColors_) {
            glm::vec3 colour;
            for (int i = 0; i < 3; ++i) {
                hasPoint_ |= isNextWithPoint();
                colour[i] = lines_.number();
            }
            mesh_.colors.push_back(colour);
        }
        const bool isWithPoint = isNextWithPoint();
        while (const auto value = lines_.optionalNumber()) rest.push_back(*value);
        const std::size_t texcoordAt = hasColors_ && rest.size() % 2 == 1 ? 1 : 0;  // behind alpha
        if (texcoordAt == 1) {
            hasPoint_ |= isWithPoint;
            largestAlpha_ = std::max(largestAlpha_, rest[0]);
            ++alphaCount_;
            alphasOf1_ += rest[0] == 1.0F;
            alphasOf255_ += rest[0] == 255.0F;
        }
        std::size_t used = texcoordAt;
        if (hasTexcoords_) {
            if (rest.size() < used + 2) lines_.fail("the vertex lacks texture coordinates");
            mesh_.texcoords.emplace_back(rest[used], rest[used + 1]);
            used += 2;
        }
        leftOut_.add("a number behind a vertex", rest.size() - used);
    }

    bool isNextWithPoint() {
        const std::string_view rest = lines_.name();
        return rest.substr(0, rest.find_first_of(" \t")).find_first_of(".eE") != rest.npos;
    }

    /// Integers are parts of 255, and numbers with a point parts of 1: red, green, blue and alpha.
    void settleColours(std::vector<std::string>& warnings) {
        float largest = 0.0F;
        for (const glm::vec3& c : mesh_.colors) largest = std::max({largest, c.r, c.g, c.b});
        const float ofAll = std::max(largest, largestAlpha_);
        const bool areOf255 = ofAll > 2.0F || (ofAll > 1.0F && !hasPoint_);
        if (!areOf255 && !hasPoint_ && largest == 1.0F) {
            warnings.emplace_back(
                "vertex colours of 0 and 1, without a point, are taken as parts of 1, not of 255");
        }
        makeLinear(mesh_.colors, warnings, areOf255);
        leftOut_.add("the alpha of a vertex's colour",
                     alphaCount_ - (areOf255 ? alphasOf255_ : alphasOf1_));
    }

    void parseFace() {
        const std::uint64_t count = whole(nextWord(), 1U << 30, "count of corners");
        std::vector<std::uint32_t> corners;
        std::vector<glm::vec3> places;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::string_view word = lines_.word();
            if (word.empty()) lines_.fail("the face lacks corners");
            corners.push_back(
                static_cast<std::uint32_t>(whole(word, vertexCount_, "vertex of the file")));
            places.push_back(mesh_.positions[corners.back()]);
        }
        if (!lines_.word().empty()) leftOut_.add("the colour of a face");
        if (count < 3) leftOut_.add("a face of fewer than 3 corners");
        if (count < 3) return;
        for (const glm::uvec3& t : filler_.fill(places)) {
            mesh_.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
        }
    }

    LineReader lines_;
    Anchor& anchor_;
    bool hasTexcoords_ = false, hasColors_ = false, hasNormals_ = false;
    std::uint64_t vertexCount_ = 0, faceCount_ = 0;
    bool hasPoint_ = false;  // some number of a colour
    float largestAlpha_ = 0.0F;
    std::size_t alphaCount_ = 0, alphasOf1_ = 0, alphasOf255_ = 0;
    Mesh mesh_;
    PolygonFiller filler_;
    LeftOut& leftOut_;
};

}  // namespace

Scene loadOff(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    requireUtf8Text(mapped.text(), path.string());
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        return OffParser(mapped.text(), path.string(), anchor, leftOut).parse();
    });
}

}  // namespace gfxrepro::scene
