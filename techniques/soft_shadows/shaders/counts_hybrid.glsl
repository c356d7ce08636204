// What a corner brings to the mesh by [xie2017] Algorithm 4: one vertex that all share for which it
// is valid, one of its own for every other sample around it, and the quad of pixel (x, y).
#include "soft_shadows/corners.glsl"

layout(r16ui) uniform restrict readonly uimage2D flags;

uint samplesAround(uint bits) { return bits & 15u; }
uint sharersOf(uint bits) { return bits >> 4 & 15u; }
uint fittedOf(uint bits) { return samplesAround(bits) & ~sharersOf(bits); }
uint sharedVertices(uint bits) { return sharersOf(bits) != 0u ? 1u : 0u; }

#if MERGE_ROWS
/// All corners of the pixel's quad are samples of its own triangle: the quad lies in it.
bool isWithinTriangle(ivec2 pixel) {
    bool isWithin = true;
    for (int k = 0; k < 4; ++k) {
        uint bits = imageLoad(flags, pixel + kCornerOfPixel[k]).r;
        isWithin = isWithin && (bits >> (8 + k) & 1u) != 0u;
    }
    return isWithin;
}
/// The pixel's quad goes on where its left neighbour's ends: two within a triangle that share
/// corners are within the same one.
bool joinsLeft(ivec2 pixel) {
    return pixel.x > 0 && isWithinTriangle(pixel) && isWithinTriangle(pixel - ivec2(1, 0));
}
#else
bool joinsLeft(ivec2 pixel) { return false; }
#endif

/// Vertices, triangles, samples.
uvec4 countsAt(ivec2 corner) {
    uint bits = imageLoad(flags, corner).r;
    uint samples = samplesAround(bits) & 1u;
    uint quads = samples == 1u && !joinsLeft(corner) ? 1u : 0u;
    return uvec4(sharedVertices(bits) + bitCount(fittedOf(bits)), 2u * quads, samples, 0u);
}
