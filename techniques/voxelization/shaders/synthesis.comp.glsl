#version 450 core
// Synthesis: merges the directional sheets of x and y into that of z, which becomes the grid. Each
// texel of the z layout fetches its C voxels one by one from the sheets of x and y, of which it knows
// where they have the first: the others follow by offset. [zju2005] Sec. 2.3.2 (3).
//  TABLES  the place of the first voxel, and a bit's value, by look-up textures
//  VALUES  the largest value of a voxel stays; else the bits are OR-ed
#include "voxelization/worksheet.glsl"

// SHEET_X and SHEET_Y are of these sheets as SHEET is of the grid's.
layout(local_size_x = GROUP_EDGE, local_size_y = GROUP_EDGE) in;

layout(r32ui) uniform restrict readonly uimage2DArray sheetX;
layout(r32ui) uniform restrict readonly uimage2DArray sheetY;
layout(r32ui) uniform restrict uimage2DArray sheet;

// Whether the grid's texels fill its sheets and the work groups.
const bool kIsFull = kSlabs % SHEET.w == 0 && SIZE.x * SHEET.z % GROUP_EDGE == 0 &&
                     SIZE.y * (SHEET.w / SHEET.z) % GROUP_EDGE == 0;

uint combined(uint x, uint y, uint z) {
#ifdef VALUES
    uint result = 0u;
    for (int w = 0; w < VOXELS_PER_TEXEL; ++w) {
        uint largest = max(voxelOfWord(x, w), max(voxelOfWord(y, w), voxelOfWord(z, w)));
        result |= largest << worksheetShift(w);
    }
    return result;
#else
    return x | y | z;
#endif
}

// Where a sheet has a texel's first voxel: the texel, and in its word the byte and bit of a byte.
struct Place {
    ivec3 texel;
    uvec2 bits;
};

#ifdef TABLES
Place placeOf(uvec4 entry) { return Place(ivec3(entry.xy, 0), entry.zw); }
uint voxelAt(uint word, Place place) { return lookedUpVoxel(word, place.bits.x, place.bits.y); }
#else
Place placeOf(ivec4 sheet, ivec3 local) {
    uint shift = uint(worksheetShift(local.z));
    return Place(worksheetTexel(sheet, local), uvec2(shift / 8u, shift % 8u));
}
uint voxelAt(uint word, Place place) {
    return (word >> (8u * place.bits.x + place.bits.y)) & LANE_MASK;
}
#endif

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    ivec2 patchXY = texel.xy / SIZE.xy;
    int slab = texel.z * SHEET.w + patchXY.y * SHEET.z + patchXY.x;
    if (!kIsFull && (patchXY.x >= SHEET.z || slab >= kSlabs)) return;
#ifdef TABLES
    Place inX = placeOf(texelFetch(xFromZ, texel.xy, 0));
    Place inY = placeOf(texelFetch(yFromZ, texel.xy, 0));
#else
    ivec3 voxel = ivec3(texel.xy % SIZE.xy, slab * VOXELS_PER_TEXEL);
    Place inX = placeOf(SHEET_X, localFromVolume(0, voxel));
    Place inY = placeOf(SHEET_Y, localFromVolume(1, voxel));
#endif
    uint x = 0u;
    uint y = 0u;
    for (int k = 0; k < slicesOf(slab); ++k) {  // along z: rows of x's sheet, columns of y's
        uint wordX = imageLoad(sheetX, inX.texel + ivec3(0, k, 0)).r;
        uint wordY = imageLoad(sheetY, inY.texel + ivec3(k, 0, 0)).r;
        x |= voxelAt(wordX, inX) << worksheetShift(k);
        y |= voxelAt(wordY, inY) << worksheetShift(k);
    }
    uint z = imageLoad(sheet, texel).r;
    uint result = combined(x, y, z);
    if (result != z) imageStore(sheet, texel, uvec4(result));
}
