#version 450 core
// Solid as the thesis has it: along each scan line of a directional sheet the inside flag flips at
// every voxel of the surface, and these are full themselves. [zju2005] Sec. 2.2.3. Within a word the
// flags are a prefix XOR, between words a carry.
// Two crossings in one voxel flip it once, and the line goes on inside out: the thesis's streaks
// (Sec. 2.5.2). Counts the scan lines whose flag does not return to outside.
#include "voxelization/worksheet.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui) uniform restrict uimage2DArray sheet;
layout(std430) restrict buffer Statistics { uint ambiguousScanLines; };

void main() {
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(column, SIZE.xy))) return;
    uint carry = 0u;
    for (int slab = 0; slab < kSlabs; ++slab) {
        ivec3 texel = worksheetPatch(slab) + ivec3(column, 0);
        uint surface = imageLoad(sheet, texel).r;
        uint flags = surface;
        for (int shift = VOXEL_BITS; shift < 32; shift *= 2) flags ^= flags << shift;
        flags ^= carry;
        carry = (flags & 0x80000000u) != 0u ? 0xFFFFFFFFu : 0u;
        flags = (flags & bitsOfSlices(slab)) | surface;
        if (flags != surface) imageStore(sheet, texel, uvec4(flags));
    }
    if (carry != 0u) atomicAdd(ambiguousScanLines, 1u);
}
