#version 450 core
// Step 3.c of [xie2017] Algorithm 6 for all clusters at once: a fragment a sample, images in an
// atlas.
#include "clustered_reflections/intersect.glsl"

uniform usampler2D clusterOfSample;

layout(location = 0) out vec4 radiance;  // a: 1 + steps
layout(location = 1) out float distanceM;
layout(location = 2) out uint tookEnvironment;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint cluster = texelFetch(clusterOfSample, pixel, 0).r;
    if (cluster == 0u) discard;
    Reflection reflection = reflectionAt(pixel, cluster - 1u);
    radiance = vec4(reflection.radiance, 1.0 + reflection.steps);
    distanceM = reflection.distance;
    tookEnvironment = reflection.tookEnvironment;
}
