// Writes vertices and triangles of a reconstructed mesh.
#define PLACES_ACCESS readonly
#include "soft_shadows/places.glsl"

// CornerVertex: x and y in half pixels, 16 bits each; depth
layout(std430) restrict writeonly buffer Vertices { uvec2 vertices[]; };
layout(std430) restrict writeonly buffer Indices { uint indices[]; };

uint firstVertexAt(ivec2 corner) {
    return runs[runOf(corner)].x + (imageLoad(places, corner).r & 0xFFFFu);
}

uint firstTriangleAt(ivec2 corner) {
    return runs[runOf(corner)].y + (imageLoad(places, corner).r >> 16);
}

void writeVertex(uint vertex, ivec2 positionHalfPx, float depth) {
    vertices[vertex] =
        uvec2(uint(positionHalfPx.x) | uint(positionHalfPx.y) << 16, floatBitsToUint(depth));
}

void writeTriangle(uint triangle, uint a, uint b, uint c) {
    indices[3u * triangle] = a;
    indices[3u * triangle + 1u] = b;
    indices[3u * triangle + 2u] = c;
}
