#version 450 core
// Corners of an object's triangles in the world, an invocation a triangle.
#include "reflections/objects.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // vertices, object
layout(std430) readonly buffer Positions { float positions[]; };
layout(std430) writeonly buffer Corners { float corners[]; };  // nine a triangle

uniform uint firstTriangle, triangleCount;

void main() {
    if (gl_GlobalInvocationID.x >= triangleCount) return;
    uint triangle = firstTriangle + gl_GlobalInvocationID.x;
    uvec4 record = triangles[triangle];
    mat4 worldFromMesh = objects[record.w].worldFromMesh;
    for (uint i = 0u; i < 3u; ++i) {
        uint at = 3u * record[i];
        vec4 mesh = vec4(positions[at], positions[at + 1u], positions[at + 2u], 1.0);
        vec3 world = (worldFromMesh * mesh).xyz;
        for (uint k = 0u; k < 3u; ++k) corners[9u * triangle + 3u * i + k] = world[k];
    }
}
