// Pixel redundancy of a sample of image I with images J₀ … ([xie2017] Algorithm 3); include-only.
// Reads the samples of I (depths, triangle ids) and the triangle ids of J₀ …. As it reads:
//
//     pointWorld = unproject(I.view, centrePx, depth);
//     return projectToPixel(J.clipFromWorld, J.sizePx, pointWorld, landedPx)
//         && isInside(landedPx, J.sizePx)
//         && J.triangleId[ivec2(landedPx)] == triangleId;
//
// Both projections are linear in (x·d, y·d, d, 1), (x, y) being pixel coordinates and d the depth, so
// that one matrix, multiplied out in double precision (kit::reprojection), does for both.
// The renderer's fragments are tested by the same function on the same numbers.

#include "kit/redundancy_tests.glsl"

uniform usampler2D sampleTriangleIds;

#if IMAGE_COUNT > 0
uniform sampler2D sampleDepths;
uniform usampler2D triangleIds[IMAGE_COUNT];
uniform mat4 otherFromHere[IMAGE_COUNT];
uniform vec2 otherSizePx[IMAGE_COUNT];
#endif

// Whether one of the images holds the sample of I in `pixel`, which is of triangle `triangleId`.
bool isRedundantWithAny(ivec2 pixel, uint triangleId) {
#if IMAGE_COUNT > 0
    vec3 sampleHere = vec3(vec2(pixel) + 0.5, texelFetch(sampleDepths, pixel, 0).r);
    for (int i = 0; i < IMAGE_COUNT; ++i) {
        if (isPixelRedundant(triangleIds[i], otherSizePx[i], otherFromHere[i], sampleHere,
                             triangleId)) {
            return true;
        }
    }
#endif
    return false;
}
