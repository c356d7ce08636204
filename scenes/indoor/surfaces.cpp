#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/scene/refine.h"
#include "scenes/indoor/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::indoor {

namespace {

template <class T>
T catmullRom(const T& p0, const T& p1, const T& p2, const T& p3, float u) {
    return 0.5F * (2.0F * p1 + (p2 - p0) * u + (2.0F * p0 - 5.0F * p1 + 4.0F * p2 - p3) * (u * u) +
                   (3.0F * p1 - p0 - 3.0F * p2 + p3) * (u * u * u));
}

/// Stretches of an outline without sharp edges, as finely sampled lines.
std::vector<Outline> runsOf(std::span<const glm::vec2> outline) {
    constexpr int kSamples = 24;
    std::vector<Outline> runs;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= outline.size(); ++i) {
        if (i < outline.size() && outline[i] != outline[i - 1]) continue;
        const auto keys = outline.subspan(first, i - first);
        first = i;
        if (keys.size() < 2) continue;
        Outline run{keys[0]};
        const auto last = static_cast<int>(keys.size()) - 1;
        const auto key = [&](int k) {
            return keys[static_cast<std::size_t>(std::clamp(k, 0, last))];
        };
        for (int k = 0; k < last; ++k) {
            for (int j = 1; j <= kSamples; ++j) {
                const float u = static_cast<float>(j) / kSamples;
                glm::vec2 p = catmullRom(key(k - 1), key(k), key(k + 1), key(k + 2), u);
                if (j == kSamples) p = key(k + 1);
                // Splines overshoot; only keys may lie on the axis.
                const bool isOnAxis = j == kSamples && key(k + 1).x == 0.0F;
                run.emplace_back(isOnAxis ? 0.0F : std::max(p.x, 1e-4F), p.y);
            }
        }
        runs.push_back(std::move(run));
    }
    return runs;
}

float lengthOf(const Outline& line) {
    float length = 0.0F;
    for (std::size_t i = 1; i < line.size(); ++i) length += glm::length(line[i] - line[i - 1]);
    return length;
}

/// Points at equal distances along a line, ends included.
void resample(const Outline& line, int pieces, Outline& out) {
    const float step = lengthOf(line) / static_cast<float>(pieces);
    out.push_back(line.front());
    float walked = 0.0F;
    int next = 1;
    for (std::size_t i = 1; i < line.size() && next < pieces; ++i) {
        const float length = glm::length(line[i] - line[i - 1]);
        while (next < pieces && walked + length >= step * static_cast<float>(next)) {
            const float u = (step * static_cast<float>(next) - walked) / length;
            out.push_back(glm::mix(line[i - 1], line[i], u));
            ++next;
        }
        walked += length;
    }
    out.push_back(line.back());
}

int latheTriangles(std::span<const glm::vec2> outline, int sides) {
    int strips = 0;
    for (std::size_t i = 1; i < outline.size(); ++i) {
        if (outline[i] == outline[i - 1]) continue;
        strips += (outline[i].x > 0.0F ? 1 : 0) + (outline[i - 1].x > 0.0F ? 1 : 0);
    }
    return strips * sides;
}

/// Of the outline at point i, unit, to its right.
glm::vec2 outlineNormal(std::span<const glm::vec2> outline, std::size_t i) {
    const std::size_t before = i > 0 && outline[i - 1] != outline[i] ? i - 1 : i;
    const std::size_t after = i + 1 < outline.size() && outline[i + 1] != outline[i] ? i + 1 : i;
    const glm::vec2 along = outline[after] - outline[before];
    if (outline[i].x == 0.0F) return {0.0F, along.x > 0.0F ? -1.0F : 1.0F};
    return glm::normalize(glm::vec2(along.y, -along.x));
}

}  // namespace

void addFramed(MeshBuilder& builder, const glm::mat4& frame, std::vector<glm::vec3> positions,
               std::vector<glm::vec3> normals, std::span<const glm::uvec3> triangles,
               std::span<const glm::vec2> texcoords) {
    for (glm::vec3& p : positions) p = glm::vec3(frame * glm::vec4(p, 1.0F));
    for (glm::vec3& n : normals) n = glm::normalize(glm::mat3(frame) * n);
    builder.addIndexed(positions, normals, triangles, texcoords);
}

