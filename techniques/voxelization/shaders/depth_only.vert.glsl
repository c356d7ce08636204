#version 450 core
// The yardstick of speed: the mesh seen along z, depth only; there is no fragment stage.
layout(location = kPosition) in vec3 positionWorld;

uniform vec3 boxCentreWorld;
uniform vec3 clipFromWorldScale;  // 2 / edges of the box

void main() { gl_Position = vec4((positionWorld - boxCentreWorld) * clipFromWorldScale, 1.0); }
