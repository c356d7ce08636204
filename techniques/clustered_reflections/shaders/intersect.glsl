// Step 3.c of [xie2017] Algorithm 6: the rays of one sample against its cluster's depth image, of the
// texture of one cluster's image or of all, as ClusterImages fills it. OF_TRIANGLES is 1 where texels
// keep triangles instead of colours.
#include "reflections/beam.glsl"
#include "reflections/environment.glsl"
#include "reflections/kept_colour.glsl"
#include "reflections/lobe.glsl"
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/march.glsl"

layout(std430) readonly buffer Cameras { ClusterCamera cameras[]; };
layout(std430) readonly buffer Places {
    ivec4 places[];  // x, y, width, height of the images; width 0: none
};

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
#if OF_TRIANGLES
    return (texelFetch(imageTriangles, texel, 0).r >> 31) != 0u;
#else
    return texelFetch(imageColour, texel, 0).a > 0.5;
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

// Bilinear in linear light, without what lies beyond the image.
vec3 colourAt(MarchImage image, vec2 positionPx) {
    vec2 place = clamp(positionPx, vec2(0.5), vec2(image.sizePx) - 0.5) - 0.5;
    ivec2 first = image.originPx + ivec2(place);
    ivec2 last = min(first + 1, image.originPx + image.sizePx - 1);
    vec2 weight = fract(place);
    return mix(mix(imageColourAt(first), imageColourAt(ivec2(last.x, first.y)), weight.x),
               mix(imageColourAt(ivec2(first.x, last.y)), imageColourAt(last), weight.x), weight.y);
}
#endif

// Rays that hardly approach the far plane would meet it too far away for floats. Nothing of the
// scene is farther than its diagonal, which is nearer than this.
const float kLongestInFars = 16.0;

// How far along the ray its end lies, on the far plane.
float lengthToFarPlane(vec3 eyeWorld, vec4 plane, vec3 begin, vec3 direction) {
    float missing = plane.w - dot(begin - eyeWorld, plane.xyz);
    float approach = dot(direction, plane.xyz);
    float longest = kLongestInFars * plane.w;
    return approach * longest > missing ? max(missing, 0.0) / approach : longest;
}

struct Reflection {
    vec3 radiance;
    float distance;        // of the lobe's first ray, the nearest to the mirror ray; 0: no hit
    uint tookEnvironment;  // 1: a mirror ray met nothing
    float steps;           // of the march, in the mean over its rays
};

Reflection reflectionAt(ivec2 pixel, uint cluster) {
    ivec4 place = places[cluster];
    vec3 eyeWorld = cameras[cluster].eyeWorld.xyz;
    vec4 plane = cameras[cluster].planeNormal;
    MarchImage image = MarchImage(cameras[cluster].clipFromWorld, place.xy, place.zw,
                                  cameras[cluster].eyeWorld.w);
    vec3 begin = gbufferPosition(pixel);
    vec3 mirror = gbufferMirrorDirection(begin, gbufferUnitNormal(pixel));
    vec3 diffuse = gbufferDiffuseAt(pixel);
    float glossiness = glossinessOf(texelFetch(gbufferSurface, pixel, 0).r);

#if OF_TRIANGLES && FILTERS_TEXTURES
    vec3 beam = beamOf(pixel);
#else
    vec3 beam = vec3(0.0);  // images of colours have averaged by their own pitch
#endif

    Reflection result = Reflection(vec3(0.0), 0.0, 0u, 0.0);
    int count = raysOf(glossiness);
    for (int i = 0; i < count; ++i) {
        vec3 direction = lobeDirection(mirror, glossiness, i, count);
        float rayLength = lengthToFarPlane(eyeWorld, plane, begin, direction);
        MarchHit hit;
        bool isHit = march(image, begin, begin + direction * rayLength, hit);
        result.steps += float(hit.steps);
        if (isHit) {
#if OF_TRIANGLES
            HitSurface surface = surfaceAt(image, hit, begin, direction, rayLength, beam);
            float distance = surface.distanceM;
            vec3 colour = surface.colour;
#else
            float distance = hit.along * rayLength;
            // Departure [xie2017] Algorithm 7: the colour where the ray meets the surface, not at
            // the first sample behind it, which zigzags along edges by up to a texel.
            vec3 colour = colourAt(image, hit.metPx);
#endif
            result.radiance += mix(diffuse, colour, fadeOf(glossiness, distance));
            if (i == 0) result.distance = distance;
        } else if (glossiness > 0.0) {
            // Departure [xie2017] Algorithm 6: not the environment map, but what glossy rays fade to.
            result.radiance += diffuse;
        } else {
            result.radiance += radianceFrom(direction);
            result.tookEnvironment = 1u;
        }
    }
    result.radiance /= float(count);
    result.steps /= float(count);
    return result;
}
