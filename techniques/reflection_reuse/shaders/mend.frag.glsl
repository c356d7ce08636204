#version 450 core
// Recompute, last part ([xie2017] Algorithm 8): traced samples into the reprojected ones. The device
// counts the fragments that remain. Outlook of Sec. 5.5.4, with seamPx > 0: next to reused samples
// they are mixed with those.
#include "reflections/gbuffer.glsl"

uniform usampler2D wanted;
uniform sampler2D traced;
uniform sampler2D tracedDistance;
uniform sampler2D reused;  // read where wanted is 0, written where 1
uniform int seamPx;

layout(location = 0) out vec4 radiance;
layout(location = 1) out float distanceM;

// The mean of the reused samples of the same reflector, nearer ones weighing more, and, in a, how
// much of it is mixed in: half beside a reused sample, nothing beyond seamPx.
vec4 reusedAround(ivec2 pixel) {
    ivec2 size = textureSize(wanted, 0);
    uint reflector = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    float nearest = float(seamPx) + 1.0;
    for (int y = -seamPx; y <= seamPx; ++y) {
        for (int x = -seamPx; x <= seamPx; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            float apart = length(vec2(x, y));
            if (apart > float(seamPx)) continue;
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
            if (reflectorOf(texelFetch(gbufferSurface, at, 0).r) != reflector) continue;
            if (texelFetch(wanted, at, 0).r != 0u) continue;
            float weight = 1.0 / (apart * apart);  // apart ≥ 1: the pixel itself is wanted
            sum += weight * texelFetch(reused, at, 0).rgb;
            weights += weight;
            nearest = min(nearest, apart);
        }
    }
    if (weights == 0.0) return vec4(0.0);
    return vec4(sum / weights, 0.5 * (1.0 - (nearest - 1.0) / float(seamPx)));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(wanted, pixel, 0).r == 0u) discard;
    vec3 own = texelFetch(traced, pixel, 0).rgb;
    if (seamPx > 0) {
        vec4 around = reusedAround(pixel);
        own = mix(own, around.rgb, around.a);
    }
    radiance = vec4(own, 1.0);
    distanceM = texelFetch(tracedDistance, pixel, 0).r;
}
