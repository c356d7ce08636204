#version 450 core
// Rasterization by the hardware: projects a triangle along its axis onto a pixel a voxel; window z
// times the voxels along it is the depth in voxels. With SLICED, triangles wholly outside the slice are culled.
// [zju2005] Sec. 2.2.1.
#include "voxelization/worksheet.glsl"

layout(location = kPosition) in vec3 positionWorld;
#if VALUE != 0
layout(location = kNormal) in vec3 meaning;  // normal or colour
out vec3 vertexMeaning;
#endif
#ifdef SLICED
uniform int slice;
out float gl_CullDistance[2];
#endif

uniform int axis;
uniform vec3 boxCentreWorld;
uniform vec3 clipFromWorldScale;  // 2 / edges of the box

void main() {
    vec3 local = localFromVolume(axis, (positionWorld - boxCentreWorld) * clipFromWorldScale);
    gl_Position = vec4(local, 1.0);
#if VALUE != 0
    vertexMeaning = meaning;
#endif
#ifdef SLICED
    // Half a voxel of margin: the fragment shader decides by its own depth to which slice it goes.
    float depth = (local.z * 0.5 + 0.5) * float(localFromVolume(axis, SIZE).z);
    gl_CullDistance[0] = depth - (float(slice) - 0.5);
    gl_CullDistance[1] = float(slice) + 1.5 - depth;
#endif
}
