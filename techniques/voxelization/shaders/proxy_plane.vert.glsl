#version 450 core
// One proxy plane an instance: the face of a slice of voxels that is turned to the eye.
// [zju2005] Sec. 2.2.2, 2.3.3. The planes are object-aligned, perpendicular to the volume axis
// nearest to the view direction: a plane then belongs to one slice, whose address is constant.
// Reads no attributes; writes the rectangle that covers the slice on the screen.

#include "voxelization/worksheet.glsl"

uniform mat4 clipFromVoxel;
uniform vec3 eye;  // local to the axis, in voxels; never between the first and the last plane

flat out int slice;

void main() {
    bool ascends = (eye.z < 0.0) == bool(FRONT_TO_BACK);
    ivec3 size = localFromVolume(AXIS, SIZE);
    slice = ascends ? gl_InstanceID : size.z - 1 - gl_InstanceID;
    float front = eye.z < 0.0 ? float(slice) : float(slice + 1);
    float back = eye.z < 0.0 ? float(slice + 1) : float(slice);

    // Rays that enter the slice through its sides pass the front plane beside the volume, at most
    // where the far face is seen through it.
    float shrink = (front - eye.z) / (back - eye.z);
    vec2 low = min(vec2(0.0), eye.xy + (0.0 - eye.xy) * shrink);
    vec2 high = max(vec2(size.xy), eye.xy + (vec2(size.xy) - eye.xy) * shrink);
    vec2 corner = mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    gl_Position = clipFromVoxel * vec4(volumeFromLocal(AXIS, vec3(corner, front)), 1.0);
}
