#version 450 core
// Surfaces, vertices: from mesh space to the world and to clip space. For every pass that draws the
// scene from one point; fragments include surface.glsl.

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec3 color;
layout(location = kObjectIndex) in uint objectIndex;
layout(location = kMatrix) in mat4 worldFromMesh;  // of objects[objectIndex]
layout(location = kMatrix + 4) in mat3 normalFromMesh;

uniform mat4 clipFromWorld;

out SurfacePoint {
    vec3 positionWorld;
    vec3 normalWorld;  // not of unit length: interpolated as it is in mesh space
    vec2 texcoord;
    vec3 color;
    flat uint object;
} point;

// The same in all programs: what a pixel samples must not depend on the rest of the code.
invariant gl_Position;

void main() {
    vec4 positionWorld = worldFromMesh * vec4(position, 1.0);
    point.positionWorld = positionWorld.xyz;
    point.normalWorld = normalFromMesh * normal;
    point.texcoord = texcoord;
    point.color = color;
    point.object = objectIndex;
    gl_Position = clipFromWorld * positionWorld;
}
