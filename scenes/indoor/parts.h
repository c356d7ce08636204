// What the rooms are furnished with: turned, upholstered, bent and panelled parts, and textures.
// Same arguments, same bytes: only +, −, ×, / and square roots.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "engine/core/random.h"
#include "engine/image/image.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene::indoor {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// Columns of a frame that is turned about y by an angle and put at a place.
glm::mat4 placed(const glm::vec3& position, float turnRad = 0.0F);
/// The same, leaning: y of the part runs along `up` (any length).
glm::mat4 placedAlong(const glm::vec3& position, const glm::vec3& up);

/// A part given in its own frame (rigid).
void addFramed(MeshBuilder& builder, const glm::mat4& frame, std::vector<glm::vec3> positions,
               std::vector<glm::vec3> normals, std::span<const glm::uvec3> triangles,
               std::span<const glm::vec2> texcoords);

// --- surfaces (surfaces.cpp; furnishings.cpp: what is flat) ---

/// A surface of revolution is described by its outline: (radius, height), from the bottom outwards
/// and up, and down again on the inside. A point that stands there twice is a sharp edge.
using Outline = std::vector<glm::vec2>;

/// The outline with `pieces` pieces of about equal lengths, Catmull-Rom between sharp edges.
Outline smoothed(std::span<const glm::vec2> outline, int pieces);
/// Turned about y, `sides` around; outside where the outline has its right hand when going up.
/// Texture coordinates: `repeats` times around, along the outline by the same scale.
void addLathe(MeshBuilder& builder, std::span<const glm::vec2> outline, int sides,
              const glm::mat4& frame = glm::mat4(1.0F), float repeats = 1.0F);
/// smoothed() and addLathe() with nearly square cells, at most `triangles`, not far below.
void addTurned(MeshBuilder& builder, std::span<const glm::vec2> outline, int triangles,
               const glm::mat4& frame = glm::mat4(1.0F), float repeats = 1.0F);

/// A tube of `sides` with its stations on a Catmull-Rom spline through the given ones, capped.
void addBentTube(MeshBuilder& builder, std::span<const MeshBuilder::Station> stations, int pieces,
                 int sides);

/// An open sheet of u × v cells; `at` maps (0…1)² to space, its outside is du × dv. Normals are
/// smooth. Texture coordinates are (u, v) · texcoordScale.
void addSheet(MeshBuilder& builder, const std::function<glm::vec3(float u, float v)>& at,
              int cellsU, int cellsV, const glm::vec2& texcoordScale = glm::vec2(1.0F));

/// A box with rounded edges: `edgeCells` cells across every rounding, `faceCells` across what is
/// flat: 12 · (2 · edgeCells + faceCells)² triangles. Texture coordinates in metres / `tileM`.
struct RoundedBox {
    glm::vec3 halfSize{0.5F};
    float radius = 0.05F;
    int edgeCells = 2;
    int faceCells = 1;
    float tileM = 1.0F;
    /// How far the middle of every face is blown out along y and across (upholstery).
    glm::vec3 bulge{0.0F};
};
void addRoundedBox(MeshBuilder& builder, const RoundedBox& box, const glm::mat4& frame);
/// A box of 12 triangles with texture coordinates in metres / `tileM`; the grain (v) runs along
/// the longest side.
void addPanel(MeshBuilder& builder, const glm::vec3& min, const glm::vec3& max, float tileM = 1.0F,
              const glm::mat4& frame = glm::mat4(1.0F));
/// A flat rectangle; `across` × `up` is its outside. Texture coordinates run 0…repeats, v
/// downwards (against `up`).
void addRectangle(MeshBuilder& builder, const glm::vec3& centre, const glm::vec3& halfAcross,
                  const glm::vec3& halfUp, const glm::vec2& repeats = glm::vec2(1.0F));
