#version 450 core
// What the output image shows: the points whose shadows are measured. In: world-space vertices.

layout(location = kPosition) in vec3 positionWorld;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec3 color;

uniform mat4 clipFromWorld;

out vec3 surfacePositionWorld;
out vec2 surfaceTexcoord;
out vec3 surfaceColor;

void main() {
    surfacePositionWorld = positionWorld;
    surfaceTexcoord = texcoord;
    surfaceColor = color;
    gl_Position = clipFromWorld * vec4(positionWorld, 1.0);
}
