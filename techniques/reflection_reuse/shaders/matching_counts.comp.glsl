#version 450 core
// What Algorithm 9 did ([xie2017] Sec. 5.4.1), summed over the key frame's reflective samples. An
// invocation takes a row of ROW_LENGTH samples.
#include "reflections/gbuffer.glsl"

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

uniform sampler2D offsets;
uniform usampler2D stepCounts;
layout(std430) restrict buffer Counts {
    uint reflectiveSamples;
    uint invalidSamples;
    uint steps;
};

void main() {
    ivec2 size = textureSize(gbufferSurface, 0);
    ivec2 begin = ivec2(gl_GlobalInvocationID.x * ROW_LENGTH, gl_GlobalInvocationID.y);
    if (any(greaterThanEqual(begin, size))) return;
    uvec3 sum = uvec3(0u);
    for (int x = begin.x; x < min(begin.x + ROW_LENGTH, size.x); ++x) {
        ivec2 pixel = ivec2(x, begin.y);
        if (reflectorOf(texelFetch(gbufferSurface, pixel, 0).r) == 0u) continue;
        bool isInvalid = texelFetch(offsets, pixel, 0).r >= INVALID_OFFSET;
        sum += uvec3(1u, uint(isInvalid), texelFetch(stepCounts, pixel, 0).r);
    }
    if (sum.x == 0u) return;
    atomicAdd(reflectiveSamples, sum.x);
    atomicAdd(invalidSamples, sum.y);
    atomicAdd(steps, sum.z);
}
