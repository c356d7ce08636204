#version 450 core
// Writes `brightness` where the mesh covers the pixel's centre.

layout(location = 0) out float value;

uniform float brightness;

void main() {
    value = brightness;
}
