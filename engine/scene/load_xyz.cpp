// Points in text, one a line: "x y z", and behind it what programs of scanners write.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_lines.h"

namespace gfxrepro::scene {
namespace {

constexpr std::size_t kNoRole = 9;  // else x, y, z, and then two vectors: normals and colours
constexpr std::pair<std::string_view, std::size_t> kColumnNames[] = {
    {"x", 0},        {"y", 1},        {"z", 2},        {"nx", 3}, {"ny", 4}, {"nz", 5},
    {"normal_x", 3}, {"normal_y", 4}, {"normal_z", 5}, {"r", 6},  {"g", 7},  {"b", 8},
    {"red", 6},      {"green", 7},    {"blue", 8},     {"rf", 6}, {"gf", 7}, {"bf", 8},
};

/// Columns stand apart by blanks, commas or semicolons.
std::vector<std::string_view> columnsIn(std::string_view line) {
    constexpr std::string_view kBetween = " \t\r,;";
    std::vector<std::string_view> columns;
    for (std::size_t at = line.find_first_not_of(kBetween); at != line.npos;
         at = line.find_first_not_of(kBetween, at)) {
        const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
        columns.push_back(line.substr(at, end - at));
        at = end;
    }
    return columns;
}

class XyzParser {
  public:
    XyzParser(std::string_view text, const std::string& file, Anchor& anchor, LeftOut& leftOut)
        : lines_(text, file), anchor_(anchor), leftOut_(leftOut) {}

    Scene parse() {
        while (lines_.nextLine()) parseLine(lines_.name());
        if (count_ && *count_ != pointCount_) {
            lines_.fail(fmt::format("the file says {} points and has {}", *count_, pointCount_));
        }
        if (scene_.points.positions.empty()) lines_.fail("no points");
        settleVectors();
        return std::move(scene_);
    }

  private:
    void parseLine(std::string_view whole) {
        std::string_view line = LineReader::withoutComment(whole);
        if (line.starts_with("//")) line = {};
        const std::vector<std::string_view> columns = columnsIn(line);
        if (roles_.empty() && noteNames(columns.empty() ? whole : line, columns.empty())) return;
        if (columns.empty()) return;
        if (roles_.empty() && columns.size() == 1 && !count_) {
            count_ = parsedNumber<std::uint64_t>(columns[0]);
            if (count_) return;
        }
        if (roles_.empty()) settleRoles(columns);
        if (columns.size() != roles_.size()) {
            lines_.fail(
                fmt::format("{} columns; the first point has {}", columns.size(), roles_.size()));
        }
        parsePoint(columns);
    }

    /// Whether the line names columns. What a comment names counts where it is of all columns.
    bool noteNames(std::string_view line, bool isComment) {
        std::vector<std::string> names;
        line.remove_prefix(std::min(line.find_first_not_of("/# \t"), line.size()));
        for (const std::string_view name : columnsIn(line)) names.push_back(lowerCase(name));
        for (const char* axis : {"x", "y", "z"}) {
            if (std::ranges::count(names, axis) != 1) return false;
        }
        names_ = std::move(names);
        areNamesOfComment_ = isComment;
        return true;
    }

    /// By the names of the columns, else by their number: what is behind the place comes in threes,
    /// behind an intensity where one is left.
    void settleRoles(const std::vector<std::string_view>& columns) {
        if (columns.size() < 3) lines_.fail("the line lacks a number");
        if (columns.size() != names_.size() && areNamesOfComment_) names_.clear();
        roles_.assign(columns.size(), kNoRole);
        hasNames_ = !names_.empty();
        if (hasNames_) {
            if (columns.size() != names_.size()) {
                lines_.fail(fmt::format("{} columns; {} are named", columns.size(), names_.size()));
            }
            for (std::size_t i = 0; i < roles_.size(); ++i) {
                const auto* found =
                    std::ranges::find(kColumnNames, std::string_view(names_[i]),
                                      &std::pair<std::string_view, std::size_t>::first);
                if (found != std::end(kColumnNames)) roles_[i] = found->second;
            }
            for (const std::size_t first : {std::size_t{3}, std::size_t{6}}) {
                std::size_t there = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    there += std::ranges::count(roles_, first + k) == 1;
                }
                if (there == 3) continue;
                for (std::size_t& role : roles_) {
                    if (role >= first && role < first + 3) role = kNoRole;
                }
            }
        } else {
            const std::size_t more = columns.size() - 3, first = 3 + more % 3;
            for (std::size_t i = 0; i < columns.size(); ++i) {
                if (i < 3) roles_[i] = i;
                if (more % 3 < 2 && i >= first && i < first + 6) roles_[i] = 3 + i - first;
            }
        }
        for (std::size_t i = 0; i < roles_.size(); ++i) {
            if (roles_[i] != kNoRole) continue;
            leftOut_.add(hasNames_ ? "the column " + inQuotes(names_[i])
                                   : fmt::format("column {}", i + 1));
        }
    }

