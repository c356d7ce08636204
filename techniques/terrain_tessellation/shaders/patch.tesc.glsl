#version 450 core
// [zhang2012] Sec. 4.2: drops patches outside the frustum; Sec. 3.2: sets the factors of the others.
#include "terrain_tessellation/terrain.glsl"
#include "terrain_tessellation/patches.glsl"
#include "terrain_tessellation/factors.glsl"

layout(vertices = 4) out;
layout(std430) buffer Counters {
    uint culledPatches;
};
uniform int patchesPerTile;
uniform float skirtFoot;
in int patchIndex[];
in vec2 controlPoint[];
out vec2 cornerSamples[];
patch out ivec4 drawnTile;
patch out int drawnRim;
#if CAPTURE
patch out int drawnPatch;
#endif
#if SHADING == 4
patch out int drawnParity;
#endif

float innerOf(float a, float b) {
#if INNER == 0
    return 0.5 * (a + b);
#elif INNER == 1
    return min(a, b);
#else
    return max(a, b);
#endif
}

void setFactors(vec4 outer, vec2 inner) {
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = outer[i];
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = inner[i];
}

void setSurfaceFactors(Patch p) {
    vec4 outer;
    for (int i = 0; i < 4; ++i) outer[i] = edgeFactor(p, i);
#if OWN_FACTORS
    outer = vec4(dot(outer, vec4(0.25)));  // negative control: neighbours differ
#endif
    // inner[0] divides u: the mean of the edges v = 0 and v = 1.
    setFactors(outer, vec2(innerOf(outer[1], outer[3]), innerOf(outer[0], outer[2])));
}

// The top takes the rim's factor; downwards one segment (the spacing may make it two).
void setSkirtFactors(Patch p) {
    float rim;
#if OWN_FACTORS
    rim = 0.0;
    for (int i = 0; i < 4; ++i) rim += 0.25 * edgeFactor(p, i);
#else
    rim = edgeFactor(p, p.rim);
#endif
    if ((p.rim & 1) == 0) {
        setFactors(vec4(rim, 1.0, rim, 1.0), vec2(1.0, rim));
    } else {
        setFactors(vec4(1.0, rim, 1.0, rim), vec2(rim, 1.0));
    }
}

void main() {
    cornerSamples[gl_InvocationID] = controlPoint[gl_InvocationID];
    if (gl_InvocationID != 0) return;
    Patch p = patchOfIndex(patchIndex[0], patchesPerTile);
    drawnTile = tiles[patchIndex[0] / patchesPerTile];
    drawnRim = p.rim;
#if CAPTURE
    drawnPatch = patchIndex[0];
#endif
#if SHADING == 4
    drawnParity = (p.cell.x + p.cell.y) & 1;
#endif
    if (isPatchCulled(p, skirtFoot)) {
        if (p.rim == kSurface && !isBeyondMap(p)) atomicAdd(culledPatches, 1u);
        setFactors(vec4(-1.0), vec2(-1.0));
    } else if (p.rim == kSurface) {
        setSurfaceFactors(p);
    } else {
        setSkirtFactors(p);
    }
}
