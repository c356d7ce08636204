// What vertices hand on of surfaces, which surface.glsl reads.

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec3 color;
layout(location = kObjectIndex) in uint objectIndex;
layout(location = kMatrix) in mat4 worldFromMesh;  // of objects[objectIndex]
layout(location = kMatrix + 4) in mat3 normalFromMesh;

out SurfacePoint {
    vec3 positionWorld;
    vec3 normalWorld;  // not of unit length: interpolated as it is in mesh space
    vec2 texcoord;
    vec3 color;
    flat uint object;
} point;

// The vertex in the world.
vec4 handOn() {
    vec4 positionWorld = worldFromMesh * vec4(position, 1.0);
    point.positionWorld = positionWorld.xyz;
    point.normalWorld = normalFromMesh * normal;
    point.texcoord = texcoord;
    point.color = color;
    point.object = objectIndex;
    return positionWorld;
}
