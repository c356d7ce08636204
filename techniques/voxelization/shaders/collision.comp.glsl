#version 450 core
// Counts the full voxels of a worksheet: the answer to a collision test when the worksheet is an
// intersection. [zju2005] Sec. 2.4.3.
// Reads `sheets`, one invocation a texel; adds to `Count`, which starts as 0.

layout(local_size_x = 8, local_size_y = 8) in;

#include "voxelization/worksheet.glsl"

layout(r32ui) readonly uniform uimage2DArray sheets;
layout(std430) buffer Count {
    uint count;
};

shared uint groupCount;

void main() {
    if (gl_LocalInvocationIndex == 0u) groupCount = 0u;
    barrier();
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    int slab = int(gl_GlobalInvocationID.z);
    bool isInGrid = all(lessThan(column, SIZE.xy));
    uint word = isInGrid ? imageLoad(sheets, worksheetPatch(slab) + ivec3(column, 0)).r : 0u;
    if (word != 0u) {
        uint full = 0u;
        for (int lane = 0; lane < VOXELS_PER_TEXEL; ++lane) {
            if (voxelOfWord(word, lane) != 0u) ++full;
        }
        atomicAdd(groupCount, full);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupCount != 0u) atomicAdd(count, groupCount);
}
