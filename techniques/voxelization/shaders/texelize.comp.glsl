#version 450 core
// Texelization: each fragment's voxel goes to its place in the directional sheet of its axis. The
// cost depends on the fragments, hence on the resolution, not on the triangles.
// [zju2005] Sec. 2.2.1, 2.2.2. Reads the fragment list, writes the sheet (cleared before).
// With LIST_TILES it lists the tiles that hold fragments for a sparse synthesis; with TABLES a bit's
// place in its byte is looked up.
// With ACCUMULATE_XOR a toggle at w = N, behind the grid, goes to `behind`, one bit a scan line.
#include "voxelization/worksheet.glsl"
#include "voxelization/accumulate.glsl"
#include "voxelization/fragment_list.glsl"
#ifdef LIST_TILES
#include "voxelization/tiles.glsl"
#endif

layout(local_size_x = GROUP_SIZE) in;

uniform int axis;

#ifdef ACCUMULATE_XOR
layout(std430, binding = BEHIND_BINDING) restrict buffer Behind { uint behind[]; };
#endif

void main() {
    uint total = fragmentTotal(axis);
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    for (uint i = gl_GlobalInvocationID.x; i < total; i += stride) {
        ivec3 local = fragmentLocal(i);
#ifdef ACCUMULATE_XOR
        if (local.z == RESOLUTION) {
            uint line = uint(local.y * RESOLUTION + local.x);
            atomicXor(behind[line / 32u], 1u << (line % 32u));
            continue;
        }
#endif
        accumulate(local, fragmentValue(i));
#ifdef LIST_TILES
        listTileOf(volumeFromLocal(axis, local));
#endif
    }
}
