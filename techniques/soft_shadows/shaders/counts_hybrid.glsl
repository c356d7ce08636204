// What a corner brings to the mesh by [xie2017] Algorithm 4: one vertex that all share for which it
// is valid, one of its own for every other sample around it, and the quad of pixel (x, y).
#include "soft_shadows/corners.glsl"

layout(binding = FLAGS_UNIT, r8ui) uniform restrict readonly uimage2D flags;

uint samplesAround(uint bits) { return bits & 15u; }
uint sharersOf(uint bits) { return bits >> 4; }
uint fittedOf(uint bits) { return samplesAround(bits) & ~sharersOf(bits); }
uint sharedVertices(uint bits) { return sharersOf(bits) != 0u ? 1u : 0u; }

/// Vertices, triangles, samples, plane-fitted corners.
uvec4 countsAt(ivec2 corner) {
    uint bits = imageLoad(flags, corner).r;
    uint fitted = bitCount(fittedOf(bits));
    uint samples = samplesAround(bits) & 1u;
    return uvec4(sharedVertices(bits) + fitted, 2u * samples, samples, fitted);
}
