// The scene's triangles as the passes that build a BVH read them, in the objects' present poses.
#include "reflections/objects.glsl"

layout(std430) restrict readonly buffer Positions { float positions[]; };
layout(std430) restrict readonly buffer Indices { uint indices[]; };
layout(std430) restrict readonly buffer ObjectOfTriangle { uint objectOfTriangle[]; };

void worldCorners(uint triangle, out vec3 a, out vec3 b, out vec3 c) {
    uint object = objectOfTriangle[triangle];
    mat4 worldFromMesh = objects[object].worldFromMesh;
    vec3 corners[3];
    for (uint i = 0u; i < 3u; ++i) {
        uint at = 3u * indices[3u * triangle + i];
        vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
        corners[i] = (worldFromMesh * vec4(position, 1.0)).xyz;
    }
    a = corners[0];
    b = corners[1];
    c = corners[2];
}
