#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/indoor/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::indoor {
namespace {

/// Blows faces out; a smooth map of the box's inside onto itself, so that its derivative carries
/// the normals.
void bulge(const RoundedBox& box, glm::vec3& position, glm::vec3& normal) {
    const glm::vec3 s = position / box.halfSize;
    glm::mat3 derivative(1.0F);  // columns: by x, y, z
    glm::vec3 moved = position;
    for (int a = 0; a < 3; ++a) {
        const int u = (a + 1) % 3;
        const int v = (a + 2) % 3;
        const float k = box.bulge[a] / box.halfSize[a];
        const float fu = 1.0F - s[u] * s[u];
        const float fv = 1.0F - s[v] * s[v];
        moved[a] = position[a] * (1.0F + k * fu * fv);
        derivative[a][a] = 1.0F + k * fu * fv;
        derivative[u][a] = -2.0F * position[a] * k * s[u] / box.halfSize[u] * fv;
        derivative[v][a] = -2.0F * position[a] * k * s[v] / box.halfSize[v] * fu;
    }
    position = moved;
    normal = glm::normalize(glm::inverse(glm::transpose(derivative)) * normal);
}

/// Grid lines across a side: closer in the roundings.
std::vector<float> linesAcross(float half, float inner, const RoundedBox& box) {
    std::vector<float> lines;
    const auto add = [&](float from, float to, int cells) {
        for (int i = 0; i < cells; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(cells);
            lines.push_back(from + (to - from) * u);
        }
    };
    add(-half, -inner, box.edgeCells);
    add(-inner, inner, box.faceCells);
    add(inner, half, box.edgeCells);
    lines.push_back(half);
    return lines;
}

}  // namespace

void addRoundedBox(MeshBuilder& builder, const RoundedBox& box, const glm::mat4& frame) {
    const glm::vec3 inner = box.halfSize - box.radius;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        const std::vector<float> linesU = linesAcross(box.halfSize[u], inner[u], box);
        const std::vector<float> linesV = linesAcross(box.halfSize[v], inner[v], box);
        const auto columns = static_cast<unsigned>(linesU.size());
        for (const float side : {-1.0F, 1.0F}) {
            std::vector<glm::vec3> positions, normals;
            std::vector<glm::vec2> texcoords;
            std::vector<glm::uvec3> triangles;
            for (std::size_t j = 0; j < linesV.size(); ++j) {
                for (std::size_t i = 0; i < linesU.size(); ++i) {
                    glm::vec3 q(0.0F);
                    q[axis] = side * box.halfSize[axis];
                    q[u] = linesU[i];
                    q[v] = linesV[j];
                    const glm::vec3 core = glm::clamp(q, -inner, inner);
                    glm::vec3 normal = glm::normalize(q - core);
                    glm::vec3 position = core + box.radius * normal;
                    // v of the texture runs along y where the face has it.
                    texcoords.push_back((u == 1 ? glm::vec2(q[v], -q[u]) : glm::vec2(q[u], -q[v])) /
                                        box.tileM);
                    if (box.bulge != glm::vec3(0.0F)) bulge(box, position, normal);
                    positions.push_back(position);
                    normals.push_back(normal);
                    if (i + 1 == linesU.size() || j + 1 == linesV.size()) continue;
                    const unsigned a =
                        static_cast<unsigned>(j) * columns + static_cast<unsigned>(i);
                    const glm::uvec4 c(a, a + 1, a + 1 + columns, a + columns);
                    const bool isUp = side > 0.0F;
                    triangles.push_back(isUp ? glm::uvec3(c.x, c.y, c.z)
                                             : glm::uvec3(c.x, c.z, c.y));
                    triangles.push_back(isUp ? glm::uvec3(c.x, c.z, c.w)
                                             : glm::uvec3(c.x, c.w, c.z));
                }
            }
            addFramed(builder, frame, positions, normals, triangles, texcoords);
        }
    }
}

