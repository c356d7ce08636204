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

void main() {
    Chunk chunk = chunks[firstChunk + gl_WorkGroupID.x];
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += uint(GROUP_SIZE)) {
        uint index = chunk.first + i;
        SplatPoint point = pointAt(index, chunk.boxMin.xyz, chunk.boxSize.xyz);
        vec3 centre = (eyeFromModel * vec4(point.position, 1.0)).xyz;
        vec3 normal = mat3(eyeFromModel) * point.normal;
        int pixel = pixelOf(centre, normal);
        if (pixel == kOutside) continue;
        int at = pixel * PIXEL_WORDS;
        if (centre.z > intBitsToFloat(pixels[at]) * (1.0 + depthTolerance)) continue;
        atomicAdd(pixels[at + 1], 1);
        add(at + 2, viewOf(normal));
#ifdef COLORS
        add(at + 5, colorAt(index));
#endif
    }
}
