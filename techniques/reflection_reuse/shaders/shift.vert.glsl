#version 450 core
// Shift, vertices ([xie2017] Sec. 5.4.2): a sample of the key frame to where its reflection goes,
// with the length of its path for depth.
#include "reflection_reuse/grid_path.glsl"

void main() {
    ivec2 pixel = vertexPixel();
    passPoint(pixel, trustOf(pixel));
    vec2 place = shiftedPlacePx(pixel) / vec2(textureSize(keyDepth, 0));
    gl_Position = vec4(2.0 * place - 1.0, pathDepth(pixel), 1.0);
}