void addPanel(MeshBuilder& builder, const glm::vec3& min, const glm::vec3& max, float tileM,
              const glm::mat4& frame) {
    const glm::vec3 size = max - min;
    int grain = 0;
    for (int a = 1; a < 3; ++a) {
        if (size[a] > size[grain]) grain = a;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (const bool isUp : {false, true}) {
            std::vector<glm::vec3> positions;
            std::vector<glm::vec2> texcoords;
            glm::vec3 normal(0.0F);
            normal[axis] = isUp ? 1.0F : -1.0F;
            for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                glm::vec3 p = isUp ? max : min;
                p[u] = corner.x != 0 ? max[u] : min[u];
                p[v] = corner.y != 0 ? max[v] : min[v];
                positions.push_back(p);
                texcoords.push_back((u == grain ? glm::vec2(p[v], -p[u]) : glm::vec2(p[u], -p[v])) /
                                    tileM);
            }
            const std::vector<glm::vec3> normals(4, normal);
            const std::array triangles{isUp ? glm::uvec3(0, 1, 2) : glm::uvec3(0, 2, 1),
                                       isUp ? glm::uvec3(0, 2, 3) : glm::uvec3(0, 3, 2)};
            addFramed(builder, frame, positions, normals, triangles, texcoords);
        }
    }
}

void addRectangle(MeshBuilder& builder, const glm::vec3& centre, const glm::vec3& halfAcross,
                  const glm::vec3& halfUp, const glm::vec2& repeats) {
    const std::array positions{centre - halfAcross - halfUp, centre + halfAcross - halfUp,
                               centre + halfAcross + halfUp, centre - halfAcross + halfUp};
    const glm::vec3 normal = glm::normalize(glm::cross(halfAcross, halfUp));
    const std::array normals{normal, normal, normal, normal};
    const std::array texcoords{glm::vec2(0, repeats.y), repeats, glm::vec2(repeats.x, 0),
                               glm::vec2(0, 0)};
    const std::array triangles{glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)};
    builder.addIndexed(positions, normals, triangles, texcoords);
}

void addRoundedTop(MeshBuilder& builder, const glm::vec2& halfSize, float radius, int cornerCells,
                   float height, const glm::mat4& frame) {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> triangles;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::vec2 sign(corner == 0 || corner == 3 ? 1.0F : -1.0F, corner < 2 ? 1.0F : -1.0F);
        for (int k = 0; k <= cornerCells; ++k) {
            const float u = static_cast<float>(k) / static_cast<float>(cornerCells);
            const float angleRad = 0.5F * kPi * (static_cast<float>(corner) + u);
            const glm::vec2 p = sign * (halfSize - radius) +
                                radius * glm::vec2(sdf::cosine(angleRad), sdf::sine(angleRad));
            positions.emplace_back(p.x, height, -p.y);
            texcoords.emplace_back(p.x, p.y);
        }
    }
    for (unsigned k = 1; k + 1 < positions.size(); ++k) triangles.emplace_back(0, k, k + 1);
    const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 1, 0));
    addFramed(builder, frame, positions, normals, triangles, texcoords);
}

