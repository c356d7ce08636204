#version 450 core
// Cuts the clusters' samples into chunks, and writes how many workgroups the passes over chunks and
// over clusters have. One workgroup; an invocation takes clusters that follow each other.
#include "clustered_reflections/cluster_chunks.glsl"
#include "kit/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Counts { uint counts[]; };
layout(std430) restrict writeonly buffer Arguments { uint arguments[]; };  // of two dispatches

uint chunksOf(uint cluster) {
    return (ranges[cluster].y + uint(CHUNK_LENGTH) - 1u) / uint(CHUNK_LENGTH);
}

void main() {
    uint clusters = counts[0];
    uint share = (clusters + uint(GROUP_SIZE) - 1u) / uint(GROUP_SIZE);
    uint first = gl_LocalInvocationID.x * share, end = min(first + share, clusters);
    uint sum = 0u;
    for (uint c = first; c < end; ++c) sum += chunksOf(c);
    uint total;
    uint before = exclusiveScan(sum, total);
    for (uint c = first; c < end; ++c) {
        firstChunk[c] = before;
        before += chunksOf(c);
    }
    if (gl_LocalInvocationID.x == 0u) {
        clusterCount = clusters;
        firstChunk[clusters] = total;
        uint groups = (total + uint(CHUNK_GROUP_SIZE) - 1u) / uint(CHUNK_GROUP_SIZE);
        uint groupsOfPasses[] = uint[](groups, 1u, 1u, clusters, 1u, 1u);
        for (int i = 0; i < 6; ++i) arguments[i] = groupsOfPasses[i];
    }
}
