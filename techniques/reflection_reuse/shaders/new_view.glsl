// What the new view sees ([xie2017] Sec. 5.4.3).
#include "reflections/gbuffer.glsl"

uniform float depthTolerance;  // share of the new view's depth

// Whether the new view sees the fragment's own surface; 1 / gl_FragCoord.w is its eye depth.
bool isSeen(uint reflector) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (reflectorOf(texelFetch(gbufferSurface, pixel, 0).r) != reflector) return false;
    float depth = texelFetch(gbufferDepth, pixel, 0).r;
    return abs(1.0 / gl_FragCoord.w - depth) <= depthTolerance * depth;
}
