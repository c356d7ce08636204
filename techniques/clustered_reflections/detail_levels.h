// The scene's triangles in runs that are culled together, each object at several levels of detail.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "techniques/reflections/surfaces.h"

namespace gfxrepro::clustered_reflections {

/// Triangles of a chunk, the workgroup of the passes over them.
constexpr std::uint32_t kChunkTriangles = 64;

/// As shaders/detail_levels.glsl has them (std430). An object is one part, or several where it has
/// many triangles; a part has levels, finest first, and a level chunks that follow each other.
struct DetailPart {
    glm::vec4 boundsCentre{0.0F};    // in mesh space
    glm::vec4 boundsHalfSize{0.0F};  // in mesh space
    std::uint32_t object = 0, firstLevel = 0, levelCount = 0, padding = 0;
};
struct DetailLevel {
    float errorMesh = 0.0F;  // how far the level is from the finest, in units of the mesh
    std::uint32_t firstChunk = 0, chunkCount = 0, padding = 0;
};
struct DetailChunk {
    std::uint32_t firstTriangle = 0, triangleCount = 0, object = 0, padding = 0;
};
static_assert(sizeof(DetailPart) == 48 && sizeof(DetailLevel) == 16 && sizeof(DetailChunk) == 16);

struct DetailLevels {
    std::vector<DetailPart> parts;
    std::vector<DetailLevel> levels;
    std::vector<DetailChunk> chunks;  // those of an object follow each other
    std::vector<glm::uvec4>
        triangles;  // corners as they are lit, vertices of the ObjectGeometry; w: object
    std::vector<std::uint32_t> firstChunkOfObject;  // and, last, how many chunks there are
};

/// Chunks of all objects, triangles in an order of places. With `isSimplified` parts have coarser
/// levels, each of about half the triangles of the one before (meshopt_simplify), down to some
/// dozens; without, the finest alone.
///
/// What the vertices' colours show counts as if it were shape, 0.2 scene diagonals from black to
/// white, so that a level loses no more of them than of the shape. The corners of a level are
/// vertices of the finest, with all that these have.
DetailLevels detailLevels(const reflections::ReflectiveScene& scene, bool isSimplified);

}  // namespace gfxrepro::clustered_reflections
