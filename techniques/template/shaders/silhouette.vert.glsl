#version 450 core
// Takes the mesh to clip space. POSITION is the attribute location that gpu_scene uses.

layout(location = POSITION) in vec3 positionWorld;

uniform mat4 clipFromWorld;

void main() {
    gl_Position = clipFromWorld * vec4(positionWorld, 1.0);
}
