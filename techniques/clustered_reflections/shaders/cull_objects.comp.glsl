#version 450 core
// Which clusters see an object: a workgroup an object, whose draw commands get an instance for each.
// The order of instances may change from run to run, the images do not: an object's instances lie in
// different images, and commands keep the order of objects.
#include "reflections/objects.glsl"
#include "clustered_reflections/atlas.glsl"
#include "clustered_reflections/culling.glsl"

layout(local_size_x = 64) in;

struct DrawCommand {
    uint count, instanceCount, firstIndex, baseVertex, baseInstance;
};
layout(std430) buffer Commands { DrawCommand commands[]; };
layout(std430) readonly buffer Pieces {
    uvec2 pieces[];  // of an object: first command, number of commands
};
layout(std430) writeonly buffer Instances { uint instances[]; };  // cluster << 20 | object

shared uint seenCount, firstInstance;

bool isSeen(uint object, uint cluster) {
    if (places[cluster].z == 0) return false;
    uint reflector = objects[object].surface & 0xFFFFu;
    bool isOwn = reflector == cameras[cluster].reflector;
    if (areBackToBack(reflector, cameras[cluster].reflector)) return false;
    if (isOwn && (cameras[cluster].flags & kShowsOwn) == 0u) return false;
    return isInFrustum(transpose(cameras[cluster].clipFromWorld), objects[object].boundsCentre.xyz,
                       objects[object].boundsHalfSize.xyz);
}

void main() {
    uint object = gl_WorkGroupID.x;
    uint thread = gl_LocalInvocationID.x;
    uint count = min(clusterCount, uint(kMaxClusters));
    if (thread == 0u) seenCount = 0u;
    barrier();
    uint own = 0u;
    for (uint i = thread; i < count; i += gl_WorkGroupSize.x) own += isSeen(object, i) ? 1u : 0u;
    uint place = atomicAdd(seenCount, own);
    barrier();
    if (thread == 0u) {
        firstInstance = atomicAdd(instanceCount, seenCount);
        uint capacity = uint(instances.length());
        if (firstInstance + seenCount > capacity) {  // see kMostInstances
            uint drawn = capacity - min(firstInstance, capacity);
            atomicAdd(instancesLeftOut, seenCount - drawn);
            seenCount = drawn;
        }
        for (uint i = 0u; i < pieces[object].y; ++i) {
            commands[pieces[object].x + i].instanceCount = seenCount;
            commands[pieces[object].x + i].baseInstance = firstInstance;
            atomicAdd(trianglesDrawn, seenCount * (commands[pieces[object].x + i].count / 3u));
        }
    }
    barrier();
    for (uint i = thread; i < count; i += gl_WorkGroupSize.x) {
        if (!isSeen(object, i)) continue;
        if (place < seenCount) instances[firstInstance + place] = i << 20 | object;
        ++place;
    }
}
