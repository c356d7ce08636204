#version 450 core
// Counting sort, third part: where each piece of the matrix begins; bins that hold samples become
// clusters, numbered without gaps in the order of the bins; small ones join a neighbour. One
// workgroup.
#include "clustered_reflections/clustering.glsl"
#include "kit/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Matrix { uint matrix[]; };
layout(std430) restrict coherent buffer Pieces { uint pieces[]; };
// In: the reflector of each bin. Out: its cluster.
layout(std430) restrict buffer Bins { uint bins[]; };
layout(std430) restrict coherent buffer Ranges { uvec4 ranges[]; };
layout(std430) restrict buffer Counts { uint clusterCount, sampleCount, visibleCount; };

uniform uint leastSamples;  // of a cluster; 1: none joins another

shared uint joinedTo[MAX_CLUSTERS];  // the new number of each cluster

// By one invocation: clusters are some hundreds. Returns how many are left.
uint joinSmall(uint count) {
    uint left = 0u;
    for (uint c = 0u; c < count; ++c) {
        uvec4 range = ranges[c];
        uvec4 last = left > 0u ? ranges[left - 1u] : uvec4(0u);  // no reflector is 0
        if (last.z == range.z && min(last.y, range.y) < leastSamples) {
            ranges[left - 1u].y = last.y + range.y;
        } else {
            ranges[left++] = range;
        }
        joinedTo[c] = left - 1u;
    }
    for (uint c = left; c < count; ++c) ranges[c] = uvec4(0u);
    return left;
}

uint samplesBefore(uint bin) {
    if (bin >= binCount) return sampleCount;
    uint entry = bin * blockCount;
    return pieces[entry / uint(PIECE_LENGTH)] + matrix[entry];
}

void main() {
    uint self = gl_LocalInvocationID.x;
    uint total;
    uint before = exclusiveScan(pieces[self], total);  // PIECE_COUNT is GROUP_SIZE
    pieces[self] = before;
    memoryBarrierBuffer();
    barrier();

    uint share = (binCount + uint(GROUP_SIZE) - 1u) / uint(GROUP_SIZE);
    uint first = self * share, end = min(first + share, binCount);
    uint filled = 0u;
    for (uint b = first; b < end; ++b) filled += samplesBefore(b + 1u) > samplesBefore(b) ? 1u : 0u;
    uint all;
    uint cluster = exclusiveScan(filled, all);
    for (uint b = first; b < end; ++b) {
        uint begin = samplesBefore(b), count = samplesBefore(b + 1u) - begin;
        if (count == 0u) continue;
        uint reflector = bins[b];
        ranges[cluster] = uvec4(begin, count, reflector, reflectors[reflector].w & 1u);
        bins[b] = cluster++;
    }
    if (self == 0u) clusterCount = all;
    if (leastSamples <= 1u) return;  // the whole workgroup
    memoryBarrierBuffer();
    barrier();
    if (self == 0u) clusterCount = joinSmall(all);
    barrier();
    for (uint b = first; b < end; ++b) {
        if (samplesBefore(b + 1u) > samplesBefore(b)) bins[b] = joinedTo[bins[b]];
    }
}
