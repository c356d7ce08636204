// A fragment of a grid over the key frame.

layout(binding = RADIANCE_UNIT) uniform sampler2D radiance;
layout(binding = KEY_SURFACE_UNIT) uniform usampler2D keySurface;
uniform bool isPoints;
uniform float maxGrowth;

in GridPoint {
    noperspective vec2 placePx;
    flat ivec2 pixel;
} point;

// Whether the triangle's area grew beyond what can be trusted ([xie2017] Sec. 5.4.2, 5.5.1). The
// place in the key frame is linear over a triangle: the determinant of its derivatives is the area
// before, of a pixel after. Call it before any discard: neighbours take part.
bool hasGrown() {
    vec2 dx = dFdx(point.placePx), dy = dFdy(point.placePx);
    return !isPoints && abs(dx.x * dy.y - dx.y * dy.x) * maxGrowth < 1.0;
}

// Of all corners of the cell, or of the point.
uint reflectorOfPoint() {
    return texelFetch(keySurface, point.pixel, 0).r & 0xFFFFu;
}

// The corners of the triangle that the fragment is of, and their weights: the one at the right
// angle, and those beside it along x and y. Of a point: thrice itself.
struct Corners {
    ivec2 pixel[3];
    vec3 weight;
};
Corners corners() {
    if (isPoints) return Corners(ivec2[3](point.pixel, point.pixel, point.pixel), vec3(1, 0, 0));
    ivec2 lower = point.pixel - ivec2(0, 1);
    // Of triangles seen edge-on, interpolation may end beyond their corners.
    vec2 at = clamp(point.placePx - 0.5 - vec2(lower), 0.0, 1.0);
    bool isUpper = at.x + at.y > 1.0;
    if (isUpper) at = 1.0 - at;
    int side = isUpper ? -1 : 1;
    ivec2 right = isUpper ? lower + 1 : lower;
    return Corners(ivec2[3](right, right + ivec2(side, 0), right + ivec2(0, side)),
                   vec3(1.0 - at.x - at.y, at));
}

vec3 radianceOf(Corners corners) {
    return corners.weight[0] * texelFetch(radiance, corners.pixel[0], 0).rgb +
           corners.weight[1] * texelFetch(radiance, corners.pixel[1], 0).rgb +
           corners.weight[2] * texelFetch(radiance, corners.pixel[2], 0).rgb;
}
