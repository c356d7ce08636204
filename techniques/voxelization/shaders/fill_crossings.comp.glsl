#version 450 core
// Solid by exact crossings: along each scan line of an axis the inside flag flips at every crossing.
// [zju2005] Sec. 2.2.3. The crossings of each axis lie in a sheet of the grid's layout. Along x and y
// a texel is a voxel of as many scan lines; along z its voxels follow each other: their flags are a
// prefix XOR within it, and a carry between. The pass along z (AXIS 2) comes last and makes the grid:
// what two axes of the three say.
// Counts the scan lines whose flag does not return to outside (crossings behind the grid count), and
// the voxels on which axes differ.
#include "voxelization/worksheet.glsl"
#include "voxelization/crossings.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(r32ui) uniform restrict uimage2DArray sheet;  // of the axis
layout(std430) restrict readonly buffer Behind { uint behind[]; };
layout(std430) restrict buffer Statistics {
    uint ambiguousScanLines;
    uint disagreeingVoxels;
};

#if AXIS == 2

layout(r32ui) uniform restrict readonly uimage2DArray sheetX;
layout(r32ui) uniform restrict readonly uimage2DArray sheetY;

void main() {
    ivec3 line = ivec3(gl_GlobalInvocationID.xy, 0);
    if (line.x >= SIZE.x) return;
    uint inside = 0u;  // all bits alike
    for (int slab = 0; slab < kSlabs; ++slab) {
        ivec3 texel = worksheetPatch(slab) + line;
        uint z = imageLoad(sheet, texel).r;
        for (int shift = VOXEL_BITS; shift < 32; shift *= 2) z ^= z << shift;
        z ^= inside;
        inside = (z & 0x80000000u) != 0u ? 0xFFFFFFFFu : 0u;
        z &= bitsOfSlices(slab);
        uint x = imageLoad(sheetX, texel).r;
        uint y = imageLoad(sheetY, texel).r;
        uint differing = (x ^ y) | (y ^ z);
        if (differing != 0u) atomicAdd(disagreeingVoxels, uint(bitCount(differing)) / VOXEL_BITS);
        imageStore(sheet, texel, uvec4((x & y) | (y & z) | (z & x)));
    }
    bool isBehind = (behind[behindWord(2, line)] & behindBits(2, line)) != 0u;
    if ((inside != 0u) != isBehind) atomicAdd(ambiguousScanLines, 1u);
}

#else

void main() {
    int line = int(gl_GlobalInvocationID.x);
    int slab = int(gl_GlobalInvocationID.y);
    if (line >= (AXIS == 0 ? SIZE.y : SIZE.x)) return;
    ivec3 along = AXIS == 0 ? ivec3(1, 0, 0) : ivec3(0, 1, 0);
    ivec3 texel = worksheetPatch(slab) + (AXIS == 0 ? ivec3(0, line, 0) : ivec3(line, 0, 0));
    uint inside = 0u;
    for (int i = 0; i < (AXIS == 0 ? SIZE.x : SIZE.y); ++i, texel += along) {
        uint toggles = imageLoad(sheet, texel).r;
        inside ^= toggles;
        if (inside != toggles) imageStore(sheet, texel, uvec4(inside));
    }
    uint open = inside ^ behind[behindWord(AXIS, ivec3(line, line, slab * VOXELS_PER_TEXEL))];
    if (open != 0u) atomicAdd(ambiguousScanLines, uint(bitCount(open)) / VOXEL_BITS);
}

#endif
