#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/scene/animation.h"
#include "engine/scene/refine.h"
#include "scenes/indoor/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::indoor {
namespace {

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
                 int sides) {
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
    builder.addTube(fine, sides, true);
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

void addPillow(MeshBuilder& builder, const glm::vec3& halfSize, int cells, const glm::mat4& frame) {
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
        addSheet(builder, at, cells, cells, glm::vec2(halfSize) * 2.0F);
    }
}

Mesh exactly(Mesh mesh, int triangles) {
    GFXREPRO_ASSERT(mesh.triangles.size() <= static_cast<std::size_t>(triangles));
    return refinedTo(std::move(mesh), triangles);
}

namespace {

constexpr int kSize = 512;

float hashed(int x, int y, std::uint64_t seed) {
    auto h = static_cast<std::uint32_t>(x) * 0x8DA6B343U ^
             static_cast<std::uint32_t>(y) * 0xD8163841U ^
             static_cast<std::uint32_t>(seed) * 0xCB1AB31FU;
    h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12)) * 0x297A2D39U;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24F;
}

/// Value noise in [0, 1] of `periods` lattice cells across the texture, repeating.
float noise(float u, float v, glm::ivec2 periods, std::uint64_t seed) {
    const float x = u * static_cast<float>(periods.x);
    const float y = v * static_cast<float>(periods.y);
    const auto floorOf = [](float value) {
        const int whole = static_cast<int>(value);
        return static_cast<float>(whole) > value ? whole - 1 : whole;
    };
    const glm::ivec2 cell(floorOf(x), floorOf(y));
    glm::vec2 f(x - static_cast<float>(cell.x), y - static_cast<float>(cell.y));
    const auto wrap = [](int i, int period) { return (i % period + period) % period; };
    const glm::ivec2 low(wrap(cell.x, periods.x), wrap(cell.y, periods.y));
    const glm::ivec2 high(low.x + 1 == periods.x ? 0 : low.x + 1,
                          low.y + 1 == periods.y ? 0 : low.y + 1);
    f = f * f * (3.0F - 2.0F * f);
    return glm::mix(glm::mix(hashed(low.x, low.y, seed), hashed(high.x, low.y, seed), f.x),
                    glm::mix(hashed(low.x, high.y, seed), hashed(high.x, high.y, seed), f.x), f.y);
}

/// Four octaves, in [0, 1].
float turbulence(float u, float v, glm::ivec2 periods, std::uint64_t seed) {
    float sum = 0.0F;
    float weight = 0.5333F;
    for (std::uint64_t octave = 0; octave < 4; ++octave) {
        sum += weight * noise(u, v, periods, seed + octave);
        weight *= 0.5F;
        periods *= 2;
    }
    return sum;
}

float smoothStep(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

float fraction(float x) {
    return x - std::floor(x);
}

/// `color(u, v)` at texel centres: sRGB in [0, 1].
template <class Color>
image::Image8 painted(const Color& color) {
    image::Image8 result(kSize, kSize, 3);
    tbb::parallel_for(0, kSize, [&](int y) {
        for (int x = 0; x < kSize; ++x) {
            const glm::vec3 c = color((static_cast<float>(x) + 0.5F) / kSize,
                                      (static_cast<float>(y) + 0.5F) / kSize);
            for (int k = 0; k < 3; ++k) {
                result.at(x, y, k) =
                    static_cast<std::uint8_t>(std::clamp(c[k], 0.0F, 1.0F) * 255.0F + 0.5F);
            }
        }
    });
    return result;
}

/// Wood along v: fine fibres, wide growth rings.
float grain(float u, float v, std::uint64_t seed) {
    const float rings = turbulence(u, v, {6, 1}, seed);
    const float fibres = turbulence(u, v, {64, 3}, seed + 11);
    return std::clamp(0.65F * fraction(rings * 4.0F) * fraction(rings * 4.0F) + 0.35F * fibres +
                          0.25F * (fibres - 0.5F),
                      0.0F, 1.0F);
}

}  // namespace

