// The terrain as all its passes see it: tiles, heights, and the way into the image. Samples count
// columns (east, x) and rows (south, z) of the full-resolution height map.
layout(std430) readonly buffer Tiles {
    ivec4 tiles[];  // origin in samples, level, layer of its heights
};
// A layer has every 2^level-th sample of a tile and a border: HeightPages.
uniform sampler2DArray heightPages;
uniform vec2 spacing;        // metres between samples
uniform float eastPerSouth;  // of these
uniform vec2 lastSample;     // the south-eastern one: tiles may reach beyond, the ground does not
uniform mat4 clipFromWorld;

struct Ground {
    float height;
    vec3 normal;
};

float heightOfPage(ivec2 at, int layer) {
    return texelFetch(heightPages, ivec3(at, layer), 0).r;
}

// Where a place lies in the page of its tile, in texels. Exact: a power of two divides.
vec2 pagePlace(ivec4 tile, vec2 at) {
    precise vec2 place = (at - vec2(tile.xy)) / float(1 << tile.z) + float(PAGE_BORDER);
    return place;
}

// The height, bilinear between the samples of the tile's level. Not by the sampler's filter, whose
// weights have 8 bits on many devices: a step of 1/256 between samples shows as terraces. The normal
// is from its central differences over one step: bilinear means of the differences at the four
// samples around, which have twelve samples between them.
//        n0  n1
//    w0  a   b   e0
//    w1  c   d   e1
//        s0  s1
Ground groundAt(ivec4 tile, vec2 at) {
    vec2 place = pagePlace(tile, at);
    ivec2 cell = ivec2(floor(place));
    vec2 part = place - vec2(cell);
    int layer = tile.w;
    float a = heightOfPage(cell, layer), b = heightOfPage(cell + ivec2(1, 0), layer);
    float c = heightOfPage(cell + ivec2(0, 1), layer), d = heightOfPage(cell + 1, layer);
    float n0 = heightOfPage(cell + ivec2(0, -1), layer), n1 = heightOfPage(cell + ivec2(1, -1), layer);
    float s0 = heightOfPage(cell + ivec2(0, 2), layer), s1 = heightOfPage(cell + ivec2(1, 2), layer);
    float w0 = heightOfPage(cell + ivec2(-1, 0), layer), w1 = heightOfPage(cell + ivec2(-1, 1), layer);
    float e0 = heightOfPage(cell + ivec2(2, 0), layer), e1 = heightOfPage(cell + ivec2(2, 1), layer);
    Ground ground;
    precise float height = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    ground.height = height;
    float east = mix(mix(b - w0, e0 - a, part.x), mix(d - w1, e1 - c, part.x), part.y);
    float south = mix(mix(c - n0, d - n1, part.x), mix(s0 - a, s1 - b, part.x), part.y);
    float across = 2.0 * spacing.x * float(1 << tile.z);
    ground.normal = normalize(vec3(-east, across, -south * eastPerSouth));
    return ground;
}

vec3 worldOf(vec2 at, float height) {
    return vec3(at.x * spacing.x, height, at.y * spacing.y);
}
