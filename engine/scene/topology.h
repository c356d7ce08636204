// How triangles hang together: which corners share a vertex, and which an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// Vertices at equal positions share one id: seams of attributes close, cracks do not.
struct Welding {
    std::vector<std::uint32_t> idOfVertex;  // ids count from 0 in order of first appearance
    std::uint32_t count = 0;
};
Welding weldedByPosition(std::span<const glm::vec3> positions);

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// Every edge once, with the corners that lie along it. Corner 3t+i is the side of triangle t from
/// its vertex i to vertex (i+1) mod 3. Triangles with two corners at one position enclose nothing
/// and take no part.
struct EdgeTable {
    std::vector<std::uint32_t> edgeOfCorner;  // kNone for triangles that take no part
    std::vector<std::uint32_t> nextCorner;    // chain of an edge's corners, ends with kNone
    std::vector<std::uint32_t> firstCorner;   // of each edge
};
EdgeTable edgesOf(std::span<const glm::uvec3> triangles, const Welding& welding);

}  // namespace gfxrepro::scene
