#version 450 core
// The compute splatter's second pass: points near their pixel's least depth are summed, in fixed
// point since there are no atomics of floats. 64-bit atomics would keep depth and point in one pass.
#include "point_splatting/point_projection.glsl"

layout(std430) restrict buffer Pixels { int pixels[]; };

uniform float depthTolerance;  // of the least distance

void add(int at, vec3 value) {
    ivec3 steps = ivec3(round(value * FIXED_ONE));
    for (int i = 0; i < 3; ++i) atomicAdd(pixels[at + i], steps[i]);
}

void takePoint(uint index, vec3 centre, vec3 normal, int pixel) {
    int at = pixel * PIXEL_WORDS;
    if (centre.z > intBitsToFloat(pixels[at]) * (1.0 + depthTolerance)) return;
    atomicAdd(pixels[at + 1], 1);
    add(at + 2, viewOf(normal));
#ifdef COLORS
    add(at + 5, colorAt(index));
#endif
}
