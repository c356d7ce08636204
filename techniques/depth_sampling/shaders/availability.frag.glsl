#version 450 core
// Lets those samples of an output frame pass that a reference image holds: measure 4 of [xie2017]
// Sec. 2.3.2. A query counts what passes. Reads the frame and triangle ids of the reference images.

#include "depth_sampling/redundancy.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint triangleId = texelFetch(sampleTriangleIds, pixel, 0).r;
    if (triangleId == 0u || !isRedundantWithAny(pixel, triangleId)) discard;
}
