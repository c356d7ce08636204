#version 450 core
// A ramp along x: 0 at the left edge of the target, `brightness` at the right edge.

layout(location = 0) out float value;

uniform float brightness;
uniform float widthPx;

void main() {
    value = brightness * gl_FragCoord.x / widthPx;
}
