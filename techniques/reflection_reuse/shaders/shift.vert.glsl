#version 450 core
// Shift, vertices ([xie2017] Sec. 5.4.2): a sample of the key frame to where its reflection goes,
// with the length of its path, s.d + s.r, for depth: of reflections that overlap the nearest wins.
#include "reflection_reuse/grid_vertex.glsl"

layout(binding = DISTANCE_UNIT) uniform sampler2D distanceM;
layout(binding = OFFSETS_UNIT) uniform sampler2D offsets;
layout(binding = DOUBTFUL_UNIT) uniform usampler2D doubtful;
uniform bool hasDoubts;
uniform float missDistance;  // of rays that left the scene
uniform float longestPath;

void main() {
    ivec2 pixel = vertexPixel();
    bool isDoubtful = hasDoubts && texelFetch(doubtful, pixel, 0).r != 0u;
    passPoint(pixel, isDoubtful ? 0.0 : 1.0);
    float reflected = texelFetch(distanceM, pixel, 0).r;
    if (reflected <= 0.0) reflected = missDistance;
    float path = (texelFetch(keyDepth, pixel, 0).r + reflected) * (1.0 + pointBias);
    vec2 placePx = vec2(pixel) + 0.5 + texelFetch(offsets, pixel, 0).xy;
    gl_Position = vec4(placePx / vec2(textureSize(keyDepth, 0)), path / longestPath, 1.0);
    gl_Position.xyz = 2.0 * gl_Position.xyz - 1.0;
}