glm::mat4 placed(const glm::vec3& position, float turnRad) {
    const float c = sdf::cosine(turnRad);
    const float s = sdf::sine(turnRad);
    return {{c, 0, -s, 0}, {0, 1, 0, 0}, {s, 0, c, 0}, {position, 1}};
}

glm::mat4 placedAlong(const glm::vec3& position, const glm::vec3& up) {
    const glm::vec3 y = glm::normalize(up);
    const glm::vec3 helper = std::abs(y.x) < 0.8F ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 z = glm::normalize(glm::cross(helper, y));
    return {{glm::cross(y, z), 0}, {y, 0}, {z, 0}, {position, 1}};
}

Outline smoothed(std::span<const glm::vec2> outline, int pieces) {
    const std::vector<Outline> runs = runsOf(outline);
    float total = 0.0F;
    for (const Outline& run : runs) total += lengthOf(run);
    Outline result;
    for (const Outline& run : runs) {
        const float share = lengthOf(run) / total * static_cast<float>(pieces);
        resample(run, std::max(1, static_cast<int>(share + 0.5F)), result);
    }
    return result;
}

void addLathe(MeshBuilder& builder, std::span<const glm::vec2> outline, int sides,
              const glm::mat4& frame, float repeats) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> triangles;
    const auto columns = static_cast<unsigned>(sides) + 1;
    float widest = 1e-3F;
    for (const glm::vec2& p : outline) widest = std::max(widest, p.x);
    const float perMetre = repeats / (2.0F * kPi * widest);
    float walked = 0.0F;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::vec2 normal = outlineNormal(outline, i);
        if (i > 0) walked += glm::length(outline[i] - outline[i - 1]);
        for (unsigned k = 0; k < columns; ++k) {
            const float u = static_cast<float>(k) / static_cast<float>(sides);
            // The last column repeats the first to the last bit, or the seam would leak.
            const float angleRad = k + 1 == columns ? 0.0F : 2.0F * kPi * u;
            const float c = sdf::cosine(angleRad);
            const float s = sdf::sine(angleRad);
            positions.emplace_back(outline[i].x * c, outline[i].y, -outline[i].x * s);
            normals.emplace_back(normal.x * c, normal.y, -normal.x * s);
            texcoords.emplace_back(u * repeats, -walked * perMetre);
        }
        if (i == 0 || outline[i] == outline[i - 1]) continue;
        const unsigned base = (static_cast<unsigned>(i) - 1) * columns;
        for (unsigned k = 0; k + 1 < columns; ++k) {
            const unsigned a = base + k;
            const unsigned d = a + columns;
            if (outline[i - 1].x > 0.0F) triangles.emplace_back(a, a + 1, d + 1);
            if (outline[i].x > 0.0F) triangles.emplace_back(a, d + 1, d);
        }
    }
    // Where a ring has shrunk to the axis, one triangle of each cell is left: a, b, c with c = d.
    addFramed(builder, frame, positions, normals, triangles, texcoords);
}

void addTurned(MeshBuilder& builder, std::span<const glm::vec2> outline, int triangles,
               const glm::mat4& frame, float repeats) {
    const Outline fine = smoothed(outline, 200);
    float length = 0.0F;
    float area = 0.0F;
    for (std::size_t i = 1; i < fine.size(); ++i) {
        const float piece = glm::length(fine[i] - fine[i - 1]);
        length += piece;
        area += piece * kPi * (fine[i].x + fine[i - 1].x);
    }
    const auto wanted = static_cast<float>(triangles);
    int pieces = std::max(2, static_cast<int>(std::sqrt(0.5F * wanted * length * length / area)));
    for (; pieces > 1; --pieces) {
        const Outline line = smoothed(outline, pieces);
        const int perSide = latheTriangles(line, 1);
        const int sides = triangles / perSide;
        if (sides < 12) continue;  // rounder rather than longer
        addLathe(builder, line, sides, frame, repeats);
        return;
    }
    throw Error("too few triangles for a turned part");
}

