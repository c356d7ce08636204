// The terrain as all its passes see it: tiles, heights, and the way into the image. Samples count
// columns (east, x) and rows (south, z) of the full-resolution height map.
layout(std430, binding = TILE_BINDING) readonly buffer Tiles {
    ivec4 tiles[];  // origin in samples, level, step of a plain grid in samples
};
layout(binding = HEIGHT_UNIT) uniform sampler2D heightMap;
uniform vec2 heightOfTexel;  // height = x + y · texel
uniform float spacing;       // metres between samples
uniform mat4 clipFromWorld;

float heightOfSample(ivec2 at) {
    // Tiles may reach beyond the map: the border's heights go on.
    ivec2 inside = clamp(at, ivec2(0), textureSize(heightMap, 0) - 1);
    return heightOfTexel.x + heightOfTexel.y * texelFetch(heightMap, inside, 0).r;
}

// Bilinear between every `stepSamples`-th sample. Not the sampler's filter, whose weights have
// 8 bits on many devices: a step of 1/256 between samples shows as terraces.
float heightAt(vec2 at, int stepSamples) {
    vec2 place = at / float(stepSamples);
    ivec2 cell = ivec2(floor(place));
    vec2 part = place - vec2(cell);
    ivec2 low = cell * stepSamples, high = low + stepSamples;
    return mix(mix(heightOfSample(low), heightOfSample(ivec2(high.x, low.y)), part.x),
               mix(heightOfSample(ivec2(low.x, high.y)), heightOfSample(high), part.x), part.y);
}

// From central differences over one step.
vec3 normalAt(vec2 at, int stepSamples) {
    float s = float(stepSamples);
    float east = heightAt(at + vec2(s, 0), stepSamples) - heightAt(at - vec2(s, 0), stepSamples);
    float south = heightAt(at + vec2(0, s), stepSamples) - heightAt(at - vec2(0, s), stepSamples);
    return normalize(vec3(-east, 2.0 * s * spacing, -south));
}

vec3 worldOf(vec2 at, float height) {
    return vec3(at.x * spacing, height, at.y * spacing);
}
