#version 450 core
// The cheapest fragment: balance.cpp times how fast pixels are filled and triangles drawn.
layout(location = 0) out vec4 colour;

void main() { colour = vec4(0.25, 0.5, 0.75, 1.0); }
