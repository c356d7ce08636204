// What a mesh is as a surface: boundaries, fans, components, enclosed volume.
#pragma once

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

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
