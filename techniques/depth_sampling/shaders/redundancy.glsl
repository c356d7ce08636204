// Pixel redundancy of a sample of image I with images J₀ … ([xie2017] Algorithm 3); include-only.
// Reads the samples of I (depths, triangle ids) and the triangle ids of J₀ …. The test is the one
// that the images were drawn with, on the same numbers: what was discarded is what counts as
// redundant, to the last bit.

#include "shared/pixel_redundancy.glsl"

layout(r32ui, binding = TRIANGLE_ID_IMAGE) readonly uniform uimage2D sampleTriangleIds;

#if IMAGE_COUNT > 0
layout(r32f, binding = DEPTH_IMAGE) readonly uniform image2D sampleDepths;
layout(binding = FIRST_TRIANGLE_IDS_UNIT) uniform usampler2D triangleIds[IMAGE_COUNT];
uniform mat4 thereFromHere[IMAGE_COUNT];  // reprojection()
#endif

// Whether one of the images holds the sample of I in `pixel`, which is of triangle `triangleId`.
bool isRedundantWithAny(ivec2 pixel, uint triangleId) {
#if IMAGE_COUNT > 0
    vec3 sampleHere = vec3(vec2(pixel) + 0.5, imageLoad(sampleDepths, pixel).r);
    for (int i = 0; i < IMAGE_COUNT; ++i) {
        vec2 sizePx = vec2(textureSize(triangleIds[i], 0));
        if (isPixelRedundant(triangleIds[i], sizePx, thereFromHere[i], sampleHere, triangleId)) {
            return true;
        }
    }
#endif
    return false;
}
