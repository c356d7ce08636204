#version 450 core
// Surfaces, vertices: from mesh space to the world and to clip space. For every pass that draws the
// scene from one point; fragments include surface.glsl.
#include "reflections/surface_point.glsl"

uniform mat4 clipFromWorld;

// The same in all programs: what a pixel samples must not depend on the rest of the code.
invariant gl_Position;

void main() {
    gl_Position = clipFromWorld * handOn();
}
