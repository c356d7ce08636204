#version 450 core
// Warp, vertices ([xie2017] Sec. 5.4.3): a sample of the key frame to the new view, by its depth.
#include "reflection_reuse/grid_vertex.glsl"

uniform mat4 clipFromKeyPixels;  // from (x·d, y·d, d, 1)

void main() {
    ivec2 pixel = vertexPixel();
    passPoint(pixel);
    float depth = texelFetch(keyDepth, pixel, 0).r;
    gl_Position = clipFromKeyPixels * vec4((vec2(pixel) + 0.5) * depth, depth, 1.0);
    gl_Position.z += pointBias;
}
