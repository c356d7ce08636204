#version 450 core
// A tile as a plain grid of quads, two triangles each, by vertex number; with MORPH the odd
// vertices slide onto the next coarser grid with the distance ([strugar2009]).
#include "terrain_tessellation/terrain.glsl"

uniform int tileIndex;
uniform int cellsPerSide;
out vec3 surfaceNormal;
out float surfaceHeight;
out float isSkirt;
#if MORPH
uniform vec3 eye;
uniform vec2 morphRange;  // metres: where it begins, where it is done
#endif

const ivec2 kCorners[6] = ivec2[6](ivec2(0, 0), ivec2(0, 1), ivec2(1, 0),  //
                                   ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));

void main() {
    ivec4 tile = tiles[tileIndex];
    int cell = gl_VertexID / 6;
    ivec2 corner = ivec2(cell % cellsPerSide, cell / cellsPerSide) + kCorners[gl_VertexID % 6];
    vec2 at = vec2(tile.xy + corner * tile.w);
    float height = heightAt(at, tile.w);
    int normalStep = tile.w;
#if MORPH
    float away = distance(eye, worldOf(at, height));
    float morph = clamp((away - morphRange.x) / (morphRange.y - morphRange.x), 0.0, 1.0);
    at -= vec2(corner & 1) * float(tile.w) * morph;
    height = heightAt(at, tile.w);
#endif
    surfaceNormal = normalAt(at, normalStep);
    surfaceHeight = height;
    isSkirt = 0.0;
    gl_Position = clipFromWorld * vec4(worldOf(at, height), 1.0);
}
