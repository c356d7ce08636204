#version 450 core
// The compute splatter's last pass: averages shaded, for every pixel that a point fell into.
#include "point_splatting/shading.glsl"

layout(std430) restrict readonly buffer Pixels { int pixels[]; };
layout(location = 0) out vec4 color;

uniform vec2 sizePx;
uniform vec2 slopePerPx;  // the view ray of gl_FragCoord: (slopePerPx · xy + slopeAtZero, −1)
uniform vec2 slopeAtZero;

vec3 sumAt(int at) { return vec3(pixels[at], pixels[at + 1], pixels[at + 2]) / FIXED_ONE; }

void main() {
    int at = (int(gl_FragCoord.y) * int(sizePx.x) + int(gl_FragCoord.x)) * PIXEL_WORDS;
    int count = pixels[at + 1];
    color = vec4(0.0);
    if (count == 0) return;
    vec3 normal = sumAt(at + 2);
    normal = dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0, 0.0, 1.0);
#ifdef COLORS
    vec3 surface = sumAt(at + 5) / float(count);
#else
    vec3 surface = kGrey;
#endif
    vec3 toEye = normalize(vec3(-(slopePerPx * gl_FragCoord.xy + slopeAtZero), 1.0));
    color = vec4(shaded(surface, normal, toEye), 1.0);
}
