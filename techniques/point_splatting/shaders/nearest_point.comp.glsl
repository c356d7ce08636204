#version 450 core
// The compute splatter's first pass (Schütz et al. 2021): the least depth of each pixel by atomics.
// Distances are positive, so that their bits have their order.
#include "point_splatting/point_projection.glsl"

layout(std430) restrict buffer Pixels { uint pixels[]; };

void takePoint(uint index, vec3 centre, vec3 normal, int pixel) {
    atomicMin(pixels[pixel * PIXEL_WORDS], floatBitsToUint(centre.z));
}
