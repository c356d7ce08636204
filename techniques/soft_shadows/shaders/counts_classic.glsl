// What a corner brings to the classic mesh: the triangles of its cell, and the vertex of pixel
// (x, y) where a triangle uses it.
#include "soft_shadows/corners.glsl"

layout(r16ui) uniform restrict readonly uimage2D flags;

uint trianglesOf(uint bits) { return bits & 15u; }

bool isUsed(ivec2 pixel) {
    if (!isPixel(pixel)) return false;
    for (int k = 0; k < 4; ++k) {
        uint triangles = trianglesOf(imageLoad(flags, pixel + kCornerOfPixel[k]).r);
        if ((triangles & ~(1u << k)) != 0u) return true;
    }
    return false;
}

/// Vertices, triangles, samples.
uvec4 countsAt(ivec2 corner) {
    uint bits = imageLoad(flags, corner).r;
    return uvec4(isUsed(corner) ? 1u : 0u, bitCount(trianglesOf(bits)), bits >> 4, 0u);
}
