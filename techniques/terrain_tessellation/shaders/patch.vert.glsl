#version 450 core
// [zhang2012] Sec. 2, Fig. 4: the four control points of each patch, by number alone.
#include "terrain_tessellation/terrain.glsl"
#include "terrain_tessellation/patches.glsl"

uniform int patchesPerTile;  // with skirts or without
out int patchIndex;
out vec2 controlPoint;  // samples

void main() {
    patchIndex = gl_VertexID >> 2;
    Patch p = patchOfIndex(patchIndex, patchesPerTile);
    controlPoint = vec2(p.origin + ivec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) *
                                       patchSpan(p.level));
}
