// Where the reflection of a vertex of the grid goes in the key frame's image, and the length of its
// path ([xie2017] Sec. 5.4.2).
#include "reflection_reuse/grid_vertex.glsl"

uniform sampler2D distanceM;
uniform sampler2D offsets;
uniform usampler2D doubtful;
uniform bool hasDoubts;
uniform float missDistance;  // of rays that left the scene
uniform float longestPath;

float trustOf(ivec2 pixel) {
    return hasDoubts && texelFetch(doubtful, pixel, 0).r != 0u ? 0.0 : 1.0;
}

vec2 shiftedPlacePx(ivec2 pixel) {
    return vec2(pixel) + 0.5 + texelFetch(offsets, pixel, 0).xy;
}

// s.d + s.r, from −1 to 1: of reflections that overlap the nearest wins.
float pathDepth(ivec2 pixel) {
    float reflected = texelFetch(distanceM, pixel, 0).r;
    if (reflected <= 0.0) reflected = missDistance;
    float path = (texelFetch(keyDepth, pixel, 0).r + reflected) * (1.0 + pointBias);
    return 2.0 * path / longestPath - 1.0;
}
