#version 450 core
// Shift, vertices ([xie2017] Sec. 5.4.2): a sample of the key frame to where its reflection goes,
// with the length of its path for depth.
#include "reflection_reuse/grid_vertex.glsl"

uniform sampler2D distanceM;
uniform sampler2D offsets;
uniform float missDistance;  // of rays that left the scene
uniform float longestPath;

// s.d + s.r, from −1 to 1: of reflections that overlap the nearest wins.
float pathDepth(ivec2 pixel) {
    float reflected = texelFetch(distanceM, pixel, 0).r;
    if (reflected <= 0.0) reflected = missDistance;
    float path = (texelFetch(keyDepth, pixel, 0).r + reflected) * (1.0 + pointBias);
    return 2.0 * path / longestPath - 1.0;
}

void main() {
    ivec2 pixel = vertexPixel();
    passPoint(pixel);
    vec2 placePx = vec2(pixel) + 0.5 + texelFetch(offsets, pixel, 0).xy;
    vec2 place = placePx / vec2(textureSize(keyDepth, 0));
    gl_Position = vec4(2.0 * place - 1.0, pathDepth(pixel), 1.0);
}
