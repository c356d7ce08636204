#version 450 core
// One level of the pyramid of nearest depths: the nearest of factor × factor texels below, 4 × 4 of
// the image itself, then 2 × 2. Depths are near distance / z, so the nearest is the largest.

uniform sampler2D below;
uniform int factor;

layout(location = 0) out float nearest;

void main() {
    ivec2 first = factor * ivec2(gl_FragCoord.xy);
    nearest = 0.0;
    for (int y = 0; y < factor; ++y) {
        for (int x = 0; x < factor; ++x) {
            nearest = max(nearest, texelFetch(below, first + ivec2(x, y), 0).r);
        }
    }
}