image::Image8 planksTexture(const glm::vec3& darkSrgb, const glm::vec3& lightSrgb, int rows,
                            std::uint64_t seed) {
    return painted([&](float u, float v) {
        const float place = v * static_cast<float>(rows);
        const int row = static_cast<int>(place);
        const float shift = hashed(row, 7, seed);
        const float along = 2.0F * (u + shift);
        const auto plank = static_cast<int>(std::floor(along)) % 2;
        const float tone = hashed(row, 20 + plank, seed);
        const float across = place - static_cast<float>(row);
        const float fibre =
            grain(0.15F * across + 0.37F * tone, u, seed + 31U * static_cast<std::uint64_t>(row));
        const float edge = std::min(
            {across, 1.0F - across, 6.0F * fraction(along), 6.0F * (1.0F - fraction(along))});
        const float gap = smoothStep(0.0F, 0.03F, edge);
        const glm::vec3 wood =
            glm::mix(darkSrgb, lightSrgb, 0.25F + 0.5F * tone + 0.35F * (fibre - 0.5F));
        return wood * (0.62F + 0.38F * gap);
    });
}

image::Image8 woodTexture(const glm::vec3& darkSrgb, const glm::vec3& lightSrgb,
                          std::uint64_t seed) {
    return painted([&](float u, float v) {
        return glm::mix(darkSrgb, lightSrgb, 1.0F - 0.8F * grain(u, v, seed));
    });
}

image::Image8 weaveTexture(const glm::vec3& warpSrgb, const glm::vec3& weftSrgb, int threads,
                           std::uint64_t seed) {
    return painted([&](float u, float v) {
        const glm::vec2 p = glm::vec2(u, v) * static_cast<float>(threads);
        const glm::ivec2 cell(glm::floor(p));
        const glm::vec2 f = (p - glm::vec2(cell)) * 2.0F - 1.0F;
        const bool isWarp = (cell.x + cell.y) % 2 == 0;
        const float across = isWarp ? f.x : f.y;
        const float along = isWarp ? f.y : f.x;
        const float round = (1.0F - 0.24F * across * across) * (1.0F - 0.10F * along * along);
        const float tone =
            0.94F + 0.12F * hashed(cell.x, cell.y, seed) * turbulence(u, v, {8, 8}, seed + 3);
        return (isWarp ? warpSrgb : weftSrgb) * (round * tone);
    });
}

image::Image8 wallpaperTexture(const glm::vec3& groundSrgb, const glm::vec3& motifSrgb,
                               std::uint64_t seed) {
    return painted([&](float u, float v) {
        // A trellis of curved lozenges with a rosette in each; every second row is shifted.
        constexpr float kColumns = 4.0F;
        const float x = u * kColumns;
        const float y = v * kColumns;
        float ink = 0.0F;
        for (int k = 0; k < 2; ++k) {
            const float half = 0.5F * static_cast<float>(k);
            const glm::vec2 f(fraction(x + half) - 0.5F, fraction(y + half) - 0.5F);
            const float lozenge = std::abs(f.x) + std::abs(f.y) * (0.75F + 0.5F * std::abs(f.y));
            ink = std::max(ink, 1.0F - smoothStep(0.0F, 0.022F, std::abs(lozenge - 0.46F)));
            const float r = glm::length(f);
            const float xx = f.x * f.x;
            const float yy = f.y * f.y;
            // cos(4·angle) as a polynomial of the direction
            const float petals =
                r > 0.0F ? (xx * xx - 6.0F * xx * yy + yy * yy) / (r * r * r * r) : 0.0F;
            const float flower = 0.13F + 0.055F * petals;
            ink = std::max(ink, 0.9F * (1.0F - smoothStep(flower - 0.015F, flower + 0.008F, r)));
            ink = std::min(ink, 1.0F - 0.8F * (1.0F - smoothStep(0.03F, 0.045F, r)));
        }
        const float paper = 0.985F + 0.03F * turbulence(u, v, {64, 64}, seed);
        return glm::mix(groundSrgb, motifSrgb, ink) * paper;
    });
}

