#version 450 core
// 1 at every reflective sample; the others stay what they were cleared to. The device counts the
// fragments that remain.
#include "reflections/gbuffer.glsl"

layout(location = 0) out uint wanted;

void main() {
    if (reflectorOf(texelFetch(gbufferSurface, ivec2(gl_FragCoord.xy), 0).r) == 0u) discard;
    wanted = 1u;
}
