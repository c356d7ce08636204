#version 450 core
// Corners of an object's triangles in the world, and the boxes of its chunks: a workgroup a chunk,
// an invocation a triangle.
#include "reflections/objects.glsl"
#include "clustered_reflections/detail_levels.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // vertices, object
layout(std430) readonly buffer Positions { float positions[]; };
layout(std430) writeonly buffer Corners { float corners[]; };  // nine a triangle
layout(std430) writeonly buffer ChunkBoxes { vec4 chunkBoxes[]; };  // centre, half size

uniform uint firstChunk;

shared vec3 lowers[GROUP_SIZE];
shared vec3 uppers[GROUP_SIZE];

void main() {
    uint chunk = firstChunk + gl_WorkGroupID.x, self = gl_LocalInvocationID.x;
    uint count = chunks[chunk].triangleCount;
    if (self < count) {
        uint triangle = chunks[chunk].firstTriangle + self;
        mat4 worldFromMesh = objects[chunks[chunk].object].worldFromMesh;
        vec3 lower = vec3(0.0), upper = vec3(0.0);
        for (uint i = 0u; i < 3u; ++i) {
            uint at = 3u * triangles[triangle][i];
            vec3 mesh = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
            vec3 world = (worldFromMesh * vec4(mesh, 1.0)).xyz;
            for (uint k = 0u; k < 3u; ++k) corners[9u * triangle + 3u * i + k] = world[k];
            lower = i == 0u ? world : min(lower, world);
            upper = i == 0u ? world : max(upper, world);
        }
        lowers[self] = lower;
        uppers[self] = upper;
    }
    barrier();
    if (self != 0u) return;
    vec3 lower = lowers[0], upper = uppers[0];
    for (uint i = 1u; i < count; ++i) {
        lower = min(lower, lowers[i]);
        upper = max(upper, uppers[i]);
    }
    chunkBoxes[2u * chunk] = vec4(0.5 * (lower + upper), 1.0);
    chunkBoxes[2u * chunk + 1u] = vec4(0.5 * (upper - lower), 0.0);
}
