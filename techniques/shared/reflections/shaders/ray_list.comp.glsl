#version 450 core
// GpuRayTracer, first pass: a list of the samples that want rays, without gaps, and the arguments
// of the indirect dispatch that traces them.
#include "reflections/gbuffer.glsl"
#include "reflections/lobe.glsl"

layout(local_size_x = LIST_GROUP_WIDTH, local_size_y = LIST_GROUP_HEIGHT) in;

layout(binding = WANTED_UNIT) uniform usampler2D wanted;
layout(std430, binding = SAMPLES_BINDING) restrict writeonly buffer Samples {
    uint samples[];  // x | y << 16
};
layout(std430, binding = ARGUMENTS_BINDING) restrict buffer Arguments {
    uint groups[3];
    uint sampleCount;
    uint rayCount;
};

uniform bool isChosen;  // whether `wanted` counts

shared uint groupSamples, groupRays, groupBegin;

void main() {
    bool isFirst = gl_LocalInvocationIndex == 0u;
    if (isFirst) groupSamples = groupRays = 0u;
    barrier();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint surface = 0u;
    if (all(lessThan(pixel, textureSize(gbufferSurface, 0)))) {
        surface = texelFetch(gbufferSurface, pixel, 0).r;
        if (isChosen && texelFetch(wanted, pixel, 0).r == 0u) surface = 0u;
    }
    bool hasRays = reflectorOf(surface) != 0u;
    uint place = 0u;
    if (hasRays) {
        place = atomicAdd(groupSamples, 1u);
        atomicAdd(groupRays, uint(raysOf(glossinessOf(surface))));
    }
    barrier();
    if (isFirst && groupSamples > 0u) {
        // The order of groups in the list is left to chance; each sample writes only its own pixel.
        groupBegin = atomicAdd(sampleCount, groupSamples);
        atomicAdd(rayCount, groupRays);
        uint end = groupBegin + groupSamples;
        atomicMax(groups[0], min((end + TRACE_GROUP_SIZE - 1u) / TRACE_GROUP_SIZE, MAX_GROUPS));
    }
    barrier();
    if (hasRays) samples[groupBegin + place] = uint(pixel.x) | (uint(pixel.y) << 16);
}
