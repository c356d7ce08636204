// How triangles hang together: shared edges, boundaries, components, enclosed volume.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runner/scene/scene.h"

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

/// Counts over the mesh welded by position.
struct Topology {
    std::size_t vertices = 0;
    std::size_t edges = 0;
    std::size_t triangles = 0;            // without the degenerate ones
    std::size_t degenerateTriangles = 0;  // two corners at one position
    std::size_t boundaryEdges = 0;        // one triangle
    std::size_t nonManifoldEdges = 0;     // three triangles or more
    std::size_t misorientedEdges = 0;     // two triangles that run along it the same way
    std::size_t nonManifoldVertices = 0;  // triangles around it form more than one fan
    std::size_t components = 0;           // joined by edges

    bool isClosed() const { return boundaryEdges == 0; }
    bool isManifold() const { return nonManifoldEdges == 0 && nonManifoldVertices == 0; }
    bool isOriented() const { return misorientedEdges == 0; }
};
Topology topologyOf(const Mesh& mesh);

/// Enclosed volume by the divergence theorem; positive when triangles face outwards. Meaningful for
/// closed meshes only.
double signedVolume(const Mesh& mesh);

}  // namespace gfxrepro::scene
