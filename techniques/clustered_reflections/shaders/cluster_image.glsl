// What the march reads: the texture of one cluster's image or of all, as ClusterImages fills it.
// SEES_OWN is 1 where the own reflector may be drawn, OF_TRIANGLES where texels keep triangles
// instead of colours.
#include "clustered_reflections/march.glsl"

#if OF_TRIANGLES
layout(binding = kImageColourUnit) uniform usampler2D imageTriangles;  // bit 31: own reflector
#else
layout(binding = kImageColourUnit) uniform sampler2D imageColour;  // a: own reflector
#endif
layout(binding = kImageDepthUnit) uniform sampler2D imageDepth;    // near distance / z
layout(binding = kImageNearestUnit) uniform sampler2D imageNearest;

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
// Bilinear, without the neighbours in an atlas.
vec3 colourAt(MarchImage image, vec2 positionPx) {
    vec2 inside = clamp(positionPx, vec2(0.5), vec2(image.sizePx) - 0.5);
    return textureLod(imageColour, (vec2(image.originPx) + inside) / vec2(textureSize(imageColour, 0)), 0.0).rgb;
}
#endif