/// A flat top with corners rounded by `radius`: one polygon in y = height, facing up, with
/// 4 · cornerCells + 2 triangles.
void addRoundedTop(MeshBuilder& builder, const glm::vec2& halfSize, float radius, int cornerCells,
                   float height, const glm::mat4& frame = glm::mat4(1.0F));
/// A throw pillow that stands on its edge, thickest in the middle: 4 · cells² triangles.
void addPillow(MeshBuilder& builder, const glm::vec3& halfSize, int cells, const glm::mat4& frame);

/// Triangles of a finished mesh brought to exactly `triangles` (an even number for closed ones) by
/// halving its longest edges.
Mesh exactly(Mesh mesh, int triangles);

// --- lofts (lofts.cpp): what the bathroom is modelled with ---

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

/// (x, z) on an oval with these half axes, counter-clockwise seen from above; squareness 0 is an
/// ellipse, 1 nearly a rectangle.
glm::vec2 ovalAt(float u, const glm::vec2& halfAxes, float squareness);

// --- furnishings (furnishings.cpp) ---

/// A wooden frame around a picture w × h (half sizes) in the plane z = 0, which faces +z; the
/// picture itself goes to another builder (another material) and may be null.
void addFrame(MeshBuilder& frameBuilder, MeshBuilder* picture, const glm::vec2& halfSize,
              float widthM, float depthM, const glm::mat4& frame);
/// Books from x = 0 to `lengthM`, their backs at z = 0 facing +z; some lean. Colours by vertex.
void addBooks(MeshBuilder& builder, float lengthM, float highestM, int spineCells, Random& random,
              const glm::mat4& frame);
/// A pot plant with arching fronds (areca palm) or broad leaves on stems (rubber plant); the pot is
/// the caller's. `leafCells` along each leaf.
void addPalm(MeshBuilder& builder, float heightM, int fronds, int leafCells, Random& random,
             const glm::mat4& frame);
void addBroadLeaves(MeshBuilder& builder, float heightM, int leaves, int leafCells, Random& random,
                    const glm::mat4& frame);
/// A curtain of `width` from x = 0, hanging from y = 0 down, in folds around z = 0, which
/// grow deeper towards the bottom.
void addCurtain(MeshBuilder& builder, float widthM, float heightM, int folds, int cellsPerFold,
                int cellsDown, Random& random, const glm::mat4& frame);

// --- textures (surfaces.cpp, lofts.cpp): 512², RGB, sRGB, repeating ---

image::Image8 planksTexture(const glm::vec3& darkSrgb, const glm::vec3& lightSrgb, int rows,
                            std::uint64_t seed);  // rows of planks along u
image::Image8 woodTexture(const glm::vec3& darkSrgb, const glm::vec3& lightSrgb,
                          std::uint64_t seed);  // grain along v
image::Image8 weaveTexture(const glm::vec3& warpSrgb, const glm::vec3& weftSrgb, int threads,
                           std::uint64_t seed);
image::Image8 wallpaperTexture(const glm::vec3& groundSrgb, const glm::vec3& motifSrgb,
                               std::uint64_t seed);
image::Image8 marbleTexture(const glm::vec3& groundSrgb, const glm::vec3& veinSrgb,
                            std::uint64_t seed);
image::Image8 tilesTexture(const glm::vec3& tileSrgb, const glm::vec3& groutSrgb, int tiles,
                           std::uint64_t seed);
image::Image8 rugTexture(std::uint64_t seed);                  // a whole rug, not repeating
image::Image8 paintingTexture(int style, std::uint64_t seed);  // 0 landscape, 1 abstract
image::Image8 outdoorsTexture(std::uint64_t seed);             // what a window shows

/// Glazed tiles in a running bond, `columns` × `rows` (even) of them.
struct Tiles {
    glm::vec3 glazeSrgb{0.9F}, groutSrgb{0.7F};
    int columns = 4, rows = 8;
    float toneRange = 0.03F;  // from tile to tile
};
image::Image8 glazedTilesTexture(const Tiles& tiles, std::uint64_t seed);

}  // namespace gfxrepro::scene::indoor
