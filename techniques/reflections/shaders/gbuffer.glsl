// Reads what GBufferRenderer drew: GBuffer::resourcesFor().
#include "reflections/kept_colour.glsl"
#include "reflections/octahedral.glsl"

uniform sampler2D gbufferDiffuse;
uniform sampler2D gbufferNormal;
uniform sampler2D gbufferDepth;
uniform usampler2D gbufferSurface;
uniform usampler2D gbufferTriangleNormal;
uniform mat4 gbufferWorldFromPixels;
uniform vec3 gbufferEyeWorld;

uint reflectorOf(uint surface) {
    return surface & 0xFFFFu;
}
float reflectivityOf(uint surface) {
    return float((surface >> 16) & 0xFFu) / 255.0;
}
float glossinessOf(uint surface) {
    return float(surface >> 24) / 255.0;
}

// rgb_d of [xie2017] Algorithm 6.
vec3 gbufferDiffuseAt(ivec2 pixel) {
    return linearColour(texelFetch(gbufferDiffuse, pixel, 0).rgb);
}
vec3 gbufferPositionAt(ivec2 pixel, float depth) {
    return (gbufferWorldFromPixels * vec4((vec2(pixel) + 0.5) * depth, depth, 1.0)).xyz;
}
vec3 gbufferPosition(ivec2 pixel) {
    return gbufferPositionAt(pixel, texelFetch(gbufferDepth, pixel, 0).r);
}
vec3 gbufferUnitNormal(ivec2 pixel) {
    return unitFromOctahedral(texelFetch(gbufferNormal, pixel, 0).rg);
}
// Of the triangle, unit, on the side that is seen.
vec3 gbufferUnitTriangleNormal(ivec2 pixel) {
    return unitFromOctahedral(unpackSnorm2x16(texelFetch(gbufferTriangleNormal, pixel, 0).r));
}
// The mirror direction of a sample: unit.
vec3 gbufferMirrorDirection(vec3 positionWorld, vec3 normalWorld) {
    return normalize(reflect(positionWorld - gbufferEyeWorld, normalWorld));
}
