#version 450 core
// What the output image shows: the points whose shadows are measured. In: world-space vertices.

layout(location = POSITION) in vec3 positionWorld;
layout(location = TEXCOORD) in vec2 texcoord;
layout(location = COLOR) in vec3 color;

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
