#version 450 core
// Marks samples of image I that are redundant with one of the images J₀ …, or with none of them:
// measures 1 to 3 of [xie2017] Sec. 2.3.2. One thread a pixel; reads I and triangle ids of J₀ …, adds
// `bit` to `marks`.

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

#include "depth_sampling/redundancy.glsl"

layout(r32ui, binding = MARK_IMAGE) uniform uimage2D marks;

uniform bool isRedundant;  // marked are redundant samples (else the others)
uniform uint among;        // only samples with all of these marks
uniform uint bit;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(marks)))) return;
    uint triangleId = imageLoad(sampleTriangleIds, pixel).r;
    uint known = imageLoad(marks, pixel).r;
    if (triangleId == 0u || (known & among) != among || (known & bit) != 0u) return;
    if (isRedundantWithAny(pixel, triangleId) == isRedundant) {
        imageStore(marks, pixel, uvec4(known | bit));
    }
}
