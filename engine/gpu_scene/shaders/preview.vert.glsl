#version 450 core
// The look at a scene, vertices: reads a mesh's attributes, writes what the headlight needs.

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec3 color;

uniform mat4 worldFromMesh;
uniform mat4 normalWorldFromMesh;  // inverse transpose of worldFromMesh's linear part
uniform mat4 clipFromWorld;
uniform vec3 cameraPositionWorld;

out vec3 normalWorld;
out vec3 toCameraWorld;
out vec2 uv;
out vec3 vertexColor;

void main() {
    vec4 positionWorld = worldFromMesh * vec4(position, 1.0);
    normalWorld = mat3(normalWorldFromMesh) * normal;
    toCameraWorld = cameraPositionWorld - positionWorld.xyz;
    uv = texcoord;
    vertexColor = color;
    gl_Position = clipFromWorld * positionWorld;
}
