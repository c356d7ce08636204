#version 450 core
// The control stage's outer factors of every patch, written out.
#include "terrain_tessellation/terrain.glsl"
#include "terrain_tessellation/patches.glsl"
#include "terrain_tessellation/factors.glsl"

layout(local_size_x = 64) in;
layout(std430) writeonly buffer Factors {
    vec4 factors[];
};
uniform int patchCount;

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (index >= patchCount) return;
    Patch p = patchOfIndex(index, PATCHES_PER_TILE_SIDE * PATCHES_PER_TILE_SIDE);
    vec4 outer = vec4(-1.0);
    if (!isPatchCulled(p, 0.0)) {
        for (int i = 0; i < 4; ++i) outer[i] = edgeFactor(p, i);
    }
    factors[index] = outer;
}
