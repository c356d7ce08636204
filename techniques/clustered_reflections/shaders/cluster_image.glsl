// What the march reads: the texture of one cluster's image or of all, as ClusterImages fills it.
// SEES_OWN is 1 where the own reflector may be drawn, OF_TRIANGLES where texels keep triangles
// instead of colours.
#include "reflections/kept_colour.glsl"
#include "clustered_reflections/march.glsl"

#if OF_TRIANGLES
uniform usampler2D imageTriangles;  // bit 31: own reflector
#else
uniform sampler2D imageColour;  // keptColour(); a: own reflector
#endif
uniform sampler2D imageDepth;    // near distance / z
uniform sampler2D imageNearest;

float storedAt(ivec2 texel) {
    return texelFetch(imageDepth, texel, 0).r;
}

bool isOwnAt(ivec2 texel) {
#if SEES_OWN && OF_TRIANGLES
    return (texelFetch(imageTriangles, texel, 0).r >> 31) != 0u;
#elif SEES_OWN
    return texelFetch(imageColour, texel, 0).a > 0.5;
#else
    return false;
#endif
}

float nearestIn(ivec2 tile, int level) {
    return texelFetch(imageNearest, tile, level - 1).r;
}

#if OF_TRIANGLES
#include "clustered_reflections/hit_surface.glsl"
#else
vec3 imageColourAt(ivec2 texel) {
    return linearColour(texelFetch(imageColour, texel, 0).rgb);
}

// Bilinear in linear light, without the neighbours in an atlas.
vec3 colourAt(MarchImage image, vec2 positionPx) {
    vec2 place = clamp(positionPx, vec2(0.5), vec2(image.sizePx) - 0.5) - 0.5;
    ivec2 first = image.originPx + ivec2(place);
    ivec2 last = min(first + 1, image.originPx + image.sizePx - 1);
    vec2 weight = fract(place);
    return mix(mix(imageColourAt(first), imageColourAt(ivec2(last.x, first.y)), weight.x),
               mix(imageColourAt(ivec2(first.x, last.y)), imageColourAt(last), weight.x), weight.y);
}
#endif
