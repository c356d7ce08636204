#version 450 core
// The triangle that a texel shows, and whether it is of the own reflector. Depth is the hardware's.

flat in uint triangleOfPoint;

layout(location = 0) out uint triangle;

void main() {
    triangle = triangleOfPoint;
}
