#include <array>

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

}  // namespace gfxrepro::scene::indoor
