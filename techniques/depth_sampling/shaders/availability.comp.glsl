#version 450 core
// Counts the samples of an output frame, and those that a reference image holds: measure 4 of
// [xie2017] Sec. 2.3.2. One thread a column of ROWS_PER_THREAD pixels, one atomic addition a work
// group and counter; reads the frame and triangle ids of the reference images.

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

#include "depth_sampling/redundancy.glsl"

layout(std430, binding = COUNTER_BINDING) buffer Counter {
    uint samples;
    uint available;
};

shared uint groupSamples;
shared uint groupAvailable;

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        groupSamples = 0u;
        groupAvailable = 0u;
    }
    barrier();
    ivec2 sizePx = imageSize(sampleTriangleIds);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, ROWS_PER_THREAD);
    uint foundSamples = 0u;
    uint foundAvailable = 0u;
    if (first.x < sizePx.x) {
        for (int y = first.y; y < min(first.y + ROWS_PER_THREAD, sizePx.y); ++y) {
            uint triangleId = imageLoad(sampleTriangleIds, ivec2(first.x, y)).r;
            if (triangleId == 0u) continue;
            ++foundSamples;
            if (isRedundantWithAny(ivec2(first.x, y), triangleId)) ++foundAvailable;
        }
    }
    if (foundSamples != 0u) atomicAdd(groupSamples, foundSamples);
    if (foundAvailable != 0u) atomicAdd(groupAvailable, foundAvailable);
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupSamples != 0u) {
        atomicAdd(samples, groupSamples);
        atomicAdd(available, groupAvailable);
    }
}
