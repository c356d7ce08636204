#version 450 core
// Synthesis: merges the directional sheets of x and y into that of z, which becomes the grid.
// [zju2005] Sec. 2.2.1, 2.3.2. A row of C invocations takes a tile of C × C × C voxels: the sheet of
// x gives C texels along z for each y, that of y C texels along z for each x; transposed, each is C
// texels of the z layout. One fetch and one store a texel, not a voxel.
//  COMBINE_OR        surface, one value
//  COMBINE_MAX       surface, values: the largest
//  COMBINE_MAJORITY  solid: what two axes of the three say; voxels on which they differ are counted
#include "voxelization/worksheet.glsl"
#include "voxelization/transpose.glsl"

layout(local_size_x = VOXELS_PER_TEXEL, local_size_y = TILES) in;

layout(binding = SHEET_X_UNIT, r32ui) uniform restrict readonly uimage2DArray sheetX;
layout(binding = SHEET_Y_UNIT, r32ui) uniform restrict readonly uimage2DArray sheetY;
layout(binding = SHEET_UNIT, r32ui) uniform restrict uimage2DArray sheet;

#ifdef COMBINE_MAJORITY
layout(std430, binding = STATISTICS_BINDING) restrict buffer Statistics {
    uint ambiguousScanLines;
    uint disagreeingVoxels;
};
#endif

const int C = VOXELS_PER_TEXEL;

shared uint tileOfX[TILES][C][C];  // [tile][x][y]: texels of the z layout

uint combined(uint x, uint y, uint z) {
#if defined(COMBINE_OR)
    return x | y | z;
#elif defined(COMBINE_MAX)
    uint result = 0u;
    for (int w = 0; w < C; ++w) {
        uint largest = max(voxelOfWord(x, w), max(voxelOfWord(y, w), voxelOfWord(z, w)));
        result |= largest << worksheetShift(w);
    }
    return result;
#else
    uint differing = (x ^ y) | (y ^ z);
    if (differing != 0u) atomicAdd(disagreeingVoxels, uint(bitCount(differing)) / VOXEL_BITS);
    return (x & y) | (y & z) | (z & x);
#endif
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    int tile = int(gl_LocalInvocationID.y);
    ivec2 slabXY = ivec2(gl_WorkGroupID.xy);
    int slabZ = int(gl_WorkGroupID.z) * TILES + tile;
    ivec3 origin = ivec3(slabXY, slabZ) * C;
    uint words[C];

    ivec3 patchX = worksheetPatch(slabXY.x);  // local (y, z, x)
    for (int i = 0; i < C; ++i) {
        words[i] = imageLoad(sheetX, patchX + ivec3(origin.y + lane, origin.z + i, 0)).r;
    }
    transpose(words);
    for (int i = 0; i < C; ++i) tileOfX[tile][i][lane] = words[i];
    barrier();

    ivec3 patchY = worksheetPatch(slabXY.y);  // local (z, x, y)
    for (int i = 0; i < C; ++i) {
        words[i] = imageLoad(sheetY, patchY + ivec3(origin.z + i, origin.x + lane, 0)).r;
    }
    transpose(words);
    ivec3 patchZ = worksheetPatch(slabZ);
    for (int i = 0; i < C; ++i) {
        ivec3 texel = patchZ + ivec3(origin.x + lane, origin.y + i, 0);
        uint z = imageLoad(sheet, texel).r;
        uint result = combined(tileOfX[tile][lane][i], words[i], z);
        if (result != z) imageStore(sheet, texel, uvec4(result));
    }
}
