#version 450 core
// Finds the first voxel of a pixel's ray: planes come front to back, so that the depth test drops
// all behind a hit. [zju2005] Sec. 2.3.3. Reads the worksheet; writes the voxel and the face through
// which it was entered: x | y << 10 | z << 20 | (axis + 1) << 30.

#include "voxelization/volume_walk.glsl"

layout(location = 0) out uint hit;

void main() {
    vec3 direction = rayDirection();
    vec2 slope = direction.xy / direction.z;
    float front = float(slice + (direction.z > 0.0 ? 0 : 1));
    float back = float(slice + (direction.z > 0.0 ? 1 : 0));
    Walk walk = beginWalk(atPlane(slope, front), atPlane(slope, back));
    bool isEmpty = drawnVoxel(volumeFromLocal(AXIS, ivec3(walk.cell, slice))) == 0u;
    while (isEmpty && !isLast(walk)) {
        advance(walk);
        isEmpty = drawnVoxel(volumeFromLocal(AXIS, ivec3(walk.cell, slice))) == 0u;
    }
    if (isEmpty) discard;
    uvec3 voxel = uvec3(volumeFromLocal(AXIS, ivec3(walk.cell, slice)));
    uint axis = uint(walk.face + AXIS + 1) % 3u;  // local to volume, see localFromVolume
    hit = voxel.x | voxel.y << 10 | voxel.z << 20 | (axis + 1u) << 30;
}
