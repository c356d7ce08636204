#version 450 core
// Depth images, vertices: world space to clip space, and what the shading needs.

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec4 color;

uniform mat4 clipFromWorld;
uniform mat4 viewFromWorld;

out VertexData {
    vec3 normalView;
    vec4 color;
#if TEXTURES
    vec2 uv;
#endif
} vertex;

// The same in the programs of all images: what they sample must not depend on the rest of the code.
invariant gl_Position;

void main() {
    vertex.normalView = mat3(viewFromWorld) * normal;
    vertex.color = color;
#if TEXTURES
    vertex.uv = texcoord;
#endif
    gl_Position = clipFromWorld * vec4(position, 1.0);
}
