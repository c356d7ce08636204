#version 450 core
// Depth along the view's axis and its square, from window depth: level 0 of the pyramid of variance
// shadow maps.

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

uniform sampler2D shadowMap;
layout(rg32f) uniform writeonly restrict image2D moments;

uniform float nearM;
uniform float farM;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(moments)))) return;
    float ndc = 2.0 * texelFetch(shadowMap, pixel, 0).r - 1.0;
    float depth = 2.0 * nearM * farM / (farM + nearM - ndc * (farM - nearM));
    imageStore(moments, pixel, vec4(depth, depth * depth, 0.0, 0.0));
}
