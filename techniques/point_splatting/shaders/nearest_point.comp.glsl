#version 450 core
// The compute splatter's first pass (Schütz et al. 2021): the least depth of each pixel by atomics.
// Distances are positive, so that their bits have their order.
#include "point_splatting/point_projection.glsl"

layout(std430) restrict buffer Pixels { uint pixels[]; };

void main() {
    Chunk chunk = chunks[firstChunk + gl_WorkGroupID.x];
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += uint(GROUP_SIZE)) {
        SplatPoint point = pointAt(chunk.first + i, chunk.boxMin.xyz, chunk.boxSize.xyz);
        vec3 centre = (eyeFromModel * vec4(point.position, 1.0)).xyz;
        vec3 normal = mat3(eyeFromModel) * point.normal;
        int pixel = pixelOf(centre, normal);
        if (pixel == kOutside) continue;
        atomicMin(pixels[pixel * PIXEL_WORDS], floatBitsToUint(centre.z));
    }
}