image::Image8 marbleTexture(const glm::vec3& groundSrgb, const glm::vec3& veinSrgb,
                            std::uint64_t seed) {
    return painted([&](float u, float v) {
        const float warp = turbulence(u, v, {3, 3}, seed);
        const float a = turbulence(u + 0.25F * warp, v + 0.2F * warp, {4, 4}, seed + 5);
        const float b = turbulence(u - 0.2F * warp, v + 0.3F * warp, {7, 7}, seed + 9);
        const float wide = 1.0F - smoothStep(0.0F, 0.05F, std::abs(a - 0.5F));
        const float thin = 1.0F - smoothStep(0.0F, 0.018F, std::abs(b - 0.47F));
        const float cloud = 0.25F * (turbulence(u, v, {5, 5}, seed + 13) - 0.5F);
        return glm::mix(groundSrgb * (1.0F + cloud), veinSrgb,
                        std::max(0.55F * wide * warp * 1.4F, 0.7F * thin * warp));
    });
}

image::Image8 tilesTexture(const glm::vec3& tileSrgb, const glm::vec3& groutSrgb, int tiles,
                           std::uint64_t seed) {
    return painted([&](float u, float v) {
        const glm::vec2 p = glm::vec2(u, v) * static_cast<float>(tiles);
        const glm::ivec2 cell(glm::floor(p));
        const glm::vec2 f = glm::abs((p - glm::vec2(cell)) * 2.0F - 1.0F);
        const float edge = 1.0F - std::max(f.x, f.y);
        const float tone = 0.93F + 0.10F * hashed(cell.x, cell.y, seed) +
                           0.04F * turbulence(u, v, {16, 16}, seed + 2);
        return glm::mix(groutSrgb, tileSrgb * tone, smoothStep(0.02F, 0.045F, edge));
    });
}

image::Image8 rugTexture(std::uint64_t seed) {
    constexpr glm::vec3 kRed(0.50F, 0.13F, 0.12F), kBlue(0.13F, 0.18F, 0.30F),
        kCream(0.84F, 0.77F, 0.63F), kGold(0.70F, 0.52F, 0.26F);
    return painted([&](float u, float v) {
        // Fields inside of borders, and a medallion; a rug is about 1.4 times as long as wide.
        const glm::vec2 p(2.0F * u - 1.0F, 2.0F * v - 1.0F);
        const glm::vec2 a = glm::abs(p) * glm::vec2(1.4F, 1.0F);
        const float border = std::min(1.4F - a.x, 1.0F - a.y);
        glm::vec3 color = kRed;
        const float k = 9.0F;
        const glm::vec2 f(fraction(a.x * k) - 0.5F, fraction(a.y * k) - 0.5F);
        const float diamond = std::abs(f.x) + std::abs(f.y);
        if (diamond < 0.16F) color = kGold;
        const float medallion = a.x * a.x * 1.1F + a.y * a.y * 1.5F;
        if (medallion < 0.42F) color = kBlue;
        if (medallion < 0.42F && diamond < 0.22F) color = kCream;
        if (medallion < 0.37F && medallion > 0.335F) color = kGold;
        if (medallion < 0.12F) color = diamond < 0.3F ? kGold : kRed;
        if (border < 0.24F) color = diamond < 0.28F ? kGold : kBlue;
        if (border < 0.24F && diamond < 0.12F) color = kRed;
        if (border < 0.25F && border > 0.225F) color = kCream;
        if (border < 0.045F) color = kCream;
        if (border < 0.02F) color = kBlue;
        const float wool = 0.86F + 0.26F * turbulence(u, v, {96, 96}, seed) *
                                       (0.6F + 0.8F * turbulence(u, v, {5, 5}, seed + 4));
        return color * wool;
    });
}

