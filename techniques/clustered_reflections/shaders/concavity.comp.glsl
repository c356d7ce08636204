#version 450 core
// Marks clusters whose images show their own reflector, a workgroup each: concave ones, whose normals
// point together, by the sign of Σ (P_i − P_c) · n_i over some of their samples, spread evenly; or,
// with MARKS_CONVEX, all but planar ones. With SHOWS_BACK their images have its back, too.
#include "reflections/gbuffer.glsl"
#include "clustered_reflections/cluster_camera.glsl"

const uint kThreads = 64u;
layout(local_size_x = kThreads) in;

// Enough for a sign.
const uint kMostSamples = 1024u;

layout(std430) buffer Cameras { ClusterCamera cameras[]; };
layout(std430) readonly buffer Samples { uint samples[]; };  // x | y << 16
layout(std430) readonly buffer Ranges { uvec4 ranges[]; };  // first sample, count, reflector, flags

shared float sums[kThreads];

void main() {
    uint cluster = gl_WorkGroupID.x;
    uint count = ranges[cluster].y;
    if (count == 0u) return;  // unused, the whole workgroup
    uint thread = gl_LocalInvocationID.x;
    uint stride = (count + kMostSamples - 1u) / kMostSamples;
    vec3 centre = cameras[cluster].centreWorld.xyz;
    float sum = 0.0;
    for (uint i = thread * stride; i < count; i += kThreads * stride) {
        uint place = samples[ranges[cluster].x + i];
        ivec2 pixel = ivec2(place & 0xFFFFu, place >> 16);
        sum += dot(gbufferPosition(pixel) - centre, gbufferUnitNormal(pixel));
    }
    sums[thread] = sum;
    for (uint step = kThreads / 2u; step > 0u; step /= 2u) {
        barrier();
        if (thread < step) sums[thread] += sums[thread + step];
    }
    bool isPlanar = (cameras[cluster].flags & kPlanarCluster) != 0u;
    bool isMarked = MARKS_CONVEX == 1 || sums[0] < 0.0;
    uint marks = SHOWS_BACK == 1 ? kShowsOwn | kShowsOwnBack : kShowsOwn;
    if (thread == 0u && isMarked && !isPlanar) cameras[cluster].flags |= marks;
}
