// Step 3.c of [xie2017] Algorithm 6: the rays of one sample against its cluster's depth image.
#include "reflections/beam.glsl"
#include "reflections/environment.glsl"
#include "reflections/lobe.glsl"
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/cluster_image.glsl"

layout(std430) readonly buffer Cameras {
    ClusterCamera cameras[];
};
layout(std430) readonly buffer Places {
    ivec4 places[];  // x, y, width, height of the images; width 0: none
};

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

    Reflection result = Reflection(vec3(0.0), 0.0, 0u);
    int count = raysOf(glossiness);
    for (int i = 0; i < count; ++i) {
        vec3 direction = lobeDirection(mirror, glossiness, i, count);
        float rayLength = lengthToFarPlane(eyeWorld, plane, begin, direction);
        MarchHit hit;
        if (march(image, begin, begin + direction * rayLength, hit)) {
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
    return result;
}
