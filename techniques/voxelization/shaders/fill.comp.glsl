#version 450 core
// Solid: along each scan line of a directional sheet the inside flag flips at every crossing.
// [zju2005] Sec. 2.2.3. Within a word the flags are a prefix XOR, between words a carry.
// Reads and writes a sheet of toggles; counts the scan lines whose flag does not return to outside
// (crossings behind the grid, in `behind`, count).
//  FLIP_AT_VOXELS  the sheet holds voxels of the surface, not crossings: the flag flips at each, as
//                  the thesis has it, and they are full themselves. Two crossings in one voxel flip
//                  it once, and the line goes on inside out: the thesis's streaks (Sec. 2.5.2).
#include "voxelization/worksheet.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui) uniform restrict uimage2DArray sheet;
layout(std430) restrict readonly buffer Behind { uint behind[]; };
layout(std430) restrict buffer Statistics {
    uint ambiguousScanLines;
    uint disagreeingVoxels;
};

void main() {
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    uint carry = 0u;
    for (int slab = 0; slab < RESOLUTION / VOXELS_PER_TEXEL; ++slab) {
        ivec3 texel = worksheetPatch(slab) + ivec3(column, 0);
        uint toggles = imageLoad(sheet, texel).r;
        uint flags = toggles;
        for (int shift = VOXEL_BITS; shift < 32; shift *= 2) flags ^= flags << shift;
        flags ^= carry;
        carry = (flags & 0x80000000u) != 0u ? 0xFFFFFFFFu : 0u;
#ifdef FLIP_AT_VOXELS
        flags |= toggles;
#endif
        if (flags != toggles) imageStore(sheet, texel, uvec4(flags));
    }
    uint line = uint(column.y * RESOLUTION + column.x);
    bool isBehind = ((behind[line / 32u] >> (line % 32u)) & 1u) != 0u;
    if ((carry != 0u) != isBehind) atomicAdd(ambiguousScanLines, 1u);
}
