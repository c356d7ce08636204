#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/random.h"
#include "scenes/indoor/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::indoor {

namespace {

/// Vertices of a loft, row by row, both ends of a closed row kept for the texture's seam.
struct Rows {
    int columns = 0, rows = 0;
    std::vector<glm::vec3> positions, normals;

    unsigned index(int column, int row) const {
        return static_cast<unsigned>(row * columns + column);
    }
};

/// Sums the vertices' normals over those that lie at one place: the seam and the poles.
void weldNormals(Rows& rows, bool isClosed) {
    for (int j = 0; j < rows.rows; ++j) {
        glm::vec3& first = rows.normals[rows.index(0, j)];
        glm::vec3& last = rows.normals[rows.index(rows.columns - 1, j)];
        if (isClosed) first = last = first + last;
        if (rows.positions[rows.index(0, j)] != rows.positions[rows.index(1, j)]) continue;
        glm::vec3 sum(0.0F);
        for (int i = 0; i < rows.columns; ++i) sum += rows.normals[rows.index(i, j)];
        for (int i = 0; i < rows.columns; ++i) rows.normals[rows.index(i, j)] = sum;
    }
}

}  // namespace

void addLoft(MeshBuilder& builder, const std::function<glm::vec3(float u, float v)>& at,
             const LoftGrid& grid) {
    Rows rows{grid.cellsU + 1, grid.cellsV + 1, {}, {}};
    std::vector<glm::vec2> texcoords;
    for (int j = 0; j < rows.rows; ++j) {
        const float v = static_cast<float>(j) / static_cast<float>(grid.cellsV);
        for (int i = 0; i < rows.columns; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(grid.cellsU);
            const bool isSeam = grid.isClosed && i == grid.cellsU;
            rows.positions.push_back(isSeam ? rows.positions[rows.index(0, j)] : at(u, v));
            const glm::vec3& position = rows.positions.back();
            const glm::vec2 place =
                grid.isProjected ? glm::vec2(position.x, position.z) : glm::vec2(u, -v);
            texcoords.push_back(place * grid.texcoordScale);
        }
    }
    rows.normals.resize(rows.positions.size(), glm::vec3(0.0F));
    std::vector<glm::uvec3> triangles;
    const auto addTriangle = [&](unsigned a, unsigned b, unsigned c) {
        const glm::vec3 &p = rows.positions[a], &q = rows.positions[b], &r = rows.positions[c];
        const glm::vec3 normal = glm::cross(q - p, r - p);
        const float longest =
            std::max({glm::length(q - p), glm::length(r - q), glm::length(p - r)});
        // At poles, and where a row has run together to a line, nothing is left of a triangle.
        if (glm::length(normal) <= 1e-4F * longest * longest) return;
        triangles.emplace_back(a, b, c);
        for (const unsigned corner : {a, b, c}) rows.normals[corner] += normal;
    };
    for (int j = 0; j < grid.cellsV; ++j) {
        for (int i = 0; i < grid.cellsU; ++i) {
            const unsigned a = rows.index(i, j), b = rows.index(i + 1, j);
            const unsigned c = rows.index(i + 1, j + 1), d = rows.index(i, j + 1);
            addTriangle(a, b, c);
            addTriangle(a, c, d);
        }
    }
    weldNormals(rows, grid.isClosed);
    for (glm::vec3& normal : rows.normals) {
        const float length = glm::length(normal);
        normal = length > 0.0F ? normal / length : glm::vec3(0.0F, 1.0F, 0.0F);
    }
    builder.addIndexed(rows.positions, rows.normals, triangles, texcoords);
}

void addCloth(MeshBuilder& builder, const std::function<glm::vec3(float u, float v)>& at,
              float thicknessM, int cellsU, int cellsV) {
    constexpr float kStep = 1e-3F;  // of u and v, for the sheet's normal
    const auto side = [&](float u, float v, float sign) {
        const glm::vec3 du = at(std::min(u + kStep, 1.0F), v) - at(std::max(u - kStep, 0.0F), v);
        const glm::vec3 dv = at(u, std::min(v + kStep, 1.0F)) - at(u, std::max(v - kStep, 0.0F));
        const float rim = std::min({u, 1.0F - u, v, 1.0F - v});
        const float share = 0.45F + 0.55F * std::min(1.0F, rim * 14.0F);
        return at(u, v) + glm::normalize(glm::cross(du, dv)) * (0.5F * thicknessM * share * sign);
    };
    // Once around the sheet in u: there on its outside, back on its inside. The ends in v are shut
    // by rows that run together in the middle.
    const int around = 2 * cellsU + 2;
    const auto loop = [&](float u, float v) {
        const int column = static_cast<int>(u * static_cast<float>(around) + 0.5F) % around;
        const int row = static_cast<int>(v * static_cast<float>(cellsV + 2) + 0.5F);
        const float sheetV =
            static_cast<float>(std::clamp(row - 1, 0, cellsV)) / static_cast<float>(cellsV);
        const bool isOutside = column <= cellsU;
        const float sheetU = static_cast<float>(isOutside ? column : around - 1 - column) /
                             static_cast<float>(cellsU);
        if (row == 0 || row == cellsV + 2) return at(sheetU, sheetV);
        return side(sheetU, sheetV, isOutside ? 1.0F : -1.0F);
    };
    addLoft(builder, loop, {around, cellsV + 2, true, glm::vec2(1.0F)});
}

