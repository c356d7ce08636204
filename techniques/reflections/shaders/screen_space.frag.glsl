#version 450 core
// Screen-space reflection (McGuire and Mara 2014, "Efficient GPU Screen-Space Ray Tracing"): each
// reflected ray is marched texel by texel through the G-buffer. Reads the G-buffer, the environment
// map and which samples are wanted; writes what ReflectionTarget holds.
#include "reflections/traced_sample.glsl"

uniform mat4 pixelsFromWorld;  // to (x·d, y·d, d, 1), (x, y) in pixels
uniform float nearM;
uniform float thicknessM;

// How far a ray stays on the inner side of a plane from which its origin is `height` away, changing
// by `perMetre`.
float reach(float height, float perMetre) {
    return perMetre < 0.0 ? max(-height / perMetre, 0.0) : 3.4e38;
}

struct ScreenHit {
    ivec2 pixel;
    float distanceM;  // along the ray
};

// The first texel whose depth the ray passes within thicknessM. Each step moves by one pixel along
// the longer axis of the ray's image. Both 1 / d and t / d are linear in the image, d being the
// distance along the view axis and t the one along the ray.
bool march(vec3 originWorld, vec3 direction, float endM, out ScreenHit hit) {
    // (x·d, y·d, d) is linear in t.
    vec3 origin = (pixelsFromWorld * vec4(originWorld, 1.0)).xyz;
    vec3 perMetre = (pixelsFromWorld * vec4(direction, 0.0)).xyz;
    vec2 size = vec2(textureSize(gbufferDepth, 0));
    float t = min(endM, reach(origin.z - nearM, perMetre.z));
    t = min(t, min(reach(origin.x, perMetre.x), reach(origin.y, perMetre.y)));
    vec2 fromFarEdge = size * origin.z - origin.xy;
    vec2 fromFarEdgePerMetre = size * perMetre.z - perMetre.xy;
    t = min(t, min(reach(fromFarEdge.x, fromFarEdgePerMetre.x),
                   reach(fromFarEdge.y, fromFarEdgePerMetre.y)));

    vec3 end = origin + t * perMetre;
    vec2 beginPx = origin.xy / origin.z;
    vec2 deltaPx = end.xy / end.z - beginPx;
    float k1 = 1.0 / origin.z;
    float k2 = 1.0 / end.z - k1;  // 1 / d = k1 + k2·u, u in [0, 1] along the ray's image
    // Clipped, it crosses the picture once; the bound ends the loop should rounding say otherwise.
    float steps = min(ceil(max(abs(deltaPx.x), abs(deltaPx.y))), 2.0 * max(size.x, size.y));
    float perStep = 1.0 / max(steps, 1.0);
    for (float i = 1.0; i <= steps; ++i) {
        float u = i * perStep;
        ivec2 pixel = ivec2(clamp(beginPx + u * deltaPx, vec2(0.0), size - 1.0));
        float depth = texelFetch(gbufferDepth, pixel, 0).r;
        if (depth == 0.0) continue;
        // What the ray passes while it is over the texel, half a step before and behind: it is a
        // hit where max(1 / a, 1 / b) >= depth and min(1 / a, 1 / b) <= depth + thicknessM.
        float before = (i - 0.5) * perStep, behind = min((i + 0.5) * perStep, 1.0);
        float a = k1 + k2 * before, b = k1 + k2 * behind;
        if (min(a, b) * depth > 1.0 || max(a, b) * (depth + thicknessM) < 1.0) continue;
        // A side that the eye does not see is not known; and the ray does not meet the surface that
        // it leaves, however the texels round its depth.
        if (dot(gbufferUnitNormal(pixel), direction) >= 0.0) continue;
        float met = k2 != 0.0 ? clamp((1.0 / depth - k1) / k2, before, behind) : u;
        hit = ScreenHit(pixel, met * (t / end.z) / (k1 + k2 * met));
        return true;
    }
    return false;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint surface = texelFetch(gbufferSurface, pixel, 0).r;
    if (!isTraced(pixel, surface)) discard;
    float glossiness = glossinessOf(surface);
    vec3 position = gbufferPosition(pixel);
    vec3 mirrorDirection = gbufferMirrorDirection(position, gbufferUnitNormal(pixel));

    // Twice the diagonal: moved objects may lie outside of the scene's box.
    ScreenHit hit;
    bool isHit = march(position, mirrorDirection, 2.0 * lobeDiagonal, hit);
    distanceM = isHit ? hit.distanceM : 0.0;
    if (glossiness <= 0.0) {
        radiance = vec4(isHit ? gbufferDiffuseAt(hit.pixel)
                              : radianceFrom(mirrorDirection),
                        1.0);
        return;
    }
    // [xie2017] Sec. 4.6: beyond the far plane nothing counts; the diffuse colour stands in.
    float far = farPlane(glossiness);
    int count = raysOf(glossiness);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < count; ++i) {
        vec3 direction = lobeDirection(mirrorDirection, glossiness, i, count);
        if (!march(position, direction, far, hit)) continue;
        float weight = fadeOf(glossiness, hit.distanceM);
        sum += weight * gbufferDiffuseAt(hit.pixel);
        weights += weight;
    }
    vec3 diffuse = gbufferDiffuseAt(pixel);
    radiance = vec4((sum + (float(count) - weights) * diffuse) / float(count), 1.0);
}
