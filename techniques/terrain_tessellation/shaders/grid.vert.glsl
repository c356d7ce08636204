#version 450 core
// A tile as a plain grid, an instance a row: a strip of two triangles a cell. With MORPH the odd
// vertices slide onto the next coarser grid with the distance ([strugar2009]).
#include "terrain_tessellation/terrain.glsl"

uniform int tileIndex;
uniform int firstRow;
out vec3 surfaceNormal;
out float surfaceHeight;
#if SHADING == 2
out vec2 surfaceSample;
#elif SHADING == 4
flat out ivec2 surfacePatch;
#endif
#if MORPH
uniform vec3 eye;
uniform vec2 morphRange;  // metres: where it begins, where it is done
#endif

void main() {
    ivec4 tile = tiles[tileIndex];
    ivec2 corner = ivec2(gl_VertexID >> 1, firstRow + gl_InstanceID + (gl_VertexID & 1));
    vec2 at = vec2(tile.xy + corner * (1 << tile.z));
#if MORPH
    vec2 onMap = min(at, lastSample);
    float away = distance(eye, worldOf(onMap, groundAt(tile, onMap).height));
    float morph = clamp((away - morphRange.x) / (morphRange.y - morphRange.x), 0.0, 1.0);
    at -= vec2(corner & 1) * float(1 << tile.z) * morph;
#endif
    at = min(at, lastSample);
    Ground ground = groundAt(tile, at);
    surfaceNormal = ground.normal;
    surfaceHeight = ground.height;
#if SHADING == 2
    surfaceSample = at;
#elif SHADING == 4
    surfacePatch = ivec2(0, tile.z);  // a tile has no patches here
#endif
    gl_Position = clipFromWorld * vec4(worldOf(at, ground.height), 1.0);
}
