// How much of a texture is seen at once.
//
// A beam is what a pixel of an image sees, or a ray stands for: its cross-section meets a surface in
// a figure, and the texture is averaged over a square as wide as that figure is long (ray cones:
// Akenine-Möller et al. 2019, "Texture Level of Detail Strategies for Real-Time Ray Tracing").

// The width in texture coordinates. `beamArea` is the beam's cross-section in m², `areaWorld` the
// vector area of a piece of the surface, `areaTexture` that of the piece in texture coordinates, and
// `direction` the beam's, unit. The cross-section is cosine · (what it meets of the surface), whose
// longest side is √(cross-section) / cosine.
float footprintOf(float beamArea, vec3 areaWorld, float areaTexture, vec3 direction) {
    // 1e-30: a surface seen edge-on, or a piece of no area, shows the coarsest level and not NaN.
    float facing = max(abs(dot(areaWorld, direction)), 1e-30);
    return sqrt(beamArea * abs(areaTexture) * length(areaWorld)) / facing;
}

float wedge(vec2 first, vec2 second) {
    return first.x * second.y - first.y * second.x;
}

// A texture at a place, averaged over `footprint`: between the two levels whose texels are next in
// width. Mixed here, of whole levels: samplers mix with as few as 8 bits, and llvmpipe takes one
// level alone for half of the range.
vec4 filteredTexel(sampler2DArray layers, vec3 place, float footprint) {
#if FILTERS_TEXTURES
    float last = float(textureQueryLevels(layers) - 1);
    // 1e-30: log2(0).
    float level = log2(max(footprint * float(textureSize(layers, 0).x), 1e-30));
    level = clamp(level, 0.0, last);
    float finer = floor(level);
    vec4 texel = textureLod(layers, place, finer);
    if (level == finer) return texel;
    return mix(texel, textureLod(layers, place, finer + 1.0), level - finer);
#else
    return textureLod(layers, place, 0.0);
#endif
}
