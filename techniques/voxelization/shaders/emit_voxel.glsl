// Where a fragment shader's voxels go: to the fragment list, or with EMIT_INTO_GRID straight into a
// grid of the z layout (methods direct and slices). The value is full, or with VALUE the interpolated
// normal.
#include "voxelization/worksheet.glsl"
#if VALUE
#include "voxelization/voxel_value.glsl"
#endif

uniform int axis;  // of projection: 0 x, 1 y, 2 z

uint encodedValue(vec3 meaning) {
#if VALUE
    return encodeNormal(meaning);
#else
    return LANE_MASK;
#endif
}

#ifdef EMIT_INTO_GRID
#include "voxelization/accumulate.glsl"
void emitVoxel(ivec3 local, uint value) {
    // Image atomics give a helper invocation any value: a loop on one might never end.
    if (gl_HelperInvocation) return;
    accumulate(volumeFromLocal(axis, local), value);
}
#else
// The list of fragments between rasterization and texelization, one list an axis. A record is one
// word, local (u, v, w) in 10, 10 and 12 bits, and with VALUE other than occupancy a second, the
// voxel's value.
// Departure [zju2005] Sec. 2.2.1: the thesis blends in the fragment's own pixel, so it has to draw
// slab by slab. The list lets a fragment reach any texel, and the mesh is drawn once.
layout(std430) restrict writeonly buffer Records { uint records[]; };
layout(std430) restrict buffer Counters { uint fragmentCounts[3]; };

// Records that the axis's list can hold; what comes beyond is counted, not stored.
uniform uint fragmentCapacity;

void emitVoxel(ivec3 local, uint value) {
    uint index = atomicAdd(fragmentCounts[axis], 1u);
    if (index >= fragmentCapacity) return;
    records[RECORD_WORDS * index] = uint(local.x) | uint(local.y) << 10 | uint(local.z) << 20;
#if RECORD_WORDS == 2
    records[2u * index + 1u] = value;
#endif
}
#endif