namespace {

glm::vec3 onFrame(const glm::mat4& frame, const glm::vec3& p) {
    return glm::vec3(frame * glm::vec4(p, 1.0F));
}

/// A leaf of one sheet along a line that sags: from `base` in `direction` (unit), folded a little
/// along its middle. 4 · cells triangles.
void addLeaf(MeshBuilder& builder, const glm::vec3& base, const glm::vec3& direction,
             const glm::vec3& across, float lengthM, float halfWidthM, float sagM, int cells) {
    const glm::vec3 up = glm::normalize(glm::cross(across, direction));
    const auto at = [&](float u, float v) {
        // Pointed at both ends, widest before the middle; the stalk keeps a little width so that no
        // triangle is degenerate.
        const float w = 0.06F + 4.0F * v * (1.0F - v) * (1.25F - 0.5F * v);
        const float x = (2.0F * u - 1.0F) * halfWidthM * std::min(w, 1.0F);
        return base + direction * (lengthM * v) + across * x +
               up * (0.35F * std::abs(x) - 0.15F * lengthM * v * v) - glm::vec3(0, sagM * v * v, 0);
    };
    addSheet(builder, at, 2, cells);
}

/// A plank whose ends are cut at 45°: one of the four sides of a picture frame, with a raised outer
/// and a low inner edge. Along +x at y = inner … inner + width.
void addMitred(MeshBuilder& builder, float halfLength, float inner, float widthM, float depthM,
               const glm::mat4& frame) {
    const std::array<glm::vec2, 5> outline{glm::vec2(0.0F, 0.0F),
                                           {0.0F, 0.55F * depthM},
                                           {0.35F * widthM, 0.7F * depthM},
                                           {0.8F * widthM, depthM},
                                           {widthM, 0.0F}};
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
        const auto corner = [&](const glm::vec2& p, float side) {
            return onFrame(frame, {side * (halfLength + p.x), inner + p.x, p.y});
        };
        builder.addQuad(corner(outline[i], -1), corner(outline[i], 1), corner(outline[i + 1], 1),
                        corner(outline[i + 1], -1));
    }
}

constexpr std::array<glm::vec3, 12> kBookColors{{{0.36F, 0.06F, 0.05F},
                                                 {0.06F, 0.13F, 0.24F},
                                                 {0.07F, 0.20F, 0.12F},
                                                 {0.45F, 0.30F, 0.12F},
                                                 {0.62F, 0.56F, 0.44F},
                                                 {0.13F, 0.11F, 0.10F},
                                                 {0.50F, 0.16F, 0.08F},
                                                 {0.18F, 0.30F, 0.38F},
                                                 {0.55F, 0.44F, 0.20F},
                                                 {0.28F, 0.10F, 0.20F},
                                                 {0.70F, 0.68F, 0.62F},
                                                 {0.16F, 0.22F, 0.16F}}};

/// Cover with a rounded back at z = 0, pages within; w thick, h high, d deep, standing on y = 0.
void addBook(MeshBuilder& builder, const glm::vec3& size, int spineCells, const glm::vec3& color,
             const glm::vec3& label, const glm::mat4& frame) {
    const float w = size.x;
    const float h = size.y;
    const float d = size.z;
    const float cover = 0.0025F;
    const glm::mat4 inset = frame * placed({0, 0, 0});
    builder.setColor(color);
    for (const float x : {0.0F, w - cover}) {
        addPanel(builder, {x, 0, -d}, {x + cover, h, -0.004F}, 1.0F, inset);
    }
    // The back bulges out by a fifth of the thickness, with raised bands and a label.
    const auto back = [&](float v0, float v1, float lift) {
        const auto at = [&](float u, float v) {
            const float c = 2.0F * u - 1.0F;
            return onFrame(inset, {u * w, h * (v0 + (v1 - v0) * v),
                                   0.2F * w * (1.0F - c * c) - 0.005F + lift});
        };
        addSheet(builder, at, spineCells, 1);
    };
    back(0.0F, 0.62F, 0.0F);
    back(0.82F, 1.0F, 0.0F);
    builder.setColor(label);
    back(0.62F, 0.82F, 0.0F);
    back(0.10F, 0.115F, 0.001F);
    back(0.90F, 0.915F, 0.001F);
    builder.setColor({0.74F, 0.70F, 0.60F});
    addPanel(builder, {cover, 0.004F, -d + 0.004F}, {w - cover, h - 0.004F, -0.006F}, 1.0F, inset);
}

}  // namespace

