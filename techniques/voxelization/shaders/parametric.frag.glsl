#version 450 core
// Puts a sample's voxel into the worksheet. [zju2005] Sec. 2.4.1 (2).
// Reads and writes `sheets` atomically; of several values in one voxel the largest stays, so that the
// result does not depend on the order of the samples.

#include "voxelization/worksheet.glsl"

layout(r32ui) uniform uimage2DArray sheets;

flat in ivec3 voxel;
flat in uint value;

void main() {
    // Image atomics give a helper invocation any value: a loop on one might never end.
    if (gl_HelperInvocation) return;
    ivec3 texel = worksheetTexel(voxel);
#if VOXEL_BITS == 32
    imageAtomicMax(sheets, texel, value);
#elif NORMALS
    int shift = worksheetShift(voxel.z);
    uint expected = 0u;
    while (((expected >> shift) & LANE_MASK) < value) {
        uint wanted = (expected & ~(LANE_MASK << shift)) | (value << shift);
        uint found = imageAtomicCompSwap(sheets, texel, expected, wanted);
        if (found == expected) break;
        expected = found;
    }
#else
    imageAtomicOr(sheets, texel, value << worksheetShift(voxel.z));
#endif
}
