#version 450 core
// Evaluates one sample of a parametric surface a vertex and sends it to its voxel's column.
// [zju2005] Sec. 2.4.1 (2). Reads no attributes; writes the voxel and its value.

#include "voxelization/parametric.glsl"
#include "voxelization/voxel_value.glsl"

uniform vec3 boxMin;      // world space
uniform float voxelSize;  // world units

flat out ivec3 voxel;
flat out uint value;

void main() {
    vec2 uv = parameterOf(gl_VertexID);
    voxel = ivec3(floor((surfaceAt(uv) - boxMin) / voxelSize));
#if NORMALS
    // Tangents by differences over a tenth of the sample distance: small against the surface's
    // detail, large against a float's precision.
    vec2 delta = 0.1 * (domain.zw - domain.xy) / vec2(SAMPLES_U - 1, SAMPLES_V - 1);
    vec3 tangentU = surfaceAt(uv + vec2(delta.x, 0.0)) - surfaceAt(uv - vec2(delta.x, 0.0));
    vec3 tangentV = surfaceAt(uv + vec2(0.0, delta.y)) - surfaceAt(uv - vec2(0.0, delta.y));
    value = encodeNormal(cross(tangentU, tangentV) / (voxelSize * voxelSize));
#else
    value = 1u;
#endif
    bool isInBox = all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, SIZE));
    // The centre of pixel (x, y); z = 2 lies outside the clip volume.
    gl_Position = vec4((2.0 * vec2(voxel.xy) + 1.0) / vec2(SIZE.xy) - 1.0, isInBox ? 0.0 : 2.0, 1.0);
    gl_PointSize = 1.0;
}
