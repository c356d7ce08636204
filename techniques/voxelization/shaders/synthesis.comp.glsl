#version 450 core
// Synthesis: merges the directional sheets of x and y into that of z, which becomes the grid.
// A row of C invocations takes a tile of C × C × C voxels: the sheet of x gives C texels along z for
// each y, that of y C texels along z for each x; transposed, each is C texels of the z layout. One
// fetch and one store a texel.
// Departure [zju2005] Sec. 2.3.2: the thesis fetches a texel for each voxel, as
// synthesis_per_voxel.comp.glsl does; the grids are equal.
//  SPARSE  only the tiles that texelization listed; the others are empty in all sheets
#include "voxelization/worksheet.glsl"
#include "voxelization/combine.glsl"
#include "voxelization/transpose.glsl"
#ifdef SPARSE
#include "voxelization/tiles.glsl"
#endif

layout(local_size_x = VOXELS_PER_TEXEL, local_size_y = TILES) in;

const int C = VOXELS_PER_TEXEL;

shared uint tileOfX[TILES][C][C];  // [tile][x][y]: texels of the z layout

// Texels of the z layout out of the sheet of x, for the group's other invocations.
void shareX(ivec3 slabs, int lane, int tile) {
    uint words[C];
    ivec3 corner = worksheetPatch(slabs.x) + ivec3(slabs.yz * C, 0);  // local (y, z, x)
    for (int i = 0; i < C; ++i) words[i] = imageLoad(sheetX, corner + ivec3(lane, i, 0)).r;
    transpose(words);
    for (int i = 0; i < C; ++i) tileOfX[tile][i][lane] = words[i];
}

void merge(ivec3 slabs, int lane, int tile) {
    uint words[C];
    ivec3 corner = worksheetPatch(slabs.y) + ivec3(slabs.zx * C, 0);  // local (z, x, y)
    for (int i = 0; i < C; ++i) words[i] = imageLoad(sheetY, corner + ivec3(i, lane, 0)).r;
    transpose(words);
    corner = worksheetPatch(slabs.z) + ivec3(slabs.xy * C, 0);
    for (int i = 0; i < C; ++i) {
        ivec3 texel = corner + ivec3(lane, i, 0);
        uint z = imageLoad(sheet, texel).r;
        uint result = combined(tileOfX[tile][lane][i], words[i], z);
        if (result != z) imageStore(sheet, texel, uvec4(result));
    }
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    int tile = int(gl_LocalInvocationID.y);
#ifdef SPARSE
    uint total = tileCount;
    for (uint first = gl_WorkGroupID.x * TILES; first < total; first += gl_NumWorkGroups.x * TILES) {
        uint index = first + uint(tile);
        ivec3 slabs = index < total ? listedTile(index) : ivec3(0);
        if (index < total) shareX(slabs, lane, tile);
        barrier();
        if (index < total) merge(slabs, lane, tile);
        barrier();  // the next tiles take the same shared words
    }
#else
    ivec3 slabs = ivec3(gl_WorkGroupID.xy, int(gl_WorkGroupID.z) * TILES + tile);
    shareX(slabs, lane, tile);
    barrier();
    merge(slabs, lane, tile);
#endif
}