image::Image8 paintingTexture(int style, std::uint64_t seed) {
    return painted([&](float u, float v) {
        const float brush = 0.9F + 0.2F * turbulence(u, v, {40, 24}, seed + 2);
        if (style == 0) {
            glm::vec3 color = glm::mix(glm::vec3(0.42F, 0.58F, 0.76F),
                                       glm::vec3(0.95F, 0.83F, 0.66F), smoothStep(0.0F, 0.55F, v));
            const float cloud = turbulence(u, 2.0F * v, {4, 6}, seed);
            color = glm::mix(color, glm::vec3(0.97F, 0.95F, 0.92F),
                             smoothStep(0.52F, 0.75F, cloud) * (1.0F - smoothStep(0.3F, 0.5F, v)));
            for (int ridge = 0; ridge < 4; ++ridge) {
                const auto r = static_cast<float>(ridge);
                const float height =
                    0.42F + 0.11F * r +
                    0.22F * (turbulence(u, 0.1F * r, {3 + ridge, 4},
                                        seed + 20U * (1U + static_cast<unsigned>(ridge))) -
                             0.5F);
                const glm::vec3 hill = glm::mix(glm::vec3(0.50F, 0.60F, 0.68F),
                                                glm::vec3(0.24F, 0.34F, 0.14F), r / 3.0F);
                if (v > height) color = hill * (1.0F - 0.25F * (v - height));
            }
            return color * brush;
        }
        glm::vec3 color(0.88F, 0.84F, 0.76F);
        Random random(seed, 17);
        for (int k = 0; k < 9; ++k) {
            const float centreV = random.uniform(0.15F, 0.85F);
            const glm::vec2 centre(random.uniform(0.15F, 0.85F), centreV);
            const float halfV = random.uniform(0.04F, 0.2F);
            const glm::vec2 half(random.uniform(0.05F, 0.25F), halfV);
            const bool isRound = random.index(3) == 0;
            const float blue = random.uniform(0.1F, 0.6F);
            const float green = random.uniform(0.15F, 0.6F);
            const glm::vec3 paint(random.uniform(0.1F, 0.85F), green, blue);
            const glm::vec2 d = glm::abs(glm::vec2(u, v) - centre) / half;
            const float reach = isRound ? glm::length(d) : std::max(d.x, d.y);
            color = glm::mix(paint, color, smoothStep(0.97F, 1.0F, reach));
        }
        return color * brush;
    });
}

image::Image8 outdoorsTexture(std::uint64_t seed) {
    return painted([&](float u, float v) {
        glm::vec3 color = glm::mix(glm::vec3(0.62F, 0.79F, 0.96F), glm::vec3(0.93F, 0.96F, 0.98F),
                                   smoothStep(0.0F, 0.6F, v));
        const float cloud = turbulence(u, v, {3, 5}, seed);
        color = glm::mix(color, glm::vec3(1.0F), smoothStep(0.5F, 0.75F, cloud));
        const float trees = 0.60F + 0.16F * (turbulence(u, 0.5F, {6, 2}, seed + 3) - 0.5F) +
                            0.06F * (turbulence(u, 0.1F, {40, 2}, seed + 5) - 0.5F);
        if (v > trees) {
            const float leaf = turbulence(u, v, {48, 48}, seed + 7);
            color = glm::mix(glm::vec3(0.36F, 0.47F, 0.28F), glm::vec3(0.60F, 0.70F, 0.42F), leaf);
        }
        if (v > 0.80F) {
            const float blade = turbulence(u, v, {90, 30}, seed + 8);
            color = glm::mix(glm::vec3(0.55F, 0.68F, 0.34F), glm::vec3(0.70F, 0.80F, 0.46F), blade);
        }
        return color;
    });
}

}  // namespace gfxrepro::scene::indoor
