#version 450 core
// Environment mapping: the mean of the map over the rays of each wanted reflective sample. All rays
// weigh the same, glossy ones too: the map does not know how far away anything is, so that nothing
// fades towards a far plane.
#include "reflections/traced_sample.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint surface = texelFetch(gbufferSurface, pixel, 0).r;
    if (!isTraced(pixel, surface)) discard;
    vec3 mirror = gbufferMirrorDirection(gbufferPosition(pixel), gbufferUnitNormal(pixel));
    float glossiness = glossinessOf(surface);
    int count = raysOf(glossiness);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        sum += radianceFrom(lobeDirection(mirror, glossiness, i, count));
    }
    radiance = vec4(sum / float(count), 1.0);
    distanceM = 0.0;  // not known
}
