#version 450 core
// Out: world position (w = 1: there is a surface), geometric normal turned to the eye, unlit colour.

in vec3 surfacePositionWorld;
in vec2 surfaceTexcoord;
in vec3 surfaceColor;

uniform sampler2D baseColor;
uniform float alphaCutoff;
uniform vec3 eyeWorld;

layout(location = 0) out vec4 position;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 shading;

void main() {
    // Before anything is discarded: derivatives take the pixels beside this one.
    vec3 n = normalize(cross(dFdx(surfacePositionWorld), dFdy(surfacePositionWorld)));
    vec4 texel = texture(baseColor, surfaceTexcoord);
    if (texel.a < alphaCutoff) discard;
    position = vec4(surfacePositionWorld, 1.0);
    normal = vec4(dot(n, eyeWorld - surfacePositionWorld) < 0.0 ? -n : n, 0.0);
    shading = vec4(surfaceColor * texel.rgb, 1.0);
}
