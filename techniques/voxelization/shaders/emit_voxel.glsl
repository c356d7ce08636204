// Where a fragment shader's voxels go: to the fragment list, or with EMIT_INTO_GRID straight into a
// grid of the z layout (methods direct and slices). The value is made from the interpolated normal
// or colour as VALUE says (0 occupancy, 1 normal, 2 colour).
#include "voxelization/worksheet.glsl"
#if VALUE != 0
#include "voxelization/voxel_value.glsl"
#endif

uniform int axis;  // of projection: 0 x, 1 y, 2 z

uint encodedValue(vec3 meaning) {
#if VALUE == 1
    return encodeNormal(meaning);
#elif VALUE == 2
    return encodeColor(meaning);
#else
    return LANE_MASK;
#endif
}

#ifdef EMIT_INTO_GRID
#include "voxelization/accumulate.glsl"
void emitVoxel(ivec3 local, uint value) { accumulate(volumeFromLocal(axis, local), value); }
#else
#include "voxelization/fragment_list.glsl"
void emitVoxel(ivec3 local, uint value) { appendFragment(axis, local, value); }
#endif
