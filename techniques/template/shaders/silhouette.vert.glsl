#version 450 core
// Takes the mesh to clip space. kPosition is gpu_scene's location.

layout(location = kPosition) in vec3 positionWorld;

uniform mat4 clipFromWorld;

void main() {
    gl_Position = clipFromWorld * vec4(positionWorld, 1.0);
}
