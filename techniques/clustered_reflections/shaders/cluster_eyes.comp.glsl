#version 450 core
// [xie2017] Sec. 4.4, step 3.b, a workgroup a cluster: f = d_n / d_f (Eq. (6)) and e_c.
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/cluster_chunks.glsl"

layout(local_size_x = GROUP_SIZE) in;

uniform float leastHeight;

shared vec4 startBoxes[GROUP_SIZE];
shared vec4 endBoxes[GROUP_SIZE];
shared vec2 others[GROUP_SIZE];

float diagonalOf(vec4 box) {
    return length(box.zw - box.xy);
}

void main() {
    uint cluster = gl_WorkGroupID.x, self = gl_LocalInvocationID.x;
    vec4 starts = kNoBox, ends = kNoBox;
    vec2 other = vec2(0.0);  // z of the farthest sample behind the plane, at most 0; −1: rays were turned
    for (uint c = firstChunk[cluster] + self; c < firstChunk[cluster + 1u]; c += GROUP_SIZE) {
        starts = unitedBoxes(starts, partials[kPartials * c]);
        ends = unitedBoxes(ends, partials[kPartials * c + 1u]);
        other = min(other, vec2(1.0, -1.0) * partials[kPartials * c + 2u].xw);
    }
    startBoxes[self] = starts;
    endBoxes[self] = ends;
    others[self] = other;
    barrier();
    if (self != 0u) return;
    for (uint i = 1u; i < GROUP_SIZE; ++i) {
        starts = unitedBoxes(starts, startBoxes[i]);
        ends = unitedBoxes(ends, endBoxes[i]);
        other = min(other, others[i]);
    }

    ClusterFrame frame = frames[cluster];
    uint flags = floatBitsToUint(frame.eye.w);
    if (other.y < 0.0) flags |= kRaysTurned;
    frame.eye.w = uintBitsToFloat(flags);
    if ((flags & kPlanarCluster) == 0u) {
        float near = diagonalOf(starts), far = diagonalOf(ends);
        // A single sample has no extent, and neither have rays that meet in one point.
        float f = near > 0.0 && far > 0.0 ? min(near / far, float(MAX_SHIFT)) : 1.0;
        // Turned rays end nearer than their own would, and all alike: d_f is too small.
        if ((flags & kRaysTurned) != 0u) f = min(f, 1.0);
        // e_c lies behind every sample: at least half as far again as the farthest.
        float least = max(-1.5 * other.x, leastHeight) / -frame.eye.z;
        frame.axisY.w = max(f, least);
        // Departure [xie2017] Sec. 4.4, step 3: as printed, e_0 + (P_c − e_0)·f would put a plane's
        // eye (f = 1) at P_c; the text asks for e_0. In the frame P_c is the origin.
        frame.eye.xyz *= frame.axisY.w;
    }
    frames[cluster] = frame;
}
