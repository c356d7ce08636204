// The list of fragments between rasterization and texelization, one list an axis. A record is one
// word, local (u, v, w) in 10, 10 and 12 bits, and with VALUE other than occupancy a second, the
// voxel's value.
// Departure [zju2005] Sec. 2.2.1: the thesis blends in the fragment's own pixel, so it has to draw
// slab by slab. The list lets a fragment reach any texel, and the mesh is drawn once.
// Defines: RECORD_BINDING, COUNTER_BINDING, RECORD_WORDS.

layout(std430, binding = RECORD_BINDING) restrict buffer Records { uint records[]; };
layout(std430, binding = COUNTER_BINDING) restrict buffer Counters { uint fragmentCounts[3]; };

// Records that the axis's list can hold; what comes beyond is counted, not stored.
uniform uint fragmentCapacity;

void appendFragment(int listAxis, ivec3 local, uint value) {
    uint index = atomicAdd(fragmentCounts[listAxis], 1u);
    if (index >= fragmentCapacity) return;
    records[RECORD_WORDS * index] = uint(local.x) | uint(local.y) << 10 | uint(local.z) << 20;
#if RECORD_WORDS == 2
    records[2u * index + 1u] = value;
#endif
}

uint fragmentTotal(int listAxis) { return min(fragmentCounts[listAxis], fragmentCapacity); }

ivec3 fragmentLocal(uint index) {
    uint word = records[RECORD_WORDS * index];
    return ivec3(word & 1023u, (word >> 10) & 1023u, word >> 20);
}

uint fragmentValue(uint index) {
#if RECORD_WORDS == 2
    return records[2u * index + 1u];
#else
    return LANE_MASK;
#endif
}
