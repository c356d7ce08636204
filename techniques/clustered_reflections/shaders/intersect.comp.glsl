#version 450 core
// Step 3.c of [xie2017] Algorithm 6 for one cluster: an invocation a sample of its list.
#include "clustered_reflections/intersect.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Samples { uint samples[]; };  // x | y << 16
uniform uint cluster, firstSample, sampleCount;

layout(rgba16f) uniform writeonly image2D radiance;  // a: 1 + steps
layout(r32f) uniform writeonly image2D distanceM;
layout(r8ui) uniform writeonly uimage2D tookEnvironment;

void main() {
    if (gl_GlobalInvocationID.x >= sampleCount) return;
    uint sampleAt = samples[firstSample + gl_GlobalInvocationID.x];
    ivec2 pixel = ivec2(sampleAt & 0xFFFFu, sampleAt >> 16);
    Reflection reflection = reflectionAt(pixel, cluster);
    imageStore(radiance, pixel, vec4(reflection.radiance, 1.0 + reflection.steps));
    imageStore(distanceM, pixel, vec4(reflection.distance));
    imageStore(tookEnvironment, pixel, uvec4(reflection.tookEnvironment));
}
