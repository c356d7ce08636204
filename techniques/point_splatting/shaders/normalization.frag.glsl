#version 450 core
// The last pass: sums divided by the sum of weights, then shaded, so that the normal is blended and
// not the light. Writes colour times coverage, and coverage.
#include "point_splatting/shading.glsl"

layout(binding = NORMAL_SUM_UNIT) uniform sampler2D normalSums;
#ifdef COLORS
layout(binding = COLOR_SUM_UNIT) uniform sampler2D colorSums;
#endif
layout(location = 0) out vec4 color;

uniform vec2 slopePerPx;  // the view ray of gl_FragCoord: (slopePerPx · xy + slopeAtZero, −1)
uniform vec2 slopeAtZero;

uniform float cutoff;

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
    // The least weight within a cutoff counts as covered: what the visibility pass hides behind a
    // splat must not show as the background's black, and below it lies the antialiased outline.
    float coverage = min(sum.a / exp(-0.5 * cutoff * cutoff), 1.0);
    color = vec4(clamp(shaded(surface, normal, toEye), 0.0, 1.0) * coverage, coverage);
}
