#version 450 core
// [zhang2012] Sec. 5: bilinear position, displaced by the height map; Sec. 3.1: skirts hang from the rim.
#include "terrain_tessellation/terrain.glsl"
#include "terrain_tessellation/patches.glsl"

layout(quads, SPACING, cw) in;
uniform float skirtFoot;
in vec2 cornerSamples[];
patch in ivec4 drawnTile;
patch in int drawnRim;
#if CAPTURE
// What the rasterizer gets, written out: CapturedVertex. Not gl_Position itself, which llvmpipe
// leaves empty.
patch in int drawnPatch;
layout(xfb_buffer = 0, xfb_stride = 32) out;
layout(xfb_offset = 0) out vec2 capturedAt;
layout(xfb_offset = 8) flat out ivec2 capturedPatch;
layout(xfb_offset = 16) out vec4 capturedPosition;
#endif
out vec3 surfaceNormal;
out float surfaceHeight;
#if SHADING == 2
out vec2 surfaceSample;
#elif SHADING == 4
patch in int drawnParity;
flat out ivec2 surfacePatch;
#endif

void main() {
    // Bilinear over a square along the axes. `precise`: both patches of an edge, and the skirt,
    // reach the same place.
    vec2 uv = gl_TessCoord.xy;
    float down = 0.0;
    if (drawnRim != kSurface) {
        bool isAlongZ = (drawnRim & 1) == 0;
        float far = (drawnRim & 2) != 0 ? 1.0 : 0.0;
        // The western and the northern skirt run upwards, so that all turn their front outwards.
        down = abs((isAlongZ ? uv.x : uv.y) - (1.0 - far));
        uv = isAlongZ ? vec2(far, uv.y) : vec2(uv.x, far);
    }
    precise vec2 inPatch = cornerSamples[0] + uv * (cornerSamples[3] - cornerSamples[0]);
    vec2 at = min(inPatch, lastSample);
    Ground ground = groundAt(drawnTile, at);
    precise float top = ground.height;
    precise float height = down > 0.0 ? mix(top, skirtFoot, down) : top;
    surfaceNormal = ground.normal;
    surfaceHeight = top;
#if SHADING == 2
    surfaceSample = at;
#elif SHADING == 4
    surfacePatch = ivec2(drawnParity, drawnTile.z);
#endif
    precise vec4 position = clipFromWorld * vec4(worldOf(at, height), 1.0);
    gl_Position = position;
#if CAPTURE
    capturedAt = inPatch;
    capturedPosition = position;
    capturedPatch = ivec2(drawnPatch, drawnRim);
#endif
}
