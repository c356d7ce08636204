#version 450 core
// The arithmetic by fragments: balance.cpp times it beside the compute invocations'.
#include "gl/balance_arithmetic.glsl"
layout(location = 0) out vec4 colour;

void main() { colour = arithmetic(gl_FragCoord.xy * 1e-3); }
