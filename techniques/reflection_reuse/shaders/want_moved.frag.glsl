#version 450 core
// Samples of the new view that are to be traced again: on reflectors that have moved, and those
// whose mirror ray passes the box that a moved object is in now.
#include "reflection_reuse/moved_objects.glsl"
#include "reflections/gbuffer.glsl"
#include "reflections/objects.glsl"

layout(location = 0) out uint wanted;

bool isTouched(ivec2 pixel, uint reflector) {
    vec3 position = gbufferPosition(pixel);
    vec3 direction = gbufferMirrorDirection(position, gbufferUnitNormal(pixel));
    const float kEndless = 1e30;
    for (uint i = 0u; i < movedCount; ++i) {
        uint object = moved[i].object;
        if ((objects[object].surface & 0xFFFFu) == reflector) return true;
        if (passesBox(position, direction, kEndless, objects[object].boundsCentre.xyz,
                      objects[object].boundsHalfSize.xyz)) {
            return true;
        }
    }
    return false;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint reflector = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    if (reflector == 0u || !isTouched(pixel, reflector)) discard;
    wanted = 1u;
}
