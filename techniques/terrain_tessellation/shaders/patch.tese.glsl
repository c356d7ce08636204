#version 450 core
// [zhang2012] Sec. 3.3: bilinear position, displaced by the height map; skirts hang from the rim.
#include "terrain_tessellation/terrain.glsl"
#include "terrain_tessellation/patches.glsl"

layout(quads, SPACING, cw) in;
uniform int patchesPerTile;
uniform float skirtFoot;
in vec2 cornerSamples[];
patch in int drawnPatch;
out vec3 surfaceNormal;
out float surfaceHeight;
out float isSkirt;

void main() {
    Patch p = patchOfIndex(drawnPatch, patchesPerTile);
    // Bilinear over a square along the axes. `precise`: both patches of an edge, and the skirt,
    // reach the same place.
    vec2 uv = gl_TessCoord.xy;
    float down = 0.0;
    if (p.rim != kSurface) {
        bool isAlongZ = (p.rim & 1) == 0;
        down = isAlongZ ? uv.x : uv.y;
        float far = (p.rim & 2) != 0 ? 1.0 : 0.0;
        uv = isAlongZ ? vec2(far, uv.y) : vec2(uv.x, far);
    }
    precise vec2 at = cornerSamples[0] + uv * (cornerSamples[3] - cornerSamples[0]);
    // A tile of level l has every 2^l-th sample, as its own height texture would.
    int stepSamples = 1 << p.level;
    precise float top = heightAt(at, stepSamples);
    precise float height = down > 0.0 ? mix(top, skirtFoot, down) : top;
    surfaceNormal = normalAt(at, stepSamples);
    surfaceHeight = top;
    isSkirt = p.rim != kSurface ? 1.0 : 0.0;
    precise vec4 position = clipFromWorld * vec4(worldOf(at, height), 1.0);
    gl_Position = position;
}
