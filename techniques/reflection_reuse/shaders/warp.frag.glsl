#version 450 core
// Warp, fragments ([xie2017] Sec. 5.4.3): valid where the new view sees the same surface, so that
// what was hidden from the key frame stays wanted.
#include "reflection_reuse/grid_fragment.glsl"
#include "reflections/gbuffer.glsl"

uniform float depthTolerance;  // share of the new view's depth

layout(location = kRadianceTarget) out vec4 warped;
layout(location = kWantedTarget) out uint wanted;

// Whether the new view sees the fragment's own surface; 1 / gl_FragCoord.w is its eye depth.
bool isSeen(uint reflector) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (reflectorOf(texelFetch(gbufferSurface, pixel, 0).r) != reflector) return false;
    float depth = texelFetch(gbufferDepth, pixel, 0).r;
    return abs(1.0 / gl_FragCoord.w - depth) <= depthTolerance * depth;
}

void main() {
    bool isUsable = !hasGrown();
    if (!isSeen(point.reflector) || !isUsable) discard;
    warped = vec4(point.radiance, 1.0);
    wanted = 0u;
}
