#version 450 core
#include "gl/balance_arithmetic.glsl"
layout(location = 0) out vec4 colour;

void main() { colour = arithmetic(gl_FragCoord.xy * 1e-3); }
