#version 450 core
// Once a key frame, for gather.frag.glsl: what its samples show, R of Eq. 8 ([xie2017] Sec. 5.3).
// Reads the key frame's G-buffer and travel distances.
#include "reflections/gbuffer.glsl"

uniform sampler2D distanceM;
uniform float missDistance;  // of rays that left the scene

layout(location = 0) out vec4 reflected;  // R, and the reflector; 0: none

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    reflected = vec4(0.0);
    uint reflector = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    if (reflector == 0u) return;
    float r = texelFetch(distanceM, pixel, 0).r;
    if (r <= 0.0) r = missDistance;
    vec3 position = gbufferPosition(pixel);
    vec3 direction = gbufferMirrorDirection(position, gbufferUnitNormal(pixel));
    reflected = vec4(position + r * direction, float(reflector));
}
