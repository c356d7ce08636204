// Surfaces from functions of (u, v), cloth, tiled grids: what the bathroom is modelled with.
#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "engine/image/image.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene::indoor {

/// Cells over a surface: `at` maps (0…1)² to space, its outside is du × dv. A closed one meets
/// itself at u = 0 and 1 and is smooth there. Where `at` draws a line together to a point the
/// surface has a pole. Texture coordinates are (u, −v) · texcoordScale.
struct LoftGrid {
    int cellsU = 1, cellsV = 1;
    bool isClosed = true;
    glm::vec2 texcoordScale{1.0F};
    bool isProjected = false;  // texture coordinates are (x, z) · texcoordScale
};
void addLoft(MeshBuilder& builder, const std::function<glm::vec3(float u, float v)>& at,
             const LoftGrid& grid);

/// Cloth: a sheet of this thickness, thinner towards its rim, closed all around. `at` is its
/// middle.
void addCloth(MeshBuilder& builder, const std::function<glm::vec3(float u, float v)>& at,
              float thicknessM, int cellsU, int cellsV);

/// A flat rectangle from `corner` in cells of about `cellM`; `across` × `up` is its outside.
/// Texture coordinates are the place in the world / tileM, so that neighbours' tiles meet.
void addGrid(MeshBuilder& builder, const glm::vec3& corner, const glm::vec3& across,
             const glm::vec3& up, float cellM, float tileM = 1.0F);

/// Glazed tiles in a running bond, `columns` × `rows` (even) of them: 512², RGB, sRGB, repeating.
struct Tiles {
    glm::vec3 glazeSrgb{0.9F}, groutSrgb{0.7F};
    int columns = 4, rows = 8;
    float toneRange = 0.03F;  // from tile to tile
};
image::Image8 glazedTilesTexture(const Tiles& tiles, std::uint64_t seed);

/// (x, z) on an oval with these half axes, counter-clockwise seen from above; squareness 0 is an
/// ellipse, 1 nearly a rectangle.
glm::vec2 ovalAt(float u, const glm::vec2& halfAxes, float squareness);

}  // namespace gfxrepro::scene::indoor
