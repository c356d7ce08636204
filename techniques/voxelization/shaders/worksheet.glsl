// Addresses of voxels in a worksheet: the GLSL side of worksheet.h, from the defines SIZE (voxels along
// u, v and w), SHEET, VOXEL_BITS, VOXELS_PER_TEXEL (C) and LANE_MASK.
// Departure [zju2005] Sec. 2.3.2: integer instructions instead of lookup textures (256×8 bits of a
// byte, 8×1 powers of two, sheet to sheet): shader model 2 had none; the addresses are the same.
// With TABLES the stages of the worksheet method and drawing look up instead.

#ifdef TABLES
#include "voxelization/lookup_tables.glsl"
#endif

// Local (u, v, w) of an axis (0 x, 1 y, 2 z), w along it: x: (y, z, x), y: (z, x, y), z: (x, y, z).
ivec3 localFromVolume(int axis, ivec3 p) { return axis == 0 ? p.yzx : axis == 1 ? p.zxy : p; }
vec3 localFromVolume(int axis, vec3 p) { return axis == 0 ? p.yzx : axis == 1 ? p.zxy : p; }
ivec3 volumeFromLocal(int axis, ivec3 q) { return axis == 0 ? q.zxy : axis == 1 ? q.yzx : q; }
vec3 volumeFromLocal(int axis, vec3 q) { return axis == 0 ? q.zxy : axis == 1 ? q.yzx : q; }

const int kSlabs = (SIZE.z + VOXELS_PER_TEXEL - 1) / VOXELS_PER_TEXEL;

// Corner texel (x, y, layer) of the patch that holds slab w / C, in sheets of patches of xy texels, z
// of them across and w in each sheet.
ivec3 worksheetPatch(ivec4 sheet, int slab) {
    int patchInSheet = slab % sheet.w;
    return ivec3(ivec2(patchInSheet % sheet.z, patchInSheet / sheet.z) * sheet.xy, slab / sheet.w);
}
ivec3 worksheetPatch(int slab) { return worksheetPatch(SHEET, slab); }

// Texel (x, y, layer) of the voxel at local (u, v, w). In a grid of the z layout local is (x, y, z).
ivec3 worksheetTexel(ivec4 sheet, ivec3 local) {
    return worksheetPatch(sheet, local.z / VOXELS_PER_TEXEL) + ivec3(local.xy, 0);
}
ivec3 worksheetTexel(ivec3 local) { return worksheetTexel(SHEET, local); }

// How many of a slab's slices lie in the grid: all, but for the last where C does not divide its size.
int slicesOf(int slab) {
    if (SIZE.z % VOXELS_PER_TEXEL == 0) return VOXELS_PER_TEXEL;
    return min(VOXELS_PER_TEXEL, SIZE.z - slab * VOXELS_PER_TEXEL);
}
// The bits of their voxels in a texel.
uint bitsOfSlices(int slab) { return 0xFFFFFFFFu >> (32 - slicesOf(slab) * VOXEL_BITS); }

// Position of the voxel's lowest bit in its texel.
int worksheetShift(int w) { return w % VOXELS_PER_TEXEL * VOXEL_BITS; }

// The voxel's value out of its texel's word.
uint voxelOfWord(uint word, int w) {
    int shift = worksheetShift(w);
#ifdef TABLES
    return lookedUpVoxel(word, uint(shift) / 8u, uint(shift) % 8u);
#else
    return (word >> shift) & LANE_MASK;
#endif
}

// The value of voxel (x, y, z) of a grid in the z layout; 0 outside the grid.
uint loadVoxel(usampler2DArray sheets, ivec3 voxel) {
    if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, SIZE))) return 0u;
    return voxelOfWord(texelFetch(sheets, worksheetTexel(voxel), 0).r, voxel.z);
}
