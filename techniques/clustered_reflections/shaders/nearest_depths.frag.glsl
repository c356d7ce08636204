#version 450 core
// One level of the pyramid of nearest depths: the nearest of 2 × 2 texels of the level below. Depths
// are near distance / z, so the nearest is the largest. Texels beyond an odd border repeat the last.

layout(binding = kImageDepthUnit) uniform sampler2D below;

layout(location = 0) out float nearest;

void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(below, 0) - 1;
    float a = texelFetch(below, min(first, last), 0).r;
    float b = texelFetch(below, min(first + ivec2(1, 0), last), 0).r;
    float c = texelFetch(below, min(first + ivec2(0, 1), last), 0).r;
    float d = texelFetch(below, min(first + 1, last), 0).r;
    nearest = max(max(a, b), max(c, d));
}