void addBentTube(MeshBuilder& builder, std::span<const MeshBuilder::Station> stations, int pieces,
                 int sides, bool isCapped) {
    std::vector<MeshBuilder::Station> fine;
    const auto last = static_cast<int>(stations.size()) - 1;
    const auto key = [&](int k) -> const MeshBuilder::Station& {
        return stations[static_cast<std::size_t>(std::clamp(k, 0, last))];
    };
    for (int i = 0; i <= pieces; ++i) {
        const float place = static_cast<float>(i * last) / static_cast<float>(pieces);
        const int k = std::min(static_cast<int>(place), last - 1);
        const float u = place - static_cast<float>(k);
        const auto &a = key(k - 1), &b = key(k), &c = key(k + 1), &d = key(k + 2);
        fine.push_back({catmullRom(a.position, b.position, c.position, d.position, u),
                        catmullRom(a.radius, b.radius, c.radius, d.radius, u)});
    }
    builder.addTube(fine, sides, isCapped);
}

void addSheet(MeshBuilder& builder, const std::function<glm::vec3(float, float)>& at, int cellsU,
              int cellsV, const glm::vec2& texcoordScale) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> triangles;
    for (int j = 0; j <= cellsV; ++j) {
        for (int i = 0; i <= cellsU; ++i) {
            const glm::vec2 uv(static_cast<float>(i) / static_cast<float>(cellsU),
                               static_cast<float>(j) / static_cast<float>(cellsV));
            positions.push_back(at(uv.x, uv.y));
            texcoords.push_back(uv * texcoordScale);
        }
    }
    const auto vertex = [&](int i, int j) {
        return static_cast<unsigned>(std::clamp(j, 0, cellsV) * (cellsU + 1) +
                                     std::clamp(i, 0, cellsU));
    };
    for (int j = 0; j <= cellsV; ++j) {
        for (int i = 0; i <= cellsU; ++i) {
            // Across the seam of a sheet that closes, one-sided differences would show it.
            const bool closesU = positions[vertex(0, j)] == positions[vertex(cellsU, j)];
            const bool closesV = positions[vertex(i, 0)] == positions[vertex(i, cellsV)];
            const int left = i == 0 && closesU ? cellsU - 1 : i - 1;
            const int right = i == cellsU && closesU ? 1 : i + 1;
            const int below = j == 0 && closesV ? cellsV - 1 : j - 1;
            const int above = j == cellsV && closesV ? 1 : j + 1;
            const glm::vec3 du = positions[vertex(right, j)] - positions[vertex(left, j)];
            const glm::vec3 dv = positions[vertex(i, above)] - positions[vertex(i, below)];
            const glm::vec3 normal = glm::cross(du, dv);
            const float length = glm::length(normal);
            normals.push_back(length > 0.0F ? normal / length : glm::vec3(0, 1, 0));
            if (i == cellsU || j == cellsV) continue;
            triangles.emplace_back(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
            triangles.emplace_back(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
        }
    }
    builder.addIndexed(positions, normals, triangles, texcoords);
}

void addPillow(MeshBuilder& builder, const glm::vec3& halfSize, int cells, const glm::mat4& frame,
               float tileM) {
    for (const float side : {-1.0F, 1.0F}) {
        const auto at = [&](float u, float v) {
            const float x = side * sdf::sine(kPi * (u - 0.5F));
            const float y = sdf::sine(kPi * (v - 0.5F));
            const float fx = std::max(1.0F - x * x, 0.0F);
            const float fy = std::max(1.0F - y * y, 0.0F);
            // Sides are drawn in between the corners.
            const glm::vec3 p(x * (1.0F - 0.10F * fy), y * (1.0F - 0.10F * fx),
                              side * std::sqrt(fx * fy));
            return glm::vec3(frame * glm::vec4(p * halfSize, 1.0F));
        };
        addSheet(builder, at, cells, cells, glm::vec2(halfSize) * (2.0F / tileM));
    }
}

Mesh exactly(Mesh mesh, int triangles) {
    GFXREPRO_ASSERT(mesh.triangles.size() <= static_cast<std::size_t>(triangles));
    return refinedTo(std::move(mesh), triangles);
}

}  // namespace gfxrepro::scene::indoor
