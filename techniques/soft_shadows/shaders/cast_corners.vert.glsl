#version 450 core
// Draws a reconstructed mesh into a shadow map; there is no fragment stage. A vertex is a point of
// the depth image: where in half pixels, and its depth.
layout(location = HALF_PX_LOCATION) in vec2 positionHalfPx;
layout(location = DEPTH_LOCATION) in float depth;

uniform mat4 clipFromCorner;  // of the light, times worldFromCorner of the depth image

void main() { gl_Position = clipFromCorner * vec4(positionHalfPx * depth, depth, 1.0); }
