// Parts of the bathroom generator. Everything is built where it stands: x to the right, z from the
// window wall into the room, the floor at y = 0, in metres.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "runner/core/random.h"
#include "runner/image/image.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene::bathroom_parts {

constexpr glm::vec3 kRoom(3.4F, 2.6F, 4.0F);

// --- surfaces (bathroom_surfaces.cpp) ---

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

// --- reflectors (bathroom_ceramics.cpp, bathroom_chrome.cpp) ---

constexpr glm::vec3 kTubCentre(1.15F, 0.0F, 0.75F);
constexpr glm::vec2 kTubHalf(0.84F, 0.42F);
constexpr float kTubRimM = 0.59F;
void addTubOutside(MeshBuilder& builder);
void addTubInside(MeshBuilder& builder);

/// The vanity hangs on the wall x = 0.
constexpr float kVanityZ = 2.4F, kVanityHalfM = 0.62F, kVanityDepthM = 0.52F;
constexpr float kVanityBottomM = 0.28F, kCounterM = 0.82F;
void addVanity(MeshBuilder& builder);
constexpr glm::vec3 kBasinCentre(0.27F, kCounterM, kVanityZ);
void addBasin(MeshBuilder& builder);

/// Against the wall x = kRoom.x.
constexpr float kToiletZ = 1.85F;
void addToilet(MeshBuilder& builder);

/// A quarter of a round tiled wall around the corner (kRoom.x, 0), open at its right end.
constexpr float kShowerRadiusM = 1.1F, kShowerWallM = 0.1F, kShowerHeightM = 2.06F;
void addShowerWall(MeshBuilder& builder);

void addBasinTap(MeshBuilder& builder);
void addTubTap(MeshBuilder& builder);
constexpr float kTowelRailZ = 1.42F;
void addTowelRail(MeshBuilder& builder);
constexpr glm::vec3 kShavingMirror(0.3F, kCounterM, kVanityZ + 0.44F);  // its foot
void addShavingMirror(MeshBuilder& builder);
constexpr glm::vec3 kDispenser(0.33F, kCounterM, kVanityZ - 0.36F);  // its foot
void addDispenser(MeshBuilder& builder);
constexpr glm::vec3 kPendant(1.75F, 1.9F, 2.15F);  // the rim's centre
void addPendant(MeshBuilder& builder);

// --- diffuse (bathroom_fittings.cpp, bathroom_textiles.cpp) ---

/// A window in the wall z = 0.
constexpr glm::vec2 kWindowMin(0.55F, 1.2F), kWindowMax(1.75F, 2.2F);
constexpr float kWainscotM = 0.9F;  // height of the polished panel behind the tub
constexpr float kTilesM = 1.26F;    // height of the tiles on the other walls
void addTiledWalls(MeshBuilder& builder);
void addPaintedWalls(MeshBuilder& builder);
void addFloor(MeshBuilder& builder);
void addDoor(MeshBuilder& builder);
void addWindow(MeshBuilder& builder, MeshBuilder& view);
/// Counter, wall shelves with their brackets, mirror frame, stool.
void addWoodwork(MeshBuilder& builder);
/// Shower head and arm, flush button, paper holder, brackets: matt black.
void addIronware(MeshBuilder& builder);
void addBottles(MeshBuilder& builder, Random& random);
void addWallLamps(MeshBuilder& globes);
void addBulb(MeshBuilder& builder);
constexpr glm::vec3 kBasket(3.08F, 0.0F, 2.78F);
void addBasket(MeshBuilder& builder);

constexpr glm::vec3 kStool(2.42F, 0.0F, 1.5F);
constexpr float kStoolM = 0.46F;
constexpr float kShelvesM[] = {1.22F, 1.58F};  // tops, on the wall x = kRoom.x
void addTowels(MeshBuilder& builder);          // over the rail, on the stool, in the basket
void addRolledTowels(MeshBuilder& builder);    // on the shelves
void addBathMat(MeshBuilder& builder, Random& random);

// --- light between things (bathroom_occlusion.cpp) ---

/// What takes light from others: an upright box or an elliptic cylinder.
struct Occluder {
    glm::vec3 min, max;
    bool isRound = false;
};
/// Vertex colours darkened by what is near: the shading has no shadows, and things would float.
void darken(Mesh& mesh, std::span<const Occluder> occluders);

}  // namespace gfxrepro::scene::bathroom_parts
