#version 450 core
// GpuRayTracer, second pass: the rays of the listed samples through the BVH, shaded where they end
// ([xie2017] Sec. 4.7.1: the ray tracer that the method is compared with).
#include "reflections/beam.glsl"
#include "reflections/bvh.glsl"
#include "reflections/lobe.glsl"
#include "reflections/surface_at.glsl"

layout(local_size_x = TRACE_GROUP_SIZE) in;

layout(std430) restrict readonly buffer Indices { uint indices[]; };
layout(std430) restrict readonly buffer ObjectOfTriangle { uint objectOfTriangle[]; };
layout(std430) restrict readonly buffer Samples { uint samples[]; };
layout(std430) restrict readonly buffer Arguments {
    uint groups[3];
    uint sampleCount;
    uint rayCount;
};
layout(rgba16f) uniform restrict writeonly image2D radianceImage;
layout(r32f) uniform restrict writeonly image2D distanceImage;

uniform float rayLift;     // metres off the triangle where rays start: EmbreeTracer::kLift
uniform float rayGrazing;  // … and kGrazing
uniform vec3 background;

// The diffuse colour at a hit (Sec. 4.7.4: second-order rays only).
vec3 radianceAt(RayHit hit, vec3 origin, vec3 direction, float beamArea) {
    uint at = 3u * hit.triangle;
    uvec3 vertices = uvec3(indices[at], indices[at + 1u], indices[at + 2u]);
    BvhTriangle triangle = bvhTriangles[hit.leaf];
    return diffuseAt(vertices, objectOfTriangle[hit.triangle], hit.barycentric,
                     origin + hit.t * direction, direction, triangle.b - triangle.a,
                     triangle.c - triangle.a, beamArea);
}

void traceSample(ivec2 pixel) {
    float glossiness = glossinessOf(texelFetch(gbufferSurface, pixel, 0).r);
    vec3 origin = gbufferPosition(pixel);
    vec3 mirror = gbufferMirrorDirection(origin, gbufferUnitNormal(pixel));
    vec3 triangleNormal = gbufferUnitTriangleNormal(pixel);
#if FILTERS_TEXTURES
    vec3 beam = beamOf(pixel);
#else
    vec3 beam = vec3(0.0);
#endif
    int rays = raysOf(glossiness);
    vec3 sum = vec3(0.0);
    float weightSum = 0.0;
    float mirrorDistance = 0.0;
    // Ray −1 of a glossy sample is the mirror ray, for its distance only.
    for (int i = glossiness > 0.0 ? -1 : 0; i < rays; ++i) {
        vec3 direction = i < 0 ? mirror : lobeDirection(mirror, glossiness, i, rays);
        RayHit hit;
        float cosine = dot(direction, triangleNormal);
        if (cosine <= 0.0) continue;  // below its triangle: no weight
        bool isHit = closestHit(origin, direction, rayLift / max(cosine, rayGrazing), 1e30, hit);
        if ((i < 0 || glossiness <= 0.0) && isHit) mirrorDistance = hit.t;
        if (i < 0) continue;
        float weight = isHit ? fadeOf(glossiness, hit.t) : (glossiness > 0.0 ? 0.0 : 1.0);
        if (weight == 0.0) continue;
        weightSum += weight;
        sum += weight *
               (isHit ? radianceAt(hit, origin, direction, beamArea(beam, hit.t))
                      : background);
    }
    // The diffuse colour stands in for the weight that is missing.
    vec3 diffuse = gbufferDiffuseAt(pixel);
    vec3 radiance = (sum + (float(rays) - weightSum) * diffuse) / float(rays);
    imageStore(radianceImage, pixel, vec4(radiance, 1.0));
    imageStore(distanceImage, pixel, vec4(mirrorDistance));
}

void main() {
    uint stride = gl_NumWorkGroups.x * TRACE_GROUP_SIZE;
    for (uint i = gl_GlobalInvocationID.x; i < sampleCount; i += stride) {
        traceSample(ivec2(samples[i] & 0xFFFFu, samples[i] >> 16));
    }
}
