// Pixel redundancy of a sample of image I with images J₀ … ([xie2017] Algorithm 3); include-only.
// Reads the samples of I (depths, triangle ids) and the triangle ids of J₀ ….
//
// Algorithm 3, as it reads:
//
//     pointWorld = unproject(I.view, centrePx, depth);
//     return projectToPixel(J.clipFromWorld, J.sizePx, pointWorld, landedPx)
//         && isInside(landedPx, J.sizePx)
//         && J.triangleId[ivec2(landedPx)] == triangleId;
//
// Both projections are linear in homogeneous coordinates. With S the matrix that takes
// (x·d, y·d, d, 1), (x, y) in pixels of I and d the depth, to the point in the view of I:
//
//     landedPx ~ viewport_J · clipFromView_J · viewFromWorld_J · worldFromView_I · S · (x·d, y·d, d, 1)
//              ~ pixelFromSample · (x, y, 1, 1/d)
//
// A factor d > 0 does not move the point, nor change the sign of its w (which is the depth in J over
// d). pixelFromSample is multiplied out in double precision (techniques/shared/view.cpp), so that a
// view with itself gives the identity: pixel centres land in the middle of their pixel.

layout(r32ui, binding = TRIANGLE_ID_IMAGE) readonly uniform uimage2D sampleTriangleIds;

#if IMAGE_COUNT > 0
layout(r32f, binding = DEPTH_IMAGE) readonly uniform image2D sampleDepths;
layout(binding = FIRST_TRIANGLE_IDS_UNIT) uniform usampler2D triangleIds[IMAGE_COUNT];
uniform mat4 pixelFromSample[IMAGE_COUNT];
#endif

// Whether one of the images holds the sample of I in `pixel`, which is of triangle `triangleId`.
bool isRedundantWithAny(ivec2 pixel, uint triangleId) {
#if IMAGE_COUNT > 0
    vec4 samplePx = vec4(vec2(pixel) + 0.5, 1.0, 1.0 / imageLoad(sampleDepths, pixel).r);
    for (int i = 0; i < IMAGE_COUNT; ++i) {
        vec4 landed = pixelFromSample[i] * samplePx;
        vec2 landedPx = landed.xy / landed.w;
        vec2 sizePx = vec2(textureSize(triangleIds[i], 0));
        bool isInside = all(greaterThanEqual(landedPx, vec2(0.0))) && all(lessThan(landedPx, sizePx));
        if (landed.w > 0.0 && isInside &&
            texelFetch(triangleIds[i], ivec2(landedPx), 0).r == triangleId) {
            return true;
        }
    }
#endif
    return false;
}
