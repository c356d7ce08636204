#version 450 core
// Step 1, vertices ([zju2005] Sec. 4.2.1 (2)): the light's clip space; z and w go to the fragments
// where there are any. In hardware storage nothing but the position leaves ([zju2005] Sec. 4.3 (2)).

layout(location = kPosition) in vec3 positionWorld;

uniform mat4 clipFromWorld;

#if FRAGMENT_WORK
out vec2 clipZW;
#endif

void main() {
    gl_Position = clipFromWorld * vec4(positionWorld, 1.0);
#if FRAGMENT_WORK
    clipZW = gl_Position.zw;
#endif
}
