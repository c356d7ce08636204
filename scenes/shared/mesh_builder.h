// Puts meshes together from simple parts, for generators.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// Adds parts to one mesh with positions, normals and vertex colours (linear; multiplied with the
/// material's base colour). Triangles are counter-clockwise seen from outside.
class MeshBuilder {
  public:
    struct Station {
        glm::vec3 position;
        float radius;
    };

    void setColor(const glm::vec3& color) { color_ = color; }

    /// One triangle with its own normal.
    void addTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
    /// Corners in order around the outside; two triangles a, b, c and a, c, d; one normal.
    void addQuad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);
    /// A box from its centre, half sizes along its own axes, and those axes (columns, orthonormal):
    /// 12 triangles.
    void addBox(const glm::vec3& centre, const glm::vec3& halfSize,
                const glm::mat3& axes = glm::mat3(1.0F));
    /// A round tube through the stations (at least two), `sides` around, smooth normals, a
    /// minimally twisting frame; flat caps when `isCapped`. 2 · sides · (stations − 1) triangles,
    /// with caps 2 · (sides − 2) more.
    void addTube(std::span<const Station> stations, int sides, bool isCapped);
    /// Any triangles with given vertex normals; colours from setColor(). Texture coordinates: one a
    /// vertex or none at all; a mesh with some has (0, 0) where a part brought none.
    void addIndexed(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                    std::span<const glm::uvec3> triangles,
                    std::span<const glm::vec2> texcoords = {});

    std::size_t triangleCount() const { return mesh_.triangles.size(); }
    /// The mesh so far; the builder is empty afterwards.
    Mesh take(std::string_view name, int material);
    /// It becomes an instance of `scene`, with a white material of its own.
    void addTo(Scene& scene, const char* name, float roughness = 1.0F, bool isDoubleSided = false);

  private:
    Mesh mesh_;
    glm::vec3 color_{1.0F};
};

/// Some unit vector across a direction.
glm::vec3 anyAcross(const glm::vec3& direction);

/// Gives a thin sheet, drawn with back faces culled, its other side: every triangle once more with
/// the opposite winding on vertices of its own, whose normals point the other way. The back of
/// triangle i is triangle i + n, n being the number of triangles before.
void addBackSides(Mesh& mesh);

}  // namespace gfxrepro::scene
