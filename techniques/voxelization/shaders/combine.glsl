// What synthesis makes of three words, one of each directional sheet, of the same C voxels.
//  COMBINE_OR        surface, one value
//  COMBINE_MAX       surface, values: the largest
//  COMBINE_MAJORITY  solid: what two axes of the three say; voxels on which they differ are counted
layout(r32ui) uniform restrict readonly uimage2DArray sheetX;
layout(r32ui) uniform restrict readonly uimage2DArray sheetY;
layout(r32ui) uniform restrict uimage2DArray sheet;
#ifdef COMBINE_MAJORITY
layout(std430) restrict buffer Statistics {
    uint ambiguousScanLines;
    uint disagreeingVoxels;
};
#endif

uint combined(uint x, uint y, uint z) {
#if defined(COMBINE_OR)
    return x | y | z;
#elif defined(COMBINE_MAX)
    uint result = 0u;
    for (int w = 0; w < VOXELS_PER_TEXEL; ++w) {
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
