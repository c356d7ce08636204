#version 450 core
// Texelization: each fragment's voxel goes to its place in the directional sheet of its axis. The
// cost depends on the fragments, hence on the resolution, not on the triangles.
// [zju2005] Sec. 2.2.1, 2.2.2. Reads the fragment list, writes the sheet (cleared before).
// A program an axis: AXIS, and the defines of its sheets. With TABLES a bit's place in its byte is looked up.
#include "voxelization/worksheet.glsl"
#include "voxelization/accumulate.glsl"

layout(local_size_x = GROUP_SIZE) in;

// What emit_voxel.glsl wrote.
layout(std430) restrict readonly buffer Records { uint records[]; };
layout(std430) restrict readonly buffer Counters { uint fragmentCounts[3]; };
uniform uint fragmentCapacity;

void main() {
    uint total = min(fragmentCounts[AXIS], fragmentCapacity);
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    for (uint i = gl_GlobalInvocationID.x; i < total; i += stride) {
        uint word = records[RECORD_WORDS * i];
        ivec3 local = ivec3(word & 1023u, (word >> 10) & 1023u, word >> 20);
#if RECORD_WORDS == 2
        accumulate(local, records[2u * i + 1u]);
#else
        accumulate(local, LANE_MASK);
#endif
    }
}
