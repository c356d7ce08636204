#version 450 core
// The accumulation pass: a splat's Gaussian (Eq. 2) times what it carries, added to its pixels.
// Ellipses come with their own coordinates; round splats (ROUND) measure from their centre, discs
// (DISC) where the pixel's ray meets them.
// Writes Σ w n and Σ w, and with COLORS Σ w c.
#ifdef DISC
#define VARYING in
#define DISC_FRAGMENT
#include "point_splatting/disc.glsl"
#endif

flat in vec4 normalViewWeight;
layout(location = 0) out vec4 normalSum;
#ifdef COLORS
flat in vec3 color;
layout(location = 1) out vec4 colorSum;
#endif

uniform float cutoff;
#ifdef ROUND
uniform float lowPassRadiusPx;
flat in vec2 centrePx;
#elif !defined(DISC)
in vec2 positionInSplat;
#endif

void main() {
#ifdef DISC
    DiscHit hit = discHit(gl_FragCoord.xy, cutoff);
    if (!hit.isWithin) discard;
    float distance2 = hit.distance2;
    gl_FragDepth = hit.depth;
#else
#ifdef ROUND
    vec2 positionInSplat = (gl_FragCoord.xy - centrePx) / lowPassRadiusPx;
#endif
    float distance2 = dot(positionInSplat, positionInSplat);
    if (distance2 > cutoff * cutoff) discard;
#endif
    float weight = normalViewWeight.w * exp(-0.5 * distance2);
    normalSum = vec4(weight * normalViewWeight.xyz, weight);
#ifdef COLORS
    colorSum = vec4(weight * color, 0.0);
#endif
}