void addGrid(MeshBuilder& builder, const glm::vec3& corner, const glm::vec3& across,
             const glm::vec3& up, float cellM, float tileM) {
    const float width = glm::length(across), height = glm::length(up);
    const int columns = std::max(1, static_cast<int>(width / cellM + 0.5F));
    const int rows = std::max(1, static_cast<int>(height / cellM + 0.5F));
    const glm::vec3 normal = glm::normalize(glm::cross(across, up));
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> triangles;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const glm::vec3 position =
                corner + across * (static_cast<float>(i) / static_cast<float>(columns)) +
                up * (static_cast<float>(j) / static_cast<float>(rows));
            positions.push_back(position);
            texcoords.emplace_back(glm::dot(position, across) / (width * tileM),
                                   -glm::dot(position, up) / (height * tileM));
            if (i == columns || j == rows) continue;
            const auto a = static_cast<unsigned>(j * (columns + 1) + i);
            const unsigned d = a + static_cast<unsigned>(columns) + 1;
            triangles.emplace_back(a, a + 1, d + 1);
            triangles.emplace_back(a, d + 1, d);
        }
    }
    const std::vector<glm::vec3> normals(positions.size(), normal);
    builder.addIndexed(positions, normals, triangles, texcoords);
}

image::Image8 glazedTilesTexture(const Tiles& tiles, std::uint64_t seed) {
    constexpr int kSize = 512;
    constexpr float kGroutPx = 2.5F, kBevelPx = 3.0F;  // half a joint; its rounded shoulder
    Random random(seed, 17);
    std::vector<float> tones;
    for (int i = 0; i < tiles.columns * tiles.rows; ++i) {
        tones.push_back(1.0F - tiles.toneRange * random.uniform());
    }
    const glm::vec2 sizePx(static_cast<float>(kSize) / static_cast<float>(tiles.columns),
                           static_cast<float>(kSize) / static_cast<float>(tiles.rows));
    image::Image8 texture(kSize, kSize, 3);
    for (int y = 0; y < kSize; ++y) {
        const auto row = static_cast<int>((static_cast<float>(y) + 0.5F) / sizePx.y);
        const float shift = row % 2 == 0 ? 0.0F : 0.5F * sizePx.x;
        for (int x = 0; x < kSize; ++x) {
            const glm::vec2 place(static_cast<float>(x) + 0.5F + shift,
                                  static_cast<float>(y) + 0.5F);
            const auto column = static_cast<int>(place.x / sizePx.x);
            const glm::vec2 in = place - sizePx * glm::vec2(column, row);
            const glm::vec2 edge = glm::min(in, sizePx - in);
            const float inside =
                std::clamp((std::min(edge.x, edge.y) - kGroutPx) / kBevelPx, 0.0F, 1.0F);
            const auto tile =
                static_cast<std::size_t>(row * tiles.columns + column % tiles.columns);
            const glm::vec3 color = glm::mix(tiles.groutSrgb, tiles.glazeSrgb * tones[tile],
                                             inside * inside * (3.0F - 2.0F * inside));
            for (int c = 0; c < 3; ++c) {
                texture.at(x, y, c) =
                    static_cast<std::uint8_t>(std::clamp(color[c], 0.0F, 1.0F) * 255.0F + 0.5F);
            }
        }
    }
    return texture;
}

glm::vec2 ovalAt(float u, const glm::vec2& halfAxes, float squareness) {
    const float angleRad = 2.0F * std::numbers::pi_v<float> * u;
    const float c = sdf::cosine(angleRad), s = -sdf::sine(angleRad);
    // Radius of x⁴ + y⁴ = 1 in this direction.
    const float square = 1.0F / std::sqrt(std::sqrt(c * c * c * c + s * s * s * s));
    return halfAxes * glm::vec2(c, s) * (1.0F + squareness * (square - 1.0F));
}

}  // namespace gfxrepro::scene::indoor
