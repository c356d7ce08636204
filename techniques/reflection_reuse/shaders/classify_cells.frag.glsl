#version 450 core
// Once a key frame: which samples reflect, and between which four of them a grid may be stretched
// ([xie2017] Sec. 5.4.2): of one reflector, and not across a silhouette.
#include "reflections/gbuffer.glsl"

uniform float silhouette;  // share of the nearest corner's depth

layout(location = 0) out uint cell;  // 1: the sample reflects, 2: the cell to its upper right

bool isCell(ivec2 pixel, uint reflector) {
    if (any(greaterThanEqual(pixel + 1, textureSize(gbufferSurface, 0)))) return false;
    float nearest = texelFetch(gbufferDepth, pixel, 0).r;
    float farthest = nearest;
    for (int corner = 1; corner < 4; ++corner) {
        ivec2 at = pixel + ivec2(corner & 1, corner >> 1);
        if (reflectorOf(texelFetch(gbufferSurface, at, 0).r) != reflector) return false;
        float depth = texelFetch(gbufferDepth, at, 0).r;
        nearest = min(nearest, depth);
        farthest = max(farthest, depth);
    }
    return farthest - nearest <= silhouette * nearest;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint reflector = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    cell = reflector == 0u ? 0u : (isCell(pixel, reflector) ? 3u : 1u);
}
