// What the loaders share: numbers, colours, coordinates far from the origin.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/foreign_text.h"
#include "engine/image/srgb.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/scene.h"
#include "engine/scene/topology.h"

namespace gfxrepro::scene {

/// Editors on Windows put one before UTF-8.
inline std::string_view withoutByteOrderMark(std::string_view text) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

/// Of a text's lines: programs of old Macintoshes write no line feeds.
inline char lineEndOf(std::string_view text) {
    return text.find('\n') == text.npos ? '\r' : '\n';
}

/// A word of a file as messages show it: in a file of zeros one has gigabytes, and a message ends
/// at the first of them.
inline std::string inQuotes(std::string_view word) {
    constexpr std::size_t kMostBytes = 100;
    std::size_t shown = std::min(kMostBytes, word.size());
    while (shown > 0 && shown < word.size() && (word[shown] & 0xC0) == 0x80) --shown;
    std::string text = asUtf8(word.substr(0, shown));
    std::ranges::replace(text, '\0', '?');
    if (word.size() == shown) return '\'' + text + '\'';
    return '\'' + text + "…' (" + std::to_string(word.size()) + " bytes)";
}

/// Vertex colours of OBJ, OFF and PLY are what a display shows (sRGB), as parts of 1, or, where any
/// is above 2 or the file says so, of 255: makes them linear. Warns where the numbers do not tell
/// which of the two.
inline void makeLinear(std::vector<glm::vec3>& colors, std::vector<std::string>& warnings,
                       bool areOf255 = false) {
    float largest = 0.0F;
    bool areInteger = true;
    for (const glm::vec3& c : colors) {
        largest = std::max({largest, c.r, c.g, c.b});
        areInteger = areInteger && c == glm::floor(c);
    }
    areOf255 = areOf255 || largest > 2.0F;  // some round to a little above 1
    const float whole = areOf255 ? 255.0F : 1.0F;
    const bool areBytes = areInteger && areOf255 && largest <= 255.0F;
    if ((largest > 1.0F || areOf255) && !areBytes) {
        warnings.push_back(
            fmt::format("vertex colours up to {:g} are taken as parts of {:g}", largest, whole));
    }
    for (glm::vec3& color : colors) {
        for (int c = 0; c < 3; ++c) color[c] = image::linearOf(color[c] / whole);
    }
}

/// Calls `fail` with a message where a coordinate is not within ±kMaxCoordinate.
template <class Fail>
void requireNear(double value, const Fail& fail, std::string_view name = "a coordinate") {
    if (std::abs(value) <= double{kMaxCoordinate}) return;
    fail(fmt::format("{} is {:g}; {:g} to {:g} are allowed", name, value, -kMaxCoordinate,
                     kMaxCoordinate));
}

inline bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A direction of unit length. One that is so already keeps its bits (saved files come back as they
/// were); one without a direction becomes zero.
inline glm::vec3 unitNormal(const glm::vec3& normal) {
    const float squaredLength = glm::dot(normal, normal);
    if (std::abs(squaredLength - 1.0F) < 1e-4F) return normal;
    const glm::vec3 unit = normal / std::sqrt(squaredLength);
    return isFinite(unit) ? unit : glm::vec3(0.0F);
}

/// Scanners write normals that are not numbers.
inline glm::vec3 readNormal(const glm::vec3& normal, LeftOut& leftOut) {
    if (!isFinite(normal)) leftOut.add("a normal that is not finite");
    return unitNormal(normal);
}

/// What the coordinates of a scene are relative to. One that counts says how many vertices floats
/// put where others of the file's are.
class Anchor {
  public:
    explicit Anchor(const glm::dvec3& at, bool isCounting = false)
        : offset(at), counts(isCounting) {}

    glm::vec3 relative(const glm::dvec3& position) {
        const glm::vec3 rounded(position - offset);
        if (counts) count(position, rounded);
        return rounded;
    }

    /// Of the vertices of one instance, which already are relative.
    void countJoined(const std::vector<glm::vec3>& positions, const glm::dmat4& toWorld) {
        Anchor own(glm::dvec3(0.0), true);
        for (const glm::vec3& position : positions) own.relative(toWorld * glm::dvec4(position, 1));
        joined += own.joined;
    }

    const glm::dvec3 offset;
    const bool counts;
    std::size_t joined = 0;

  private:
    void count(const glm::dvec3& position, const glm::vec3& rounded) {
        const glm::vec3 r = rounded + 0.0F;  // −0 is 0
        const auto [place, isNew] = places_.number(std::bit_cast<std::array<std::uint32_t, 3>>(r));
        if (isNew) {
            first_.push_back(position);
        } else if (areOthers(first_[place], position)) {
            ++joined;
        }
    }

    /// By more than doubles are rounded, or than what every float takes for 0.
    static bool areOthers(const glm::dvec3& a, const glm::dvec3& b) {
        constexpr double kRounding = 1e-12, kLeast = std::numeric_limits<float>::min();
        return glm::any(glm::greaterThan(glm::abs(a - b),
                                         glm::max(kRounding * glm::abs(a), glm::dvec3(kLeast))));
    }

    KeyNumbers<std::array<std::uint32_t, 3>> places_;
    std::vector<glm::dvec3> first_;  // of the vertices at each place
};

/// Of a file's vertices: points where it has no triangles, else a mesh of those that these use.
inline Scene sceneOfVertices(Mesh mesh, LeftOut& leftOut) {
    if (!mesh.triangles.empty()) {
        leftOut.add("a vertex that no face uses", dropUnusedVertices(mesh));
        return sceneOf(std::move(mesh));
    }
    leftOut.add("the texture coordinates of a point", mesh.texcoords.size());
    Scene scene;
    scene.points = {std::move(mesh.positions), std::move(mesh.normals), {}, std::move(mesh.colors)};
    return scene;
}

/// The middle of the box in round numbers, along each axis on which it lies farther from 0 than 64
/// of its diagonals: a float there tells less than a hundred thousandth of one.
inline glm::dvec3 distantMiddle(const Box& box) {
    constexpr double kDiagonals = 64.0;
    glm::dvec3 middle(0.0);
    const double diagonal = box.isEmpty() ? 0.0 : glm::length(glm::dvec3(box.size()));
    if (diagonal == 0.0) return middle;
    const double unit = std::pow(10.0, std::floor(std::log10(diagonal)));
    for (int axis = 0; axis < 3; ++axis) {
        const double at = 0.5 * (double{box.min[axis]} + double{box.max[axis]});
        if (std::abs(at) > kDiagonals * diagonal) middle[axis] = std::round(at / unit) * unit;
    }
    return middle;
}

/// Calls `visit` with the vertices of each instance, and with the points, and what puts them into
/// the world.
template <class Visit>
void visitPlaces(const Scene& scene, Visit&& visit) {
    visit(scene.points.positions, glm::mat4(1.0F));
    for (const Instance& instance : scene.instances) {
        visit(scene.meshes[instance.mesh].positions, instance.worldFromMesh);
    }
}

/// Where most vertices and points lie, within the box of all: around their median along each axis,
/// to both sides twice as far as half of them stand from it. A stray one far away does not count.
/// Where more than half share each coordinate, as a triangle's corners do along two axes, half of
/// the others decide.
inline Box bulkOf(const Scene& scene) {
    constexpr std::size_t kMostPlaces = std::size_t{1} << 16;  // the others are as these
    const std::size_t step =
        1 + (scene.vertexCount() + scene.points.positions.size()) / kMostPlaces;
    std::vector<glm::vec3> places;
    std::size_t next = 0;
    visitPlaces(scene, [&](const std::vector<glm::vec3>& positions, const glm::mat4& toWorld) {
        for (; next < positions.size(); next += step) {
            places.emplace_back(toWorld * glm::vec4(positions[next], 1.0F));
        }
        next -= positions.size();
    });
    const Box whole = scene.bounds();
    if (places.empty()) return whole;
    const auto medianOf = [](std::vector<float>& values) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    glm::vec3 median(0.0F), half(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        for (const glm::vec3& place : places) values.push_back(place[axis]);
        median[axis] = medianOf(values);
        for (float& value : values) value = std::abs(value - median[axis]);
        half[axis] = 2.0F * medianOf(values);
    }
    if (half == glm::vec3(0.0F)) {
        std::vector<float> distances;
        for (const glm::vec3& place : places) {
            if (place != median) distances.push_back(glm::length(place - median));
        }
        std::ranges::sort(distances);
        if (!distances.empty()) half = glm::vec3(2.0F * distances[distances.size() / 2]);
    }
    return {glm::max(median - half, whole.min), glm::min(median + half, whole.max)};
}

/// The places in the world that vertices and points have, each counted once in an instance.
inline std::size_t differentPlaces(const Scene& scene) {
    std::size_t sum = 0;
    visitPlaces(scene, [&](std::vector<glm::vec3> places, const glm::mat4& toWorld) {
        for (glm::vec3& place : places) place = toWorld * glm::vec4(place, 1.0F);
        sum += weldedByPosition(places).count;
    });
    return sum;
}

/// A scene whose coordinates floats can hold. `load(anchor, leftOut)` reads a file and subtracts
/// the offset from all coordinates in double; where most of the scene lies far from it
/// without one, or floats make one place of several, it reads again with one, which Scene::offset
/// keeps and a warning tells.
template <class Load>
Scene nearOrigin(Load&& loadLess) {
    const auto load = [&](const glm::dvec3& offset) {
        LeftOut leftOut;
        Anchor anchor(offset);
        Scene scene = loadLess(anchor, leftOut);
        leftOut.tell(scene.warnings);
        return scene;
    };
    constexpr double kFarM = 1e4;
    const glm::dvec3 none(0.0);
    Scene scene = load(none);
    const Box bulk = bulkOf(scene);
    glm::dvec3 offset = offsetOf(bulk);
    // Others are moved only where they are coarse: fine parts of rooms, and many vertices at one
    // place, which may be others than floats tell.
    const bool isFar = offset != none && bulk.size() != glm::vec3(0.0F) &&
                       (glm::length(offset) >= kFarM || offsetOf(scene.bounds()) != none);
    if (offset == none) offset = distantMiddle(bulk);
    if (offset == none) return scene;
    Scene moved = load(offset);
    if (moved.bounds().size() == glm::vec3(0.0F)) return scene;  // one point is as good anywhere
    if (!isFar && differentPlaces(moved) <= differentPlaces(scene)) return scene;
    moved.offset = offset;
    moved.warnings.push_back(
        fmt::format("its coordinates lie far from the origin: ({}, {}, {}) is subtracted from them",
                    offset.x, offset.y, offset.z));
    return moved;
}

/// Whether two corners of some triangle are different vertices at one place.
inline bool hasEmptyEdge(const Scene& scene) {
    return std::ranges::any_of(scene.meshes, [](const Mesh& mesh) {
        const auto areAtOnePlace = [&](std::uint32_t a, std::uint32_t b) {
            return a != b && mesh.positions[a] == mesh.positions[b];
        };
        return std::ranges::any_of(mesh.triangles, [&](const glm::uvec3& t) {
            return areAtOnePlace(t.x, t.y) || areAtOnePlace(t.y, t.z) || areAtOnePlace(t.z, t.x);
        });
    });
}

/// The same, with a warning where the scene is too large for floats, wherever its origin lies: they
/// put vertices together, in a scene that is large or that has such an edge.
template <class Load>
Scene loadedNearOrigin(Load&& loadLess) {
    Scene scene = nearOrigin(loadLess);
    constexpr float kCoarse = 65536.0F;  // from there on a float's step is 1/128
    const Box box = scene.bounds();
    const glm::vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
    const float most = box.isEmpty() ? 0.0F : std::max({reach.x, reach.y, reach.z});
    if (most < kCoarse && !hasEmptyEdge(scene)) return scene;
    Anchor anchor(scene.offset, true);
    LeftOut ignored;
    loadLess(anchor, ignored);
    if (anchor.joined > 0) {
        scene.warnings.push_back(fmt::format(
            "floats put {} of its vertices where others are: it reaches to {:.6g}, where their "
            "steps are {:g}",
            anchor.joined, most, std::nextafter(most, 2.0F * most) - most));
    }
    return scene;
}

}  // namespace gfxrepro::scene
