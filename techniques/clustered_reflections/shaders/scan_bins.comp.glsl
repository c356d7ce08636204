#version 450 core
// Counting sort, second part: prefix sums of the matrix within pieces of PIECE_LENGTH entries, a
// workgroup each, and the pieces' totals.
#include "kit/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict buffer Matrix { uint matrix[]; };
layout(std430) restrict writeonly buffer Pieces { uint pieces[]; };

const uint kShare = uint(PIECE_LENGTH / GROUP_SIZE);

void main() {
    uint first = gl_WorkGroupID.x * uint(PIECE_LENGTH) + gl_LocalInvocationID.x * kShare;
    uint sum = 0u;
    for (uint i = 0u; i < kShare; ++i) sum += matrix[first + i];
    uint total;
    uint before = exclusiveScan(sum, total);
    for (uint i = 0u; i < kShare; ++i) {
        uint count = matrix[first + i];
        matrix[first + i] = before;
        before += count;
    }
    if (gl_LocalInvocationID.x == 0u) pieces[gl_WorkGroupID.x] = total;
}
