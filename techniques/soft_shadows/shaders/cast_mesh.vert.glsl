#version 450 core
// Draws a mesh into a shadow map; there is no fragment stage.
layout(location = kPosition) in vec3 positionWorld;

uniform mat4 clipFromWorld;

void main() { gl_Position = clipFromWorld * vec4(positionWorld, 1.0); }