    void parsePoint(const std::vector<std::string_view>& columns) {
        ++pointCount_;
        std::array<double, kNoRole> values{};
        bool isNowhere = false;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (roles_[i] == kNoRole) continue;
            const auto value = parsedNumber<double>(columns[i]);
            const bool isOfPlace = roles_[i] < 3;
            if (!value || !(std::isfinite(*value) || (isOfPlace && std::isnan(*value)))) {
                lines_.fail(fmt::format("{} is not a finite number", inQuotes(columns[i])));
            }
            if (isOfPlace && std::isfinite(*value)) {
                requireNear(*value, [this](const std::string& problem) { lines_.fail(problem); });
            }
            isNowhere = isNowhere || std::isnan(*value);
            values[roles_[i]] = *value;
        }
        if (isNowhere) {
            leftOut_.add("a point whose place is no number");
            return;
        }
        scene_.points.positions.push_back(anchor_.relative({values[0], values[1], values[2]}));
        for (std::size_t v = 0; v < vectors_.size(); ++v) {
            const std::size_t first = 3 + 3 * v;
            if (std::ranges::find(roles_, first) == roles_.end()) continue;
            vectors_[v].emplace_back(values[first], values[first + 1], values[first + 2]);
        }
    }

    /// Vectors that nobody named are normals where all have about unit length (or none), and
    /// colours where none is negative.
    void settleVectors() {
        const auto isDirection = [](const glm::vec3& v) {
            return v == glm::vec3(0.0F) || std::abs(glm::length(v) - 1.0F) < 0.01F;
        };
        const auto isColour = [](const glm::vec3& v) { return std::min({v.r, v.g, v.b}) >= 0.0F; };
        bool hasNormals = false, hasColours = false;
        for (std::size_t v = 0; v < vectors_.size(); ++v) {
            std::vector<glm::vec3>& values = vectors_[v];
            if (values.empty()) continue;
            const bool areNormals =
                hasNames_ ? v == 0 : !hasNormals && std::ranges::all_of(values, isDirection);
            const bool areColours =
                !areNormals &&
                (hasNames_ ? v == 1 : !hasColours && std::ranges::all_of(values, isColour));
            if (!hasNames_) {
                const auto first =
                    static_cast<std::size_t>(std::ranges::find(roles_, 3 + 3 * v) - roles_.begin());
                const std::string columns = fmt::format("columns {} to {}", first + 1, first + 3);
                if (!areNormals && !areColours) {
                    leftOut_.add(columns);
                    continue;
                }
                scene_.warnings.push_back(
                    fmt::format("{} are taken as {}", columns, areNormals ? "normals" : "colours"));
            }
            if (areNormals) {
                hasNormals = true;
                std::ranges::transform(values, values.begin(), unitNormal);
                scene_.points.normals = std::move(values);
            } else {
                hasColours = true;
                makeLinear(values, scene_.warnings);
                scene_.points.colors = std::move(values);
            }
        }
    }

    LineReader lines_;
    Anchor& anchor_;
    LeftOut& leftOut_;
    std::vector<std::string> names_;
    bool areNamesOfComment_ = false, hasNames_ = false;
    std::vector<std::size_t> roles_;      // of columns; empty before the first point
    std::optional<std::uint64_t> count_;  // in the first line of some files
    std::uint64_t pointCount_ = 0;
    std::array<std::vector<glm::vec3>, 2> vectors_;
    Scene scene_;
};

}  // namespace

Scene loadXyz(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    requireUtf8Text(mapped.text(), path.string());
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        return XyzParser(mapped.text(), path.string(), anchor, leftOut).parse();
    });
}

}  // namespace gfxrepro::scene
