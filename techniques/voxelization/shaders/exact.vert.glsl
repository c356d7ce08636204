#version 450 core
// Exact rules: a rectangle of whole pixels around each triangle, six vertices by index, so that the
// hardware only lists candidate pixels and its snapping of vertices decides nothing.
#include "voxelization/worksheet.glsl"
#include "voxelization/exact_triangle.glsl"

uniform int axis;
uniform int firstTriangle;

flat out uint triangleIndex;

void main() {
    triangleIndex = uint(firstTriangle + gl_VertexID / 6);
    ivec2 a = cornerLocal(axis, triangleIndex, 0u).xy;
    ivec2 b = cornerLocal(axis, triangleIndex, 1u).xy;
    ivec2 c = cornerLocal(axis, triangleIndex, 2u).xy;
    ivec2 low = min(a, min(b, c));
    ivec2 high = max(a, max(b, c));
#ifdef RULE_CONSERVATIVE
    ivec2 first = (low - 1) >> 8;  // closed pixels that touch [low, high]
    ivec2 last = high >> 8;
#else
    ivec2 first = (low + 127) >> 8;  // pixels whose centre lies in [low, high]
    ivec2 last = (high - 128) >> 8;
#endif
    first = max(first, ivec2(0));
    last = min(last, ivec2(RESOLUTION - 1));

    int vertex = gl_VertexID % 6;
    ivec2 isFar = ivec2(vertex == 1 || vertex >= 4, vertex == 2 || vertex == 3 || vertex == 5);
    vec2 corner = vec2(first + isFar * (last - first + 1));
    bool isEmpty = any(lessThan(last, first));
    gl_Position = isEmpty ? vec4(2.0, 2.0, 2.0, 1.0)
                          : vec4(corner * (2.0 / float(RESOLUTION)) - 1.0, 0.0, 1.0);
}
