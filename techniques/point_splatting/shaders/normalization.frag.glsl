#version 450 core
// The last pass: sums divided by the sum of weights, then shaded, so that the normal is blended and
// not the light. Writes colour times coverage, and coverage.
#include "point_splatting/shading.glsl"

uniform sampler2D normalSums;
#ifdef COLORS
uniform sampler2D colorSums;
#endif
layout(location = 0) out vec4 color;

uniform vec2 slopePerPx;  // the view ray of gl_FragCoord: (slopePerPx · xy + slopeAtZero, −1)
uniform vec2 slopeAtZero;

uniform float cutoff;

/// How much of the pixel the surface covers. Inside, sums follow the density of points and mean
/// nothing; where the surface ends, a sum falls to 0 within the filter's width, and is half of its
/// neighbours' at the outline itself.
float coverageAt(ivec2 pixel, float weight) {
    ivec2 last = textureSize(normalSums, 0) - 1;
    float least = weight, most = weight;
    for (int i = 0; i < 9; ++i) {
        ivec2 beside = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        float other = texelFetch(normalSums, beside, 0).a;
        least = min(least, other);
        most = max(most, other);
    }
    if (least > 0.0) return 1.0;
    // Splats that the filter makes larger than they are weigh less than any within a cutoff.
    return min(weight / max(most, exp(-0.5 * cutoff * cutoff)), 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(normalSums, pixel, 0);
    color = vec4(0.0);
    if (!(sum.a > 0.0)) return;
    // Normals that cancel, as of a leaf's two sides seen edge-on, face the eye.
    vec3 normal = dot(sum.xyz, sum.xyz) > 0.0 ? normalize(sum.xyz / sum.a) : vec3(0.0, 0.0, 1.0);
#ifdef COLORS
    vec3 surface = texelFetch(colorSums, pixel, 0).rgb / sum.a;
#else
    vec3 surface = kGrey;
#endif
    vec3 toEye = normalize(vec3(-(slopePerPx * gl_FragCoord.xy + slopeAtZero), 1.0));
    float coverage = coverageAt(pixel, sum.a);
    color = vec4(clamp(shaded(surface, normal, toEye), 0.0, 1.0) * coverage, coverage);
}
