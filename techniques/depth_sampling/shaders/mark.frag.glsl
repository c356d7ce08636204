#version 450 core
// Marks samples of image I that are redundant with one of the images J₀ …, or with none of them:
// measures 1 to 3 of [xie2017] Sec. 2.3.2. Reads I and triangle ids of J₀ …, adds `bit` to the marks,
// which it reads and draws into: each fragment its own texel alone, once, which GL allows.

#include "depth_sampling/redundancy.glsl"

uniform usampler2D marks;

uniform bool isRedundant;  // marked are redundant samples (else the others)
uniform uint among;        // only samples with all of these marks
uniform uint bit;

layout(location = 0) out uint marked;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint triangleId = texelFetch(sampleTriangleIds, pixel, 0).r;
    uint known = texelFetch(marks, pixel, 0).r;
    if (triangleId == 0u || (known & among) != among || (known & bit) != 0u) discard;
    if (isRedundantWithAny(pixel, triangleId) != isRedundant) discard;
    marked = known | bit;
}
