#version 450 core
// Puts a sample's voxel into the worksheet. [zju2005] Sec. 2.4.1 (2).
#include "voxelization/worksheet.glsl"
#include "voxelization/accumulate.glsl"

flat in ivec3 voxel;
flat in uint value;

void main() {
    // Image atomics give a helper invocation any value: a loop on one might never end.
    if (!gl_HelperInvocation) accumulate(voxel, value);
}
