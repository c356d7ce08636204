// Whether a sample is redundant with another view ([xie2017] Algorithms 2 and 3).

// A sample of one view as another view sees it: xy its pixel coordinates there, z its distance along
// the other view's axis (0 or less: on or behind the eye's plane). `sampleHere` is the same of this
// view; `thereFromHere` is kit::reprojection() of the two. A pixel's centre reprojected
// into an equal view stays within a rounding error of the centre, far from the pixel's border.
vec3 reproject(mat4 thereFromHere, vec3 sampleHere) {
    vec3 there = mat3(thereFromHere) * vec3(sampleHere.xy * sampleHere.z, sampleHere.z) +
                 thereFromHere[3].xyz;
    return vec3(there.xy / there.z, there.z);
}

bool isInside(vec3 there, vec2 sizePx) {
    return there.z > 0.0 && all(greaterThanEqual(there.xy, vec2(0.0))) &&
           all(lessThan(there.xy, sizePx));
}

// Algorithm 3: whether the pixel in which the sample lands holds the sample's own triangle. No depth
// is compared: the ids alone decide. A sample outside of the image is not redundant.
bool isPixelRedundant(usampler2D triangleIds, vec2 sizePx, mat4 thereFromHere, vec3 sampleHere,
                      uint triangleId) {
    vec3 there = reproject(thereFromHere, sampleHere);
    // The fetch itself must stay inside of the image, too.
    ivec2 pixel = isInside(there, sizePx) ? ivec2(there.xy) : ivec2(0);
    return isInside(there, sizePx) && texelFetch(triangleIds, pixel, 0).r == triangleId;
}

// Algorithm 2 by the depths of the other view's conventional image (0: nothing) in place of a ray:
// whether nothing lies before the sample by more than two footprints of its pixel.
bool isVisibleThere(sampler2D depths, vec2 sizePx, mat4 thereFromHere, vec3 sampleHere,
                    float footprintPerDepth) {
    vec3 there = reproject(thereFromHere, sampleHere);
    ivec2 pixel = isInside(there, sizePx) ? ivec2(there.xy) : ivec2(0);
    float nearest = texelFetch(depths, pixel, 0).r;
    bool isHidden = nearest > 0.0 && nearest < there.z * (1.0 - 2.0 * footprintPerDepth);
    return isInside(there, sizePx) && !isHidden;
}
