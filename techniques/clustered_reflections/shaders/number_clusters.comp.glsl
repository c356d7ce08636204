#version 450 core
// Counting sort, third part: where each piece of the matrix begins; bins that hold samples become
// clusters, numbered without gaps in the order of the bins. One workgroup.
#include "clustered_reflections/clustering.glsl"
#include "clustered_reflections/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430, binding = MATRIX_BINDING) restrict readonly buffer Matrix { uint matrix[]; };
layout(std430, binding = PIECES_BINDING) restrict coherent buffer Pieces { uint pieces[]; };
// In: the reflector of each bin. Out: its cluster.
layout(std430, binding = BINS_BINDING) restrict buffer Bins { uint bins[]; };
layout(std430, binding = RANGES_BINDING) restrict writeonly buffer Ranges { uvec4 ranges[]; };
layout(std430, binding = COUNTS_BINDING) restrict buffer Counts {
    uint clusterCount, sampleCount, visibleCount;
};

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
}
