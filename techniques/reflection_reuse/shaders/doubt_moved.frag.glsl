#version 450 core
// Key-frame samples whose reflected segment W → R passes a box that its object has left.
#include "reflection_reuse/moved_objects.glsl"
#include "reflections/gbuffer.glsl"

uniform sampler2D distanceM;
uniform float missDistance;  // of rays that left the scene

layout(location = 0) out uint doubtful;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    doubtful = 0u;
    if (reflectorOf(texelFetch(gbufferSurface, pixel, 0).r) == 0u) return;
    vec3 position = gbufferPosition(pixel);
    vec3 direction = gbufferMirrorDirection(position, gbufferUnitNormal(pixel));
    float end = texelFetch(distanceM, pixel, 0).r;
    if (end <= 0.0) end = missDistance;
    for (uint i = 0u; i < movedCount; ++i) {
        if (passesBox(position, direction, end, moved[i].keyCentre.xyz,
                      moved[i].keyHalfSize.xyz)) {
            doubtful = 1u;
        }
    }
}
