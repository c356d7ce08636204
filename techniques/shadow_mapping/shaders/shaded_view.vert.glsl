#version 450 core
// Step 2, vertices: the camera's clip space, what the lighting needs, and where each light's map is
// looked up ([zju2005] Sec. 4.2.1 (3), 4.3 (3)).

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec4 color;

uniform mat4 clipFromWorld;
#if LOOKUP_IN_VERTEX
uniform mat4 lookupFromWorld[VIEW_COUNT];
out vec4 lookup[VIEW_COUNT];  // T; one view a light
#endif

out vec3 positionWorld;
out vec3 normalWorld;
out vec2 uv;
out vec3 albedo;

void main() {
    positionWorld = position;
    normalWorld = normal;
    uv = texcoord;
    albedo = color.rgb;
#if LOOKUP_IN_VERTEX
    for (int i = 0; i < VIEW_COUNT; ++i) lookup[i] = lookupFromWorld[i] * vec4(position, 1.0);
#endif
    gl_Position = clipFromWorld * vec4(position, 1.0);
}
