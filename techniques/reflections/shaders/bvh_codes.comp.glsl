#version 450 core
// GpuBvh, first pass: the Morton code of each triangle, that of its box's centre on a grid of 2^10
// cells a side over the scene's bounds (Karras 2012, Sec. 2).
#include "reflections/bvh_scene.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict writeonly buffer Pairs { uvec2 pairs[]; };  // code, triangle

uniform uint triangleCount;
uniform vec3 boundsMin;
uniform vec3 cellsPerMetre;  // 0 along axes without extent

// Puts two zeros before each of the lower ten bits.
uvec3 spread(uvec3 v) {
    v = (v | (v << 16)) & 0x030000FFu;
    v = (v | (v << 8)) & 0x0300F00Fu;
    v = (v | (v << 4)) & 0x030C30C3u;
    return (v | (v << 2)) & 0x09249249u;
}

void main() {
    uint triangle = gl_GlobalInvocationID.x;
    if (triangle >= triangleCount) return;
    vec3 a, b, c;
    worldCorners(triangle, a, b, c);
    vec3 centre = 0.5 * (min(min(a, b), c) + max(max(a, b), c));
    uvec3 bits = spread(uvec3(clamp((centre - boundsMin) * cellsPerMetre, 0.0, 1023.0)));
    pairs[triangle] = uvec2((bits.x << 2) | (bits.y << 1) | bits.z, triangle);
}
