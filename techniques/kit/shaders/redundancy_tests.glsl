// Pixel redundancy of a sample with an image ([xie2017] Algorithm 3).

// A sample of one view as another view sees it: xy its pixel coordinates there, z its distance along
// the other view's axis (0 or less: on or behind the eye's plane). `sampleHere` is the same of this
// view; `thereFromHere` is kit::reprojection() of the two. A pixel's centre reprojected
// into an equal view stays within a rounding error of the centre, far from the pixel's border.
vec3 reproject(mat4 thereFromHere, vec3 sampleHere) {
    vec3 there = mat3(thereFromHere) * vec3(sampleHere.xy * sampleHere.z, sampleHere.z) +
                 thereFromHere[3].xyz;
    return vec3(there.xy / there.z, there.z);
}

// Whether the pixel in which the sample lands holds the sample's own triangle. No depth is compared:
// the ids alone decide. A sample outside of the image is not redundant.
bool isPixelRedundant(usampler2D triangleIds, vec2 sizePx, mat4 thereFromHere, vec3 sampleHere,
                      uint triangleId) {
    vec3 there = reproject(thereFromHere, sampleHere);
    bool isInside = there.z > 0.0 && all(greaterThanEqual(there.xy, vec2(0.0))) &&
                    all(lessThan(there.xy, sizePx));
    // The fetch itself must stay inside of the image, too.
    ivec2 pixel = isInside ? ivec2(there.xy) : ivec2(0);
    return isInside && texelFetch(triangleIds, pixel, 0).r == triangleId;
}

// Visibility redundancy ([xie2017] Algorithm 2) by the depths of the other view's conventional image:
// whether nothing there lies before the sample by more than two footprints of its pixel.
bool isVisibleThere(sampler2D depths, vec2 sizePx, mat4 thereFromHere, vec3 sampleHere,
                    float footprintPerDepth) {
    vec3 there = reproject(thereFromHere, sampleHere);
    bool isInside = there.z > 0.0 && all(greaterThanEqual(there.xy, vec2(0.0))) &&
                    all(lessThan(there.xy, sizePx));
    ivec2 pixel = isInside ? ivec2(there.xy) : ivec2(0);
    float nearest = texelFetch(depths, pixel, 0).r;  // 0: nothing
    return isInside && (nearest == 0.0 || there.z <= nearest + 2.0 * footprintPerDepth * there.z);
}
