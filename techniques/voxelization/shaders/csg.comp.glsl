#version 450 core
// Boolean operations on two worksheets of one layout, all voxels of a texel at once.
// Departure [zju2005] Sec. 2.4.1 (3): instructions instead of blending modes, which reach only the
// sum of 8-bit channels and would carry between voxels.
// Reads `left` and `right`, writes every texel of `result`, which may be one of them. What lies beyond
// the sheets in the last work groups is read as 0 and not written, as GL has it.

layout(local_size_x = 8, local_size_y = 8) in;

#include "voxelization/worksheet.glsl"

layout(r32ui) readonly uniform uimage2DArray left;
layout(r32ui) readonly uniform uimage2DArray right;
layout(r32ui) writeonly uniform uimage2DArray result;

// All bits of the voxels of `word` whose value is not 0.
uint occupied(uint word) {
#if VOXEL_BITS == 1
    return word;
#else
    uint mask = 0u;
    for (int shift = 0; shift < 32; shift += VOXEL_BITS) {
        if (((word >> shift) & LANE_MASK) != 0u) mask |= LANE_MASK << shift;
    }
    return mask;
#endif
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    uint a = imageLoad(left, texel).r;
    uint b = imageLoad(right, texel).r;
    uint word;
    switch (OPERATION) {
        case UNION:  // where both are, the left one's value stays
            word = a | (b & ~occupied(a));
            break;
        case INTERSECTION:
            word = a & occupied(b);
            break;
        default:  // DIFFERENCE
            word = a & ~occupied(b);
    }
    imageStore(result, texel, uvec4(word));
}