void addFrame(MeshBuilder& frameBuilder, MeshBuilder* picture, const glm::vec2& halfSize,
              float widthM, float depthM, const glm::mat4& frame) {
    for (int side = 0; side < 4; ++side) {
        const bool isLying = side % 2 == 0;
        const float angleRad = 0.5F * kPi * static_cast<float>(side);
        const float c = std::round(sdf::cosine(angleRad));
        const float s = std::round(sdf::sine(angleRad));
        const glm::mat4 turn{{c, s, 0, 0}, {-s, c, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
        addMitred(frameBuilder, isLying ? halfSize.x : halfSize.y,
                  isLying ? halfSize.y : halfSize.x, widthM, depthM, frame * turn);
    }
    if (picture == nullptr) return;
    addRectangle(*picture, onFrame(frame, {0, 0, 0.3F * depthM}),
                 glm::mat3(frame) * glm::vec3(halfSize.x, 0, 0),
                 glm::mat3(frame) * glm::vec3(0, halfSize.y, 0));
}

void addBooks(MeshBuilder& builder, float lengthM, float highestM, int spineCells, Random& random,
              const glm::mat4& frame) {
    float x = 0.0F;
    while (x < lengthM - 0.05F) {
        // A set of volumes of one edition, or a single book.
        const auto volumes = random.index(4) == 0 ? 3 + random.index(4) : 1;
        const float light = random.uniform(0.8F, 1.2F);
        const glm::vec3 color = kBookColors[random.index(kBookColors.size())] * light;
        const glm::vec3 label =
            random.index(2) == 0 ? glm::vec3(0.58F, 0.46F, 0.20F) : 0.5F * color;
        const float depthM = random.uniform(0.15F, 0.19F);
        const float heightM = highestM * random.uniform(0.70F, 1.0F);
        const glm::vec3 size(random.uniform(0.018F, 0.045F), heightM, depthM);
        for (unsigned k = 0; k < volumes && x < lengthM - size.x; ++k) {
            const glm::mat4 place = frame * placed({x, 0, -random.uniform(0.0F, 0.008F)});
            addBook(builder, size, spineCells, glm::min(color, 0.75F), label, place);
            x += size.x + 0.001F;
        }
        if (volumes == 1 && size.x + x >= lengthM) break;
        if (random.index(9) == 0) x += random.uniform(0.03F, 0.12F);
    }
}

void addPalm(MeshBuilder& builder, float heightM, int fronds, int leafCells, Random& random,
             const glm::mat4& frame) {
    constexpr int kPairs = 22;
    for (int f = 0; f < fronds; ++f) {
        const float share = static_cast<float>(f) / static_cast<float>(fronds);
        const float angleRad = 2.39996F * static_cast<float>(f) + random.uniform(-0.3F, 0.3F);
        const glm::vec3 out(sdf::cosine(angleRad), 0.0F, sdf::sine(angleRad));
        const glm::vec3 side = glm::cross(glm::vec3(0, 1, 0), out);
        const float reach = heightM * (0.18F + 0.36F * share) * random.uniform(0.9F, 1.1F);
        const float rise = heightM * (1.0F - 0.45F * share) * random.uniform(0.92F, 1.0F);
        const auto spine = [&](float t) {
            return out * (reach * t * (0.35F + 0.65F * t) + 0.02F) +
                   glm::vec3(0, rise * t * (1.45F - 0.55F * t * t), 0);
        };
        const float purity = 0.22F + 0.10F * random.uniform();
        const glm::vec3 green(0.07F + 0.05F * random.uniform(), purity, 0.045F);
        builder.setColor(green * glm::vec3(1.2F, 0.9F, 0.7F));
        std::vector<MeshBuilder::Station> stem;
        for (int k = 0; k <= 2 * leafCells; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(2 * leafCells);
            stem.push_back({onFrame(frame, spine(t)), 0.008F - 0.0065F * t});
        }
        builder.addTube(stem, 5, false);
        builder.setColor(green);
        for (int k = 0; k < kPairs; ++k) {
            const float t = 0.36F + 0.64F * static_cast<float>(k) / kPairs;
            const glm::vec3 along = glm::normalize(spine(t + 0.01F) - spine(t));
            const float lengthM = heightM * (0.07F + 0.42F * (1.0F - t) * (t - 0.1F) + 0.05F);
            for (const float sign : {-1.0F, 1.0F}) {
                const glm::vec3 direction = glm::normalize(
                    side * sign + along * 0.75F + glm::vec3(0, random.uniform(-0.05F, 0.2F), 0));
                const glm::vec3 across =
                    glm::normalize(glm::cross(direction, glm::cross(side * sign, along))) * sign;
                addLeaf(builder, onFrame(frame, spine(t)), glm::mat3(frame) * direction,
                        glm::mat3(frame) * across, lengthM, 0.011F * (0.6F + heightM * 0.4F),
                        0.25F * lengthM, leafCells);
            }
        }
    }
}

void addBroadLeaves(MeshBuilder& builder, float heightM, int leaves, int leafCells, Random& random,
                    const glm::mat4& frame) {
    constexpr int kStems = 4;
    for (int s = 0; s < kStems; ++s) {
        const float lean = 0.16F * heightM;
        const float turnRad = 1.9F * static_cast<float>(s) + random.uniform(0.0F, 0.5F);
        const glm::vec3 out(sdf::cosine(turnRad), 0.0F, sdf::sine(turnRad));
        const float top = heightM * random.uniform(0.72F, 0.95F);
        const auto stemAt = [&](float t) {
            return out * (0.03F + lean * t * t) + glm::vec3(0, top * t, 0);
        };
        builder.setColor({0.13F, 0.09F, 0.05F});
        std::vector<MeshBuilder::Station> stem;
        for (int k = 0; k <= 8; ++k) {
            const float t = static_cast<float>(k) / 8.0F;
            stem.push_back({onFrame(frame, stemAt(t)), 0.011F - 0.007F * t});
        }
        builder.addTube(stem, 6, false);
        const int count = leaves / kStems;
        for (int k = 0; k < count; ++k) {
            const float t = 0.25F + 0.75F * static_cast<float>(k + 1) / static_cast<float>(count);
            const float angleRad = 2.39996F * static_cast<float>(k) + turnRad;
            const glm::vec3 away(sdf::cosine(angleRad), 0.0F, sdf::sine(angleRad));
            const glm::vec3 direction =
                glm::normalize(away + glm::vec3(0, random.uniform(0.15F, 0.9F) * t, 0));
            const glm::vec3 across = glm::normalize(glm::cross(direction, glm::vec3(0, 1, 0)));
            const float green = random.uniform(0.75F, 1.2F);
            builder.setColor(glm::vec3(0.05F, 0.17F, 0.05F) * green);
            const float lengthM = random.uniform(0.16F, 0.25F) * (0.6F + 0.4F * heightM);
            addLeaf(builder, onFrame(frame, stemAt(t) + away * 0.012F),
                    glm::mat3(frame) * direction, glm::mat3(frame) * across, lengthM,
                    0.28F * lengthM, 0.25F * lengthM, leafCells);
        }
    }
}

void addCurtain(MeshBuilder& builder, float widthM, float heightM, int folds, int cellsPerFold,
                int cellsDown, Random& random, const glm::mat4& frame) {
    std::vector<float> phases, depths;
    for (int k = 0; k <= folds + 1; ++k) {
        phases.push_back(random.uniform(-0.25F, 0.25F));
        depths.push_back(random.uniform(0.75F, 1.2F));
    }
    const auto at = [&](float u, float v) {
        // v from the bottom to the top, so that the outside faces +z.
        const float down = 1.0F - v;
        const float place = u * static_cast<float>(folds);
        const auto k = std::min(static_cast<std::size_t>(place), phases.size() - 2);
        const float f = place - static_cast<float>(k);
        const float smooth = f * f * (3.0F - 2.0F * f);
        const float phase = glm::mix(phases[k], phases[k + 1], smooth) * down;
        const float depth = glm::mix(depths[k], depths[k + 1], smooth);
        const float angleRad = 2.0F * kPi * (place + phase);
        const float amplitude = (0.028F + 0.022F * down) * depth;
        return onFrame(frame, {widthM * u + 0.25F * amplitude * sdf::sine(2.0F * angleRad),
                               -heightM * down, amplitude * sdf::cosine(angleRad)});
    };
    addSheet(builder, at, folds * cellsPerFold, cellsDown, {4.0F * widthM, 3.0F * heightM});
}

}  // namespace gfxrepro::scene::indoor
