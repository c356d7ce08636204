#version 450 core
// The arithmetic by compute invocations, one a texel: balance.cpp times it beside the fragments'.
#include "gl/balance_arithmetic.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform writeonly image2D colour;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    imageStore(colour, texel, arithmetic((vec2(texel) + 0.5) * 1e-3));
}
