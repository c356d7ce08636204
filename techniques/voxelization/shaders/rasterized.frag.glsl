#version 450 core
// Rasterization by the hardware: the voxel at the pixel and the fragment's depth.
// [zju2005] Sec. 2.2.1.
#include "voxelization/emit_voxel.glsl"

#if VALUE != 0
in vec3 vertexMeaning;
#else
const vec3 vertexMeaning = vec3(0.0);
#endif
#ifdef SLICED
uniform int slice;
#endif

void main() {
    int size = localFromVolume(axis, SIZE).z;
    int w = min(int(gl_FragCoord.z * float(size)), size - 1);
    // The depth of a clipped sliver may be no number, or lie before the grid.
    if (w < 0) return;
#ifdef SLICED
    if (w != slice) return;
#endif
    emitVoxel(ivec3(ivec2(gl_FragCoord.xy), w), encodedValue(vertexMeaning));
}
