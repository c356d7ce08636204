#version 450 core
// A tile as a plain grid of quads, two triangles each, by vertex number; with MORPH the odd
// vertices slide onto the next coarser grid with the distance ([strugar2009]).
#include "terrain_tessellation/terrain.glsl"

uniform int tileIndex;
out vec3 surfaceNormal;
out float surfaceHeight;
#if MORPH
uniform vec3 eye;
uniform vec2 morphRange;  // metres: where it begins, where it is done
#endif

const ivec2 kCorners[6] = ivec2[6](ivec2(0, 0), ivec2(0, 1), ivec2(1, 0),  //
                                   ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));

void main() {
    const int cells = PATCHES_PER_TILE_SIDE * BLOCKS_PER_PATCH * BLOCK_SEGMENTS;  // a side
    ivec4 tile = tiles[tileIndex];
    int cell = gl_VertexID / 6;
    ivec2 corner = ivec2(cell % cells, cell / cells) + kCorners[gl_VertexID % 6];
    vec2 at = vec2(tile.xy + corner * (1 << tile.z));
#if MORPH
    float away = distance(eye, worldOf(at, heightAt(tile, at)));
    float morph = clamp((away - morphRange.x) / (morphRange.y - morphRange.x), 0.0, 1.0);
    at -= vec2(corner & 1) * float(1 << tile.z) * morph;
#endif
    Ground ground = groundAt(tile, at);
    surfaceNormal = ground.normal;
    surfaceHeight = ground.height;
    gl_Position = clipFromWorld * vec4(worldOf(at, ground.height), 1.0);
}
